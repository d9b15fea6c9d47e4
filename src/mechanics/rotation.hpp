#pragma once

#include <incise/geometry/types.hpp>

namespace incise {

/// Returns the rotation nearest to F: the proper R that maximises tr(Rᵀ F), which is the polar rotation if det F > 0.
/// For an inverted F the axis of least stretch is mirrored, so the element is pushed back through its thinnest
/// direction. Newton's method starts from `guess` (a proper rotation); if it is not certain to reach the maximum, the
/// eigenvector of the largest eigenvalue of Davenport's 4 x 4 matrix is used. Exact to rounding. Returns `guess` if
/// F is not finite. Source: Davenport's q-method for the maximum; the Newton step expands tr(Rᵀ F) to second order in a
/// rotation of R.
[[nodiscard]] Mat3 nearest_rotation(const Mat3& deformation, const Mat3& guess);

}  // namespace incise
