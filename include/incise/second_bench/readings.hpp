#pragma once

#include <incise/bench_kit/readings.hpp>
#include <incise/second_bench/cut.hpp>

namespace incise::second_bench {

/// Returns the hidden placement of the specimen.
[[nodiscard]] Placement placement_of(const Specimen& specimen);

/// Takes all readings of a stretched specimen: the CT in its pose in the scanner, the camera's frame with the lens
/// distortion, the gauge's reading with bias and noise. There is no elasticity map. The same body gives the same bits.
/// @throws InvalidArgument unless the body's outcome is Success; Cancelled.
[[nodiscard]] Readings take_readings(const Body& body, Monitor& monitor);

/// Returns the true course of the tip in the specimen's frame: the commanded course with the series' hand-eye error,
/// the arm's lag and its wandering.
/// @param asked             commanded course, frame robot.
/// @param T_specimen_robot  rigid: true pose of the base frame.
[[nodiscard]] std::vector<TipPose> tip_course(const std::vector<TipPose>& asked, const Specimen& specimen,
                                              const Mat4& T_specimen_robot);

/// Returns the cut specimen as its photograph shows it: in perspective and slightly tilted. Specimen frame, mm; the
/// picture's scale holds at the height of the tumour's edge.
[[nodiscard]] SeenTissue seen_by_camera(const Body& body, const Cut& cut);

/// Returns the photograph of a cut specimen, with the inner edge that a person drew in it, and the tumour's edge.
/// @throws InvalidArgument for settings out of range.
[[nodiscard]] ColorPicture photograph(const Body& body, const Cut& cut, const PhotographSettings& settings = {});

/// Returns the signed errors of the inner edge, mm: its distance from the tumour's edge, seen from straight above,
/// minus `target_mm`. One value per degree round the tumour's middle; negative: too close. nullopt: no closed inner
/// edge.
[[nodiscard]] std::optional<std::vector<double>> true_errors_mm(const Cut& cut, double target_mm);

}  // namespace incise::second_bench
