#pragma once

#include <incise/geometry/types.hpp>

#include <vector>

namespace incise {

/// Distances of a picture's pixels from lines, kept only near them.
class LineDistance {
 public:
  LineDistance(int width, int height, double reach_px);
  /// Adds a straight piece between two places in pixels.
  void add(const Vec2& a, const Vec2& b);
  void add(const std::vector<Vec2>& line, bool is_closed);
  /// In pixels; the reach where nothing is near.
  [[nodiscard]] double at(int u, int v) const {
    return distance_[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u)];
  }

 private:
  int width_, height_;
  double reach_;
  std::vector<float> distance_;
};

}  // namespace incise
