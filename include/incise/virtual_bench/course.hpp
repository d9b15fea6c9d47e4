#pragma once

#include <incise/bench_kit/tip_course.hpp>
#include <incise/virtual_bench/bench_cut.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise {

/// Where the arm really takes the tip: the course, off by the arm's hidden errors (offset, turn about the vertical
/// through the middle of the course, slow wandering), in the specimen's frame.
/// @param asked  frame robot.  @param T_specimen_robot  rigid: where the base frame really lies.
[[nodiscard]] std::vector<TipPose> tip_course(const std::vector<TipPose>& asked, const Specimen& specimen,
                                              const Mat4& T_specimen_robot);

/// Why a course cannot be one for this specimen: while it cuts, the tip has to be in the tissue (0.5 to 12 mm below the
/// stretched skin at nine poses in ten), and the course has to go round the tumour's middle. nullopt: it can.
[[nodiscard]] std::optional<std::string> find_misfit(const BenchBody& body, const std::vector<TipPose>& course);

}  // namespace incise
