#pragma once

#include <incise/geometry/contour.hpp>
#include <incise/workflow/case.hpp>
#include <incise/workflow/products.hpp>

#include <vector>

namespace incise {

/// Errors of real cuts of a case beyond simulated ones, as expected, mm, by sector of equal angle about the middle of
/// the tumour edge, the first about the start direction (see values_at). The expectation is the sum of both lists.
struct ExpectedErrors {
  std::vector<double> listed_mm;     ///< values that the case lists, with its bias; empty: none
  std::vector<double> simulated_mm;  ///< (share − 1) · (simulated error of the first cut + bias); empty: none
  /// False if a share of simulated errors is needed, but the first cut left no ring to measure. Then nothing is
  /// expected.
  bool is_measured = true;
  Contour tumor_edge;                ///< of the intended path, in the stretched tissue before the cut
  [[nodiscard]] bool is_any() const { return !listed_mm.empty() || !simulated_mm.empty(); }
  /// Returns the expected error at each place, mm, positive: farther from the tumour. O(places).
  /// @param places  mm, in the coordinates of `edge`, seen along the approach.
  /// @param edge    tumour edge, closed, mm; sectors are about its middle.
  [[nodiscard]] std::vector<double> at(const Case& settings, const Points& places, const Contour& edge) const;
};

/// Returns the errors that the case's compensation expects of real cuts. With the default method: its bias, its
/// residual, and (share − 1) times the simulated errors of the cut along the intended path, bias included. With method
/// profile: the errors that photographs of inner edges showed, in place of the simulated ones. With the paper's method,
/// or for an open cut: nothing. A path and its cut move together, so the same is expected of every path of the case.
/// @param first       cut along the intended path; read only if a share of its errors is needed.
/// @param tumor_edge  of the intended path, closed, mm. O(points of the cut).
/// Source: docs/models/compensation.md, "The default method".
[[nodiscard]] ExpectedErrors expected_errors(const Case& settings, const SimulatedCut& first,
                                             const Contour& tumor_edge);

}  // namespace incise
