#pragma once

#include <incise/bench_kit/tip_course.hpp>
#include <incise/core/outcome.hpp>
#include <incise/virtual_bench/body.hpp>

#include <optional>
#include <vector>

namespace incise {

/// What really happened. Of this only the photograph leaves the bench; the rest is truth, for tests.
struct BenchCut {
  Outcome outcome = Outcome::Success;  ///< Success, OpenLoop (no closed inner edge) or NotConverged (numbers
                                       ///< that are not finite, or tissue that does not come to rest: see unrest_mm)
  TissueState after;                   ///< tool out, tissue still stretched, at rest
  std::optional<Contour> inner_edge;   ///< of the kerf, on the skin, as seen along the approach; nullopt: open
  Contour tumor_edge;                  ///< where it lies after the cut
  std::size_t removed_tets = 0;
  std::size_t loose_tets = 0;  ///< of these: fragments that hung on nothing
  double shove_mm =
      0.0;  ///< how far skin in the 15 x 10 mm ahead of the tool is from its place: mean over place and cut
  double bulge_mm = 0.0;  ///< how high skin within 5 mm ahead of the tool stands above where the uncut surface is seen
                          ///< at that place: highest of each step, mean over the cut
  double max_drag_mm = 0.0;       ///< farthest that the tool took a piece of skin along
  double mean_force_mn = 0.0;     ///< of the drag, over the cut
  double thermal_width_mm = 0.0;  ///< how far beside the tool's axis tissue reached 60 degrees C
  int steps = 0;
  double unrest_mm = 0.0;  ///< longest way of a vertex in the last solution before the photograph
  int solutions = 0;       ///< of linear systems
  int linear_iterations = 0;
  double wall_s = 0.0;
};

/// Cuts along the course with the bench's own law (docs/models/virtual_bench.md): adhesive drag that grows with the
/// electrode's speed against the tissue up to the adhesion's strength, and parting of tissue where steam and the tool
/// have done enough work on it.
/// @param course   in order of time; at least 2 poses.  @param power_w  of the generator, > 0.
/// @throws InvalidArgument; Cancelled.
[[nodiscard]] BenchCut cut_specimen(const BenchBody& body, const std::vector<TipPose>& course, double power_w,
                                    Workers& workers, Monitor& monitor);

/// Distances of the inner edge from the tumour's edge, seen along the approach, less `target_mm`: one for each of
/// `points` places evenly spaced along the inner edge. mm; negative: too close.
[[nodiscard]] std::vector<double> true_errors_mm(const BenchBody& body, const BenchCut& cut, double target_mm,
                                                 std::size_t points = 360);

}  // namespace incise
