#include "bench_kit/drawn_line.hpp"

#include <algorithm>
#include <cmath>

namespace incise {

LineDistance::LineDistance(int width, int height, double reach_px)
    : width_(width),
      height_(height),
      reach_(reach_px),
      distance_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), static_cast<float>(reach_px)) {}

void LineDistance::add(const Vec2& a, const Vec2& b) {
  const auto first = [&](double x) { return std::max(0, static_cast<int>(std::floor(x - reach_))); };
  const int u1 = std::min(width_ - 1, static_cast<int>(std::ceil(std::max(a.x(), b.x()) + reach_)));
  const int v1 = std::min(height_ - 1, static_cast<int>(std::ceil(std::max(a.y(), b.y()) + reach_)));
  const Vec2 along = b - a;
  const double squared = std::max(along.squaredNorm(), 1e-12);
  for (int v = first(std::min(a.y(), b.y())); v <= v1; ++v) {
    for (int u = first(std::min(a.x(), b.x())); u <= u1; ++u) {
      const Vec2 p(u, v);
      const double t = std::clamp((p - a).dot(along) / squared, 0.0, 1.0);
      float& least =
          distance_[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u)];
      least = std::min(least, static_cast<float>((p - a - t * along).norm()));
    }
  }
}

void LineDistance::add(const std::vector<Vec2>& line, bool is_closed) {
  for (std::size_t i = 1; i < line.size(); ++i) add(line[i - 1], line[i]);
  if (is_closed && line.size() > 2) add(line.back(), line.front());
}

}  // namespace incise
