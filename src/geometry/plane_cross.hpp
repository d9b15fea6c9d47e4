#pragma once

#include <incise/geometry/types.hpp>

namespace incise {

/// Twice the area of the triangle (origin, a, b); positive when it is counter-clockwise.
inline double plane_cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace incise
