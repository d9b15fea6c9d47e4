#pragma once

#include <incise/geometry/contour.hpp>
#include <incise/workflow/case.hpp>
#include <incise/workflow/products.hpp>

#include <vector>

namespace incise {

/// What real cuts of a case are expected to err beyond simulated ones, mm, by sector of equal angle about the middle of
/// the tumour edge, the first about the start direction (see values_at). The lists are added.
struct ExpectedErrors {
  std::vector<double> listed_mm;     ///< what the case lists, and its bias; empty: nothing
  std::vector<double> simulated_mm;  ///< what its share leaves of simulated errors or adds to them; empty: nothing
  /// false: a share of simulated errors is needed, and the first cut left no ring to measure. Then nothing is expected.
  bool is_measured = true;
  Contour tumor_edge;                ///< of the intended path, in the stretched tissue before the cut
  [[nodiscard]] bool is_any() const { return !listed_mm.empty() || !simulated_mm.empty(); }
  /// @param places  in the coordinates of `edge`, seen along the approach.
  /// @param edge    the tumour edge about whose middle they lie, closed, mm.
  /// @returns what is expected at each place, mm, positive: farther from the tumour. O(places).
  [[nodiscard]] std::vector<double> at(const Case& settings, const Points& places, const Contour& edge) const;
};

/// What the case's compensation expects: with the default method, its bias, its residual, and what its share leaves of
/// the simulated errors of the cut along the intended path or adds to them; with method profile, what photographs of
/// inner edges showed in place of what is simulated; with the paper's, nothing. A path and its cut move together, so
/// that the same is expected of every path of the case.
/// @param first       the cut along the intended path; read where a share of its errors is needed.
/// @param tumor_edge  of the intended path, closed, mm. O(points of the cut).
/// Source: docs/models/compensation.md, "The default method".
[[nodiscard]] ExpectedErrors expected_errors(const Case& settings, const SimulatedCut& first,
                                             const Contour& tumor_edge);

}  // namespace incise
