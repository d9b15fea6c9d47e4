#include "imaging/line_tracing.hpp"

#include <algorithm>
#include <cmath>

namespace incise::imaging_detail {

Vec2 tangent_at(const Line& line, bool is_closed, std::size_t i, std::size_t reach) {
  const std::size_t n = line.size();
  const std::size_t back = is_closed ? (i + n - reach % n) % n : i - std::min(i, reach);
  const std::size_t front = is_closed ? (i + reach) % n : std::min(n - 1, i + reach);
  const Vec2 difference = line[front] - line[back];
  const double norm = difference.norm();
  return norm > 0.0 ? Vec2(difference / norm) : Vec2::UnitX();
}

double length_px(const Line& line, bool is_closed) {
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) length += (line[i + 1] - line[i]).norm();
  return is_closed && line.size() > 1 ? length + (line.front() - line.back()).norm() : length;
}

Line resampled(const Line& line, bool is_closed, double step_px) {
  const double length = length_px(line, is_closed);
  const auto count = static_cast<std::size_t>(std::max(4.0, std::round(length / step_px)));
  const double step = length / static_cast<double>(is_closed ? count : count - 1);
  Line result;
  std::size_t segment = 0;
  double start = 0.0;  // arc length where the segment starts
  const std::size_t segments = is_closed ? line.size() : line.size() - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = step * static_cast<double>(i);
    while (true) {
      const Vec2& a = line[segment];
      const Vec2& b = line[(segment + 1) % line.size()];
      const double piece = (b - a).norm();
      if (at <= start + piece || segment + 1 == segments) {
        result.push_back(piece > 0.0 ? Vec2(a + (b - a) * std::min(1.0, (at - start) / piece)) : a);
        break;
      }
      start += piece;
      ++segment;
    }
  }
  return result;
}

void smooth(Line& line, bool is_closed, int passes) {
  const std::size_t n = line.size();
  if (n < 3) return;
  for (int pass = 0; pass < passes; ++pass) {
    const Line old = line;
    for (std::size_t i = is_closed ? 0 : 1; i < (is_closed ? n : n - 1); ++i) {
      line[i] = 0.25 * old[(i + n - 1) % n] + 0.5 * old[i] + 0.25 * old[(i + 1) % n];
    }
  }
}

}  // namespace incise::imaging_detail
