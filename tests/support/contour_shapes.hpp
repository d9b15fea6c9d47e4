#pragma once

#include <incise/geometry/contour.hpp>

#include <cmath>
#include <cstddef>
#include <numbers>

namespace incise::testing {

/// Closed, counter-clockwise polygon with corners at `center` + radius(angle) · (cos, sin, 0), angles evenly spaced
/// from 0.
template <class Radius>
Contour polar_ring(const Radius& radius, std::size_t corners, const Vec3& center = Vec3::Zero()) {
  Contour ring{.points = {}, .is_closed = true};
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
    const double r = radius(angle);
    ring.points.push_back(center + r * Vec3(std::cos(angle), std::sin(angle), 0.0));
  }
  return ring;
}

/// Polygon inscribed in a circle.
inline Contour circle(double radius_mm, std::size_t corners, const Vec3& center = Vec3::Zero()) {
  return polar_ring([&](double) { return radius_mm; }, corners, center);
}

/// A mildly irregular tumour outline near 20 mm across, with two shallow dents.
inline Contour irregular_tumor(std::size_t corners = 180, const Vec3& center = Vec3::Zero()) {
  return polar_ring(
      [](double a) {
        return 10.0 * (1.0 + 0.10 * std::cos(2.0 * a) + 0.08 * std::sin(3.0 * a) + 0.03 * std::cos(5.0 * a));
      },
      corners, center);
}

/// A kidney: a disc with a dent so deep that its flat offset by 5 mm crosses itself.
inline Contour kidney(std::size_t corners = 240, const Vec3& center = Vec3::Zero()) {
  return polar_ring(
      [](double a) {
        return 10.0 - 6.0 * std::exp(-4.0 * a * a) - 6.0 * std::exp(-4.0 * std::pow(a - 2.0 * std::numbers::pi, 2));
      },
      corners, center);
}

/// The contour turned by `angle` about z, scaled and then moved.
inline Contour moved(Contour contour, double angle, double scale, const Vec3& shift) {
  const Mat3 turn = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
  for (Vec3& p : contour.points) p = scale * (turn * p) + shift;
  return contour;
}

}  // namespace incise::testing
