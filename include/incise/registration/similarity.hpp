#pragma once

#include <incise/core/describe.hpp>
#include <incise/geometry/types.hpp>

#include <span>

namespace incise {

/// Transform T_target_source with scale: p_target = scale · rotation · p_source + translation. Never a reflection.
struct Similarity {
  double scale = 1.0;                ///< > 0
  Mat3 rotation = Mat3::Identity();  ///< proper: determinant +1
  Vec3 translation_mm = Vec3::Zero();

  [[nodiscard]] Vec3 operator()(const Vec3& p) const { return scale * (rotation * p) + translation_mm; }
};
inline void describe(Visitor& v, Similarity& t) {
  v("scale", t.scale, "Factor of all lengths.", kPositive);
  v("rotation", t.rotation, "Rotation matrix, by rows.");
  v({"translation_mm", "Translation, applied after scale and rotation.", "mm"}, t.translation_mm);
}

/// Returns a after b: (a * b)(p) = a(b(p)).
[[nodiscard]] Similarity operator*(const Similarity& a, const Similarity& b);
/// Returns the inverse transform. @throws InvalidArgument unless the scale is above 0.
[[nodiscard]] Similarity inverse(const Similarity& t);

/// Returns the homogeneous 4 x 4 matrix: scale times rotation in the upper left block, translation in the last column.
[[nodiscard]] Mat4 matrix_of(const Similarity& t);

/// Returns the transformed points, in their order.
[[nodiscard]] Points moved(const Similarity& t, std::span<const Vec3> points);

/// Returns the angle between two rotations, degrees, [0, 180].
[[nodiscard]] double angle_between_deg(const Mat3& a, const Mat3& b);

/// Returns the root mean square distance, mm, between a(p) and b(p) over the points p; 0 without points.
[[nodiscard]] double rms_difference_mm(const Similarity& a, const Similarity& b, std::span<const Vec3> points);

/// Returns the rotation by |v| radians about v (Rodrigues).
[[nodiscard]] Mat3 rotation_of(const Vec3& v);
/// Returns the rotation vector, rad, of length at most pi: the inverse of rotation_of.
[[nodiscard]] Vec3 rotation_vector(const Mat3& rotation);

}  // namespace incise
