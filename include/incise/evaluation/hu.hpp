#pragma once

#include <incise/geometry/contour.hpp>

#include <array>
#include <optional>

namespace incise {

/// Area moments of the region that a closed contour fills, seen along the approach: exact for the polygon (Green's
/// theorem).
struct FilledMoments {
  double area_mm2 = 0.0;            ///< > 0
  Vec2 centroid_mm = Vec2::Zero();  ///< in the view's x and y (see view_along)
  /// Hu's seven invariants of the scale-free central moments ν_pq = μ_pq / μ_00^(1 + (p+q)/2): the same for a shape
  /// that is moved, turned or scaled; the seventh changes its sign for the mirror image. Values below the rounding
  /// error of their computation are exactly 0.
  std::array<double, 7> hu{};
};

/// @pre closed, at least 3 points, finite, an area above 0; must not cross itself for the moments to mean anything.
/// Source: Hu 1962, IRE Trans. Inf. Theory 8:179.
[[nodiscard]] FilledMoments filled_moments(const Contour& contour, const Vec3& approach);

/// How unlike two filled shapes are, by the paper's shape score; 0 = alike. Symmetric in its arguments.
struct HuScore {
  /// Σ |1/m_a − 1/m_b| with m = sign(h) log10|h|, over the invariants that exceed 1e-5 in both shapes: method I1 of
  /// OpenCV's matchShapes, with which the paper computed it. Absent where log10|h| = 0 makes a term infinite.
  std::optional<double> opencv;
  /// The same sum over all seven, as the paper's formula reads; 1/m of an invariant that is 0 is its limit, 0.
  std::optional<double> seven;
  /// An invariant of either shape lies within 10 % of the cut-off, so that a small change of shape makes `opencv` jump.
  bool is_unstable = false;
  /// A small change of either shape makes `seven` jump. It has no cut-off, so that invariants which symmetry would make
  /// 0 count by whatever noise makes of them: one of the second to fourth is at most kHuNoise, or one of the fifth to
  /// seventh at most 10 % of the size that it could have, √(h3 h4³), √h2 h4, √(h3 h4³): its term may change its sign.
  bool seven_is_unstable = false;
};

inline constexpr double kHuCutOff = 1e-5;  ///< of OpenCV's matchShapes
/// Of the second to fourth invariants, squares of moments: an error of 0.03 mm in a contour 12 mm across makes moments
/// of 1e-3.
inline constexpr double kHuNoise = 1e-6;

/// @throws InvalidArgument for an invariant that is not finite. Source: [Paper, III-A.1].
[[nodiscard]] HuScore hu_score(const std::array<double, 7>& a, const std::array<double, 7>& b);

}  // namespace incise
