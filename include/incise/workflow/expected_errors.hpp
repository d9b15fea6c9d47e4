#pragma once

#include <incise/geometry/contour.hpp>
#include <incise/workflow/case.hpp>
#include <incise/workflow/products.hpp>

#include <vector>

namespace incise {

/// What real cuts of a case are expected to err beyond simulated ones, by direction.
struct ExpectedErrors {
  /// Real less simulated signed error, mm, by sector of equal angle about the tumour edge's middle, the first about the
  /// start direction (see values_at); empty: a real cut is expected to lie where the simulated one does.
  std::vector<double> beyond_mm;
  Contour tumor_edge;  ///< about whose middle the sectors lie in the stretched tissue before the cut
  [[nodiscard]] bool is_any() const { return !beyond_mm.empty(); }
};

/// What the case's compensation expects: with the default method, its bias, its residual, and what its share leaves of
/// the simulated errors of the cut along the intended path or adds to them; with method profile, what was photographed
/// less what is simulated; with the paper's, nothing. A path and its cut move together, so that the same is expected
/// of every path of the case.
/// @param first       the cut along the intended path. Where no share is needed it is not read; where it is and no ring
///                    was left to measure, nothing is expected.
/// @param tumor_edge  of the intended path, closed, mm. O(points of the cut).
/// Source: docs/models/compensation.md, "The default method".
[[nodiscard]] ExpectedErrors expected_errors(const Case& settings, const SimulatedCut& first,
                                             const Contour& tumor_edge);

}  // namespace incise
