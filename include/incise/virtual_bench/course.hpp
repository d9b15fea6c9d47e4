#pragma once

#include <incise/bench_kit/tip_course.hpp>
#include <incise/virtual_bench/bench_cut.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise {

/// Returns the true course of the tip in the specimen's frame: the commanded course plus the arm's hidden errors
/// (offset, turn about the vertical through the middle of the course, slow wandering).
/// @param asked             commanded course, frame robot.
/// @param T_specimen_robot  rigid: true pose of the base frame.
[[nodiscard]] std::vector<TipPose> tip_course(const std::vector<TipPose>& asked, const Specimen& specimen,
                                              const Mat4& T_specimen_robot);

/// Returns why a course cannot belong to this specimen; nullopt: it can. While cutting, the tip must lie in the tissue
/// (0.5 to 12 mm below the stretched skin at nine poses in ten), and the course must go round the tumour's middle.
/// @param course  specimen frame.
[[nodiscard]] std::optional<std::string> find_misfit(const BenchBody& body, const std::vector<TipPose>& course);

}  // namespace incise
