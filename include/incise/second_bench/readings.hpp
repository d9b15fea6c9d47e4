#pragma once

#include <incise/bench_kit/readings.hpp>
#include <incise/second_bench/cut.hpp>

namespace incise::second_bench {

/// Where the specimen lies. Hidden.
[[nodiscard]] Placement placement_of(const Specimen& specimen);

/// Takes all readings of a stretched specimen: the CT as it lay in the scanner, the camera's frame through its lens,
/// the gauge as it was read. The same body gives the same bits. There is no elasticity map.
/// @pre the body's outcome is Success.  @throws Cancelled.
[[nodiscard]] Readings take_readings(const Body& body, Monitor& monitor);

/// Where the arm really takes the tip, in the specimen's frame: off by the series' hand-eye error, late by the arm's
/// lag, wandering.
/// @param asked  frame robot.  @param T_specimen_robot  rigid: where the base frame really lies.
[[nodiscard]] std::vector<TipPose> tip_course(const std::vector<TipPose>& asked, const Specimen& specimen,
                                              const Mat4& T_specimen_robot);

/// The cut specimen as its photograph shows it: in perspective, not quite from above. In the specimen's frame, in which
/// the picture's scale holds at the height of the tumour's edge.
[[nodiscard]] SeenTissue seen_by_camera(const Body& body, const Cut& cut);

/// The photograph, with the inner edge that a person drew in it, and the tumour's edge.
[[nodiscard]] ColorPicture photograph(const Body& body, const Cut& cut, const PhotographSettings& settings = {});

/// Distances of the inner edge from the tumour's edge, seen from straight above, less `target_mm`, one a degree round
/// the tumour's middle. nullopt: no closed inner edge.
[[nodiscard]] std::optional<std::vector<double>> true_errors_mm(const Cut& cut, double target_mm);

}  // namespace incise::second_bench
