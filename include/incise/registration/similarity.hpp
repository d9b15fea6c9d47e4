#pragma once

#include <incise/core/describe.hpp>
#include <incise/geometry/types.hpp>

#include <span>

namespace incise {

/// T_target_source with scale: p_target = scale · rotation · p_source + translation. Never a reflection.
struct Similarity {
  double scale = 1.0;
  Mat3 rotation = Mat3::Identity();  ///< proper: determinant +1
  Vec3 translation_mm = Vec3::Zero();

  [[nodiscard]] Vec3 operator()(const Vec3& p) const { return scale * (rotation * p) + translation_mm; }
};
inline void describe(Visitor& v, Similarity& t) {
  v("scale", t.scale, "Factor of all lengths.", kPositive);
  v("rotation", t.rotation, "Rows of the proper rotation.");
  v({"translation_mm", "After scale and rotation.", "mm"}, t.translation_mm);
}

/// a after b: (a * b)(p) = a(b(p)).
[[nodiscard]] Similarity operator*(const Similarity& a, const Similarity& b);
[[nodiscard]] Similarity inverse(const Similarity& t);

/// 4 x 4, row-major when printed row by row; the upper left block holds scale times rotation.
[[nodiscard]] Mat4 matrix_of(const Similarity& t);

/// Every point mapped.
[[nodiscard]] Points moved(const Similarity& t, std::span<const Vec3> points);

/// Angle between two rotations, degrees, [0, 180].
[[nodiscard]] double angle_between_deg(const Mat3& a, const Mat3& b);

/// Root mean square, mm, of how far a and b take the same points apart.
[[nodiscard]] double rms_difference_mm(const Similarity& a, const Similarity& b, std::span<const Vec3> points);

/// The rotation by |v| radians about v (Rodrigues), and back: a vector of length at most pi.
[[nodiscard]] Mat3 rotation_of(const Vec3& v);
[[nodiscard]] Vec3 rotation_vector(const Mat3& rotation);

}  // namespace incise
