#pragma once

#include <incise/geometry/types.hpp>

namespace incise {

/// The rotation nearest to F: the proper R that maximises tr(Rᵀ F), the polar rotation where det F > 0. For an inverted
/// F the axis of least stretch is the one that is mirrored, so that the element is pushed back through its thinnest
/// direction. Newton's method from `guess` (a proper rotation); where that is not sure to reach the maximum, the
/// largest eigenvector of Davenport's 4 x 4 matrix. Exact to rounding. A non-finite F returns `guess`. Source:
/// Davenport's q-method for the maximum; the Newton step is the second-order expansion of tr(Rᵀ F) in a turn of R.
[[nodiscard]] Mat3 nearest_rotation(const Mat3& deformation, const Mat3& guess);

}  // namespace incise
