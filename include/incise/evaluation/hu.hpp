#pragma once

#include <incise/geometry/contour.hpp>

#include <array>
#include <optional>

namespace incise {

/// Area moments of the region inside a closed contour, seen along the approach: exact for the polygon (Green's
/// theorem).
struct FilledMoments {
  double area_mm2 = 0.0;            ///< > 0
  Vec2 centroid_mm = Vec2::Zero();  ///< in the view's x and y (see view_along)
  /// Hu's seven invariants of the scale-free central moments ν_pq = μ_pq / μ_00^(1 + (p+q)/2). They do not change if
  /// the shape is moved, turned or scaled; the seventh changes its sign for the mirror image. Values below the rounding
  /// error of their computation are set to exactly 0.
  std::array<double, 7> hu{};
};

/// Computes the moments of the region inside a contour. Without meaning for a contour that crosses itself.
/// @pre closed, at least 3 points, finite, an area above 0 (InvalidArgument).
/// Source: Hu 1962, IRE Trans. Inf. Theory 8:179.
[[nodiscard]] FilledMoments filled_moments(const Contour& contour, const Vec3& approach);

/// Dissimilarity of two filled shapes, by the paper's shape score; 0 = alike. Symmetric in the shapes.
struct HuScore {
  /// Σ |1/m_a − 1/m_b| with m = sign(h) log10|h|, over the invariants that exceed 1e-5 in both shapes: method I1 of
  /// OpenCV's matchShapes, with which the paper computed it. Absent where log10|h| = 0 makes a term infinite.
  std::optional<double> opencv;
  /// The same sum over all seven invariants, as in the paper's formula. 1/m of an invariant that is 0 is its limit, 0.
  /// Absent if a term is infinite.
  std::optional<double> seven;
  /// Whether an invariant of either shape lies within 10 % of the cut-off: a small change of shape makes `opencv` jump.
  bool is_unstable = false;
  /// Whether a small change of either shape makes `seven` jump. `seven` has no cut-off, so invariants that symmetry
  /// would make 0 contribute only noise. True if one of the second to fourth is at most kHuNoise, or if one of the
  /// fifth to seventh is at most 10 % of its greatest possible size, √(h3 h4³), √h2 h4, √(h3 h4³): its sign may change.
  bool seven_is_unstable = false;
};

inline constexpr double kHuCutOff = 1e-5;  ///< least invariant that counts in OpenCV's matchShapes
/// Noise of the second to fourth invariants, which are squares of moments: an error of 0.03 mm in a contour 12 mm
/// across causes moments of 1e-3.
inline constexpr double kHuNoise = 1e-6;

/// Computes the shape score of two shapes from their FilledMoments::hu.
/// @throws InvalidArgument for an invariant that is not finite. Source: [Paper, III-A.1].
[[nodiscard]] HuScore hu_score(const std::array<double, 7>& a, const std::array<double, 7>& b);

}  // namespace incise
