#pragma once

#include <incise/planning/converging_compensation.hpp>
#include <incise/planning/plan_path.hpp>
#include <incise/virtual_bench/bench_cut.hpp>

namespace incise {

/// Where the inner edge of a kerf should lie, mm from the tumour's edge: the margin of 5 mm less the electrode's
/// radius. [Paper, III-A.1]
inline constexpr double kInnerEdgeTargetMm = 4.5;

/// Cuts a virtual specimen as planned: by a planner that knows the true stretched skin and where the tumour's edge lies
/// on it, but not how cutting deforms tissue. A ring as `plan` says, at its speed and power, with the overlap that
/// `incise export` has; the arm has its hidden errors. For studies of the bench itself.
/// @param body  stretched: its outcome is not NotConverged.
/// @throws CaseError where no such path lies on the specimen; Cancelled; InvalidArgument.
[[nodiscard]] BenchCut cut_as_planned(const BenchBody& body, const PlanSettings& plan, Workers& workers,
                                      Monitor& monitor);

/// What is left to a planner that knows how the specimen in hand is cut, and only not where the arm will err.
struct KnownPhysicsCut {
  ConvergedCompensation correction;  ///< by cuts of the bench itself, the arm's hidden errors left out
  BenchCut cut;                      ///< along the corrected path, the arm's errors in it
};

/// The floor of every correction on the bench: the bench's own law corrects the path, pass by pass as
/// compensate_converging does, and the specimen is cut along it.
/// @param simulations  of the correction, >= 2; the cut itself is one more.
/// @throws as cut_as_planned.
[[nodiscard]] KnownPhysicsCut cut_knowing_physics(const BenchBody& body, const PlanSettings& plan, int simulations,
                                                  Workers& workers, Monitor& monitor);

}  // namespace incise
