#include <incise/geometry/distance_line.hpp>

#include <limits>

namespace incise {

void DistanceLine::transform(double spacing) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::size_t n = values.size();
  apexes_.clear();
  starts_.clear();
  for (std::size_t q = 0; q < n; ++q) {
    if (values[q] == kInfinity) continue;
    const double x = spacing * static_cast<double>(q);
    double start = -kInfinity;
    while (!apexes_.empty()) {
      const double p = spacing * static_cast<double>(apexes_.back());
      start = ((values[q] + x * x) - (values[apexes_.back()] + p * p)) / (2.0 * (x - p));
      if (start > starts_.back()) break;
      apexes_.pop_back();
      starts_.pop_back();
      start = -kInfinity;
    }
    apexes_.push_back(q);
    starts_.push_back(start);
  }
  result.assign(n, kInfinity);
  if (apexes_.empty()) return;
  std::size_t lowest = 0;
  for (std::size_t q = 0; q < n; ++q) {
    const double x = spacing * static_cast<double>(q);
    while (lowest + 1 < apexes_.size() && starts_[lowest + 1] < x) ++lowest;
    const double step = spacing * (static_cast<double>(q) - static_cast<double>(apexes_[lowest]));
    result[q] = step * step + values[apexes_[lowest]];
  }
}

}  // namespace incise
