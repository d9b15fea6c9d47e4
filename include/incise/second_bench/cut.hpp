#pragma once

#include <incise/bench_kit/pictures.hpp>
#include <incise/bench_kit/tip_course.hpp>
#include <incise/second_bench/body.hpp>

namespace incise::second_bench {

/// What really happened. Of this only the photograph leaves the bench; the rest is truth, for tests.
struct Cut {
  Outcome outcome = Outcome::Success;      ///< Success, or NotConverged: tissue did not come to rest (see `residual`)
  std::shared_ptr<const BodyState> after;  ///< the needle out, 34 s later
  double mean_force_mn = 0.0;              ///< of the needle on tissue, over the steps
  double max_force_mn = 0.0;
  std::size_t parted_by_heat = 0;   ///< voxels to whose parting heat gave more, in the last step, than work
  std::size_t parted_by_force = 0;  ///< the others
  std::size_t loose = 0;            ///< voxels that hung on nothing
  double residual = 0.0;            ///< free forces over reactions at the end
  int steps = 0;
  int iterations = 0;  ///< of relaxation, settling included
};

/// Cuts along the course with the bench's own law (docs/models/second_bench.md); one to three seconds of one core. A
/// ring that stays open is a Success: inner_edge_of() tells.
/// @param body     its outcome is Success.
/// @param course   specimen frame, in order of time; at least 2 cutting poses, on whose way the tip moves or time
/// passes.
/// @param power_w  of the generator, finite, > 0.
/// @throws InvalidArgument; Cancelled.
[[nodiscard]] Cut cut_specimen(const Body& body, const std::vector<TipPose>& course, double power_w, Monitor& monitor);

/// What is seen of tissue from above: one square for each column of voxels, at its highest voxel that is left. Body
/// frame.
[[nodiscard]] SeenTissue seen_from_above(const BodyState& state);
/// Where the tumour's edge lies: closed, counter-clockwise seen from above. A place that was cut away is where the
/// nearest tissue carries it. @throws InvalidArgument where no tissue is left within three bricks of it.
[[nodiscard]] Contour tumor_edge_of(const BodyState& state);
/// Where it lies at rest.
[[nodiscard]] Contour tumor_edge_rest_of(const BodyState& state);

/// The inner edge of a kerf as a person follows it in a picture from straight above: from the tumour's middle outwards
/// to where the skin ends or jumps, one radius a degree, evened over 8 degrees. Bridges of skin narrower than 1 mm do
/// not count. Body frame; its height is that of the tumour's middle.
/// @param seen  in a frame whose z points back at the observer.
/// @returns nullopt: the skin inside is not parted from that outside, or it ends more than 16 mm from the tumour.
[[nodiscard]] std::optional<Contour> inner_edge_of(const SeenTissue& seen);

}  // namespace incise::second_bench
