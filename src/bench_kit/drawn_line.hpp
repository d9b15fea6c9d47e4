#pragma once

#include <incise/geometry/types.hpp>

#include <vector>

namespace incise {

/// Distance of each pixel of a picture from the nearest line, up to a reach; in pixels.
class LineDistance {
 public:
  LineDistance(int width, int height, double reach_px);
  /// Adds a straight piece between two places, in pixels.
  void add(const Vec2& a, const Vec2& b);
  void add(const std::vector<Vec2>& line, bool is_closed);
  /// Returns the distance of a pixel; the reach where no line is nearer.
  [[nodiscard]] double at(int u, int v) const {
    return distance_[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u)];
  }

 private:
  int width_, height_;
  double reach_;
  std::vector<float> distance_;
};

}  // namespace incise
