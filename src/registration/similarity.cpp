#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/registration/similarity.hpp>

#include <algorithm>
#include <cmath>

namespace incise {

Similarity operator*(const Similarity& a, const Similarity& b) {
  return {a.scale * b.scale, a.rotation * b.rotation, a(b.translation_mm)};
}

Similarity inverse(const Similarity& t) {
  INCISE_REQUIRE(t.scale > 0.0, "expected a scale above 0");
  const Mat3 back = t.rotation.transpose();
  return {1.0 / t.scale, back, -(back * t.translation_mm) / t.scale};
}

Mat4 matrix_of(const Similarity& t) {
  Mat4 matrix = Mat4::Identity();
  matrix.topLeftCorner<3, 3>() = t.scale * t.rotation;
  matrix.topRightCorner<3, 1>() = t.translation_mm;
  return matrix;
}

Points moved(const Similarity& t, std::span<const Vec3> points) {
  Points result;
  result.reserve(points.size());
  for (const Vec3& p : points) result.push_back(t(p));
  return result;
}

double angle_between_deg(const Mat3& a, const Mat3& b) {
  // Half of the Frobenius distance is sqrt(2) sin(angle / 2): unlike the trace, accurate for small angles.
  const double s = (a - b).norm() / (2.0 * std::sqrt(2.0));
  return units::deg_from_rad(2.0 * std::asin(std::min(1.0, s)));
}

double rms_difference_mm(const Similarity& a, const Similarity& b, std::span<const Vec3> points) {
  if (points.empty()) return 0.0;
  double sum = 0.0;
  for (const Vec3& p : points) sum += (a(p) - b(p)).squaredNorm();
  return std::sqrt(sum / static_cast<double>(points.size()));
}

Mat3 rotation_of(const Vec3& v) {
  const double angle = v.norm();
  if (angle == 0.0) return Mat3::Identity();
  return Eigen::AngleAxisd(angle, v / angle).toRotationMatrix();
}

Vec3 rotation_vector(const Mat3& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

}  // namespace incise
