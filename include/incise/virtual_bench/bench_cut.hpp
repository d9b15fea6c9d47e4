#pragma once

#include <incise/bench_kit/tip_course.hpp>
#include <incise/core/outcome.hpp>
#include <incise/virtual_bench/body.hpp>

#include <optional>
#include <vector>

namespace incise {

/// The truth about a cut. Only the photograph made from it leaves the bench; the rest is for tests.
struct BenchCut {
  Outcome outcome = Outcome::Success;  ///< Success, OpenLoop (no closed inner edge) or NotConverged (numbers
                                       ///< that are not finite, or tissue that does not come to rest: see unrest_mm)
  TissueState after;                   ///< tool out, tissue still stretched, at rest
  std::optional<Contour> inner_edge;   ///< of the kerf, on the skin, as seen along the approach, mm; nullopt: open
  Contour tumor_edge;                  ///< after the cut, mm
  std::size_t removed_tets = 0;        ///< loose fragments included
  std::size_t loose_tets = 0;          ///< tets of loose fragments
  double shove_mm =
      0.0;  ///< displacement of the skin in the 15 x 10 mm ahead of the tool: mean over that area and over the cut
  double bulge_mm = 0.0;  ///< height of the skin above the uncut surface, within 5 mm ahead of the tool: greatest in
                          ///< each step, mean over the cut
  double max_drag_mm = 0.0;       ///< greatest displacement, across the approach, of skin in the 15 x 10 mm
  double mean_force_mn = 0.0;     ///< magnitude of the drag force, mean over the cut
  double thermal_width_mm = 0.0;  ///< distance beside the tool's axis to which tissue reached 60 degrees C
  int steps = 0;
  double unrest_mm = 0.0;  ///< greatest motion of a vertex in the last solution before the photograph
  int solutions = 0;       ///< of linear systems
  int linear_iterations = 0;
};

/// Cuts a specimen along a course by the bench's own law (docs/models/virtual_bench.md): adhesive drag that grows with
/// the electrode's speed relative to the tissue, up to the adhesion's strength; tissue parts where steam and the tool
/// have done enough work on it.
/// @param body     its outcome is Success.
/// @param course   specimen frame, in order of time; its cutting part has at least 2 poses, and the tip moves in it.
/// @param power_w  of the generator, finite, > 0.
/// @throws InvalidArgument for a course or power that does not meet these conditions; Cancelled.
[[nodiscard]] BenchCut cut_specimen(const BenchBody& body, const std::vector<TipPose>& course, double power_w,
                                    Workers& workers, Monitor& monitor);

/// Returns the signed errors of the inner edge, mm: its distance from the tumour's edge, seen along the approach, minus
/// `target_mm`. One value for each of `points` places evenly spaced along the inner edge; negative: too close.
/// @throws InvalidArgument for a cut without a closed inner edge.
[[nodiscard]] std::vector<double> true_errors_mm(const BenchBody& body, const BenchCut& cut, double target_mm,
                                                 std::size_t points = 360);

}  // namespace incise
