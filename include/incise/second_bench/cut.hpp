#pragma once

#include <incise/bench_kit/pictures.hpp>
#include <incise/bench_kit/tip_course.hpp>
#include <incise/second_bench/body.hpp>

namespace incise::second_bench {

/// The truth about a cut. Only the photograph made from it leaves the bench; the rest is for tests.
struct Cut {
  Outcome outcome = Outcome::Success;      ///< Success, or NotConverged: tissue did not come to rest (see `residual`)
  std::shared_ptr<const BodyState> after;  ///< 34 s after the needle came out
  double mean_force_mn = 0.0;              ///< magnitude of the needle's force on tissue, mean over the steps
  double max_force_mn = 0.0;               ///< the greatest over the steps
  std::size_t parted_by_heat = 0;   ///< voxels that parted in a step in which heat contributed more than work
  std::size_t parted_by_force = 0;  ///< other voxels that parted
  double residual = 0.0;            ///< norm of the free forces divided by that of the reactions, at the end
  int steps = 0;
  int iterations = 0;  ///< of relaxation, settling included
};

/// Cuts a specimen along a course by the bench's own law (docs/models/second_bench.md); takes one to three seconds on
/// one core. A ring that stays open also has the outcome Success: inner_edge_of() shows whether it closed.
/// @param body     its outcome is Success.
/// @param course   specimen frame, in order of time; at least 2 cutting poses, between which time passes.
/// @param power_w  of the generator, finite, > 0.
/// @throws InvalidArgument; Cancelled.
[[nodiscard]] Cut cut_specimen(const Body& body, const std::vector<TipPose>& course, double power_w, Monitor& monitor);

/// Returns the surface of the tissue as seen from above, body frame, mm: the skin as one square for each uncut column
/// of voxels, the walls and the bottom of the kerf as triangles between the middles of columns.
/// @throws InvalidArgument as tumor_edge_of.
[[nodiscard]] SeenTissue seen_from_above(const BodyState& state);
/// Returns the tumour's edge: closed, counter-clockwise seen from above, body frame, mm. A place that was cut away
/// moves with the nearest remaining tissue.
/// @throws InvalidArgument if no tissue remains within three bricks of a place.
[[nodiscard]] Contour tumor_edge_of(const BodyState& state);
/// Returns the tumour's edge at rest, mm.
[[nodiscard]] Contour tumor_edge_rest_of(const BodyState& state);

/// Finds the inner edge of a kerf as a person follows it in a picture from straight above: from the tumour's middle
/// outwards to where the skin ends or jumps, one point per degree, smoothed over ±4 degrees. Ignores bridges of skin
/// narrower than 1 mm.
/// @param seen  in a frame whose z axis points to the observer.
/// @returns the edge in the same frame, closed, mm, at the height of the tumour's middle. nullopt if that middle is not
///          on skin, or if the skin round it reaches 16 mm beyond the tumour: then no kerf separates it from the rest.
[[nodiscard]] std::optional<Contour> inner_edge_of(const SeenTissue& seen);

}  // namespace incise::second_bench
