#include <incise/core/error.hpp>
#include <incise/imaging/photo_scale.hpp>

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

namespace incise {

Vec2 PhotoScale::plane_mm(const Vec2& pixel) const {
  return (T_plane_picture * pixel.homogeneous()).hnormalized();
}

double PhotoScale::mm_per_pixel(const Vec2& pixel) const {
  const Vec2 across = plane_mm(pixel + Vec2(0.5, 0.0)) - plane_mm(pixel - Vec2(0.5, 0.0));
  const Vec2 down = plane_mm(pixel + Vec2(0.0, 0.5)) - plane_mm(pixel - Vec2(0.0, 0.5));
  return std::sqrt(std::abs(across.x() * down.y() - across.y() * down.x()));
}

PhotoScale scale_from_mm_per_pixel(double mm_per_pixel, int picture_height) {
  INCISE_REQUIRE(std::isfinite(mm_per_pixel) && mm_per_pixel > 0.0,
                 fmt::format("expected a scale above 0 mm per pixel, found {}", mm_per_pixel));
  INCISE_REQUIRE(picture_height > 0, "expected a picture with rows");
  PhotoScale scale;
  scale.T_plane_picture << mm_per_pixel, 0, 0, 0, -mm_per_pixel, mm_per_pixel * (picture_height - 1), 0, 0, 1;
  return scale;
}

PhotoScale scale_from_two_points(const Vec2& a, const Vec2& b, double distance_mm, int picture_height) {
  constexpr double kLeastPx = 10.0;
  const double pixels = (b - a).norm();
  INCISE_REQUIRE(std::isfinite(pixels) && pixels >= kLeastPx,
                 fmt::format("expected two points at least {} pixels apart, found {:.3g}", kLeastPx, pixels));
  INCISE_REQUIRE(std::isfinite(distance_mm) && distance_mm > 0.0,
                 fmt::format("expected a distance above 0 mm, found {}", distance_mm));
  return scale_from_mm_per_pixel(distance_mm / pixels, picture_height);
}

PhotoScale scale_from_rectangle(const std::array<Vec2, 4>& corners, double width_mm, double height_mm) {
  INCISE_REQUIRE(width_mm > 0.0 && height_mm > 0.0 && std::isfinite(width_mm + height_mm),
                 fmt::format("expected a rectangle with sides above 0 mm, found {} x {}", width_mm, height_mm));
  constexpr double kLeastAreaPx = 100.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 in = corners[(i + 1) % 4] - corners[i];
    const Vec2 out = corners[(i + 2) % 4] - corners[(i + 1) % 4];
    const double turn = in.y() * out.x() - in.x() * out.y();  // positive: to the left as seen on a screen
    INCISE_REQUIRE(
        turn > kLeastAreaPx,
        "expected four corners in the order lower left, lower right, upper right, upper left, no three on a line");
  }
  const std::array<Vec2, 4> plane{Vec2(0, 0), Vec2(width_mm, 0), Vec2(width_mm, height_mm), Vec2(0, height_mm)};
  Eigen::Matrix<double, 8, 8> A;
  Eigen::Matrix<double, 8, 1> b;
  for (int i = 0; i < 4; ++i) {
    const Vec2& p = corners[static_cast<std::size_t>(i)];
    const Vec2& q = plane[static_cast<std::size_t>(i)];
    A.row(2 * i) << p.x(), p.y(), 1, 0, 0, 0, -q.x() * p.x(), -q.x() * p.y();
    A.row(2 * i + 1) << 0, 0, 0, p.x(), p.y(), 1, -q.y() * p.x(), -q.y() * p.y();
    b(2 * i) = q.x();
    b(2 * i + 1) = q.y();
  }
  const Eigen::Matrix<double, 8, 1> h = A.fullPivLu().solve(b);
  PhotoScale scale;
  scale.T_plane_picture << h(0), h(1), h(2), h(3), h(4), h(5), h(6), h(7), 1.0;
  return scale;
}

}  // namespace incise
