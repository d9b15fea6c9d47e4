#include "mechanics/rotation.hpp"

#include <Eigen/Eigenvalues>

namespace incise {
namespace {

constexpr int kMaxNewton = 8;
constexpr double kLastUpdate =
    1e-14;  // squared angle below which the next error is below rounding (quadratic convergence)
constexpr double kLeastCurvature = 0.05;  // det(tr S I - S), 8 at rest: below it two stretches nearly cancel

/// Returns the rotation of the unit quaternion q = (w, v) that maximises tr(R(q)ᵀ F): the eigenvector of the largest
/// eigenvalue of this 4 x 4 quadratic form.
Mat3 by_quaternion(const Mat3& f) {
  const double trace = f.trace();
  const Vec3 axial(f(2, 1) - f(1, 2), f(0, 2) - f(2, 0), f(1, 0) - f(0, 1));
  Mat4 form;
  form(0, 0) = trace;
  form.block<1, 3>(0, 1) = axial.transpose();
  form.block<3, 1>(1, 0) = axial;
  form.block<3, 3>(1, 1) = f + f.transpose() - trace * Mat3::Identity();
  const Eigen::SelfAdjointEigenSolver<Mat4> solver(form);
  const Eigen::Vector4d q = solver.eigenvectors().col(3);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

/// Returns R times the Cayley map of w: the rotation of the normalised quaternion (1, w/2).
Mat3 turned(const Mat3& r, const Vec3& w) {
  const double x = 0.5 * w[0];
  const double y = 0.5 * w[1];
  const double z = 0.5 * w[2];
  const double s = 2.0 / (1.0 + x * x + y * y + z * z);
  Mat3 step;
  step << 1.0 - s * (y * y + z * z), s * (x * y - z), s * (x * z + y),  //
      s * (x * y + z), 1.0 - s * (x * x + z * z), s * (y * z - x),      //
      s * (x * z - y), s * (y * z + x), 1.0 - s * (x * x + y * y);
  return r * step;
}

}  // namespace

Mat3 nearest_rotation(const Mat3& deformation, const Mat3& guess) {
  Mat3 r = guess;
  for (int i = 0; i < kMaxNewton; ++i) {
    const Mat3 s = r.transpose() * deformation;
    // Curvature of tr(Rᵀ F) on the rotations, G = tr S I - sym S: positive definite only in the basin of the maximum.
    const double g00 = s(1, 1) + s(2, 2);
    const double g11 = s(0, 0) + s(2, 2);
    const double g22 = s(0, 0) + s(1, 1);
    const double g01 = -0.5 * (s(0, 1) + s(1, 0));
    const double g02 = -0.5 * (s(0, 2) + s(2, 0));
    const double g12 = -0.5 * (s(1, 2) + s(2, 1));
    const double c00 = g11 * g22 - g12 * g12;
    const double c01 = g02 * g12 - g01 * g22;
    const double c02 = g01 * g12 - g02 * g11;
    const double det = g00 * c00 + g01 * c01 + g02 * c02;
    const double minor = g00 * g11 - g01 * g01;
    if (!(g00 > 0.0 && minor > 0.0 && det > kLeastCurvature)) break;
    const double ax = s(2, 1) - s(1, 2);
    const double ay = s(0, 2) - s(2, 0);
    const double az = s(1, 0) - s(0, 1);
    const double c11 = g00 * g22 - g02 * g02;
    const double c12 = g01 * g02 - g00 * g12;
    const Vec3 w =
        Vec3(c00 * ax + c01 * ay + c02 * az, c01 * ax + c11 * ay + c12 * az, c02 * ax + c12 * ay + minor * az) / det;
    r = turned(r, w);
    if (w.squaredNorm() < kLastUpdate) return r;
  }
  return deformation.allFinite() ? by_quaternion(deformation) : guess;
}

}  // namespace incise
