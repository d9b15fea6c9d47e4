#pragma once

#include <incise/planning/converging_compensation.hpp>
#include <incise/planning/plan_path.hpp>
#include <incise/virtual_bench/bench_cut.hpp>

namespace incise {

/// Intended distance of a kerf's inner edge from the tumour's edge, mm: the margin of 5 mm less the electrode's radius.
/// [Paper, III-A.1]
inline constexpr double kInnerEdgeTargetMm = 4.5;

/// Cuts a virtual specimen as planned by a planner that knows the true stretched skin and the tumour's edge on it, but
/// not how cutting deforms tissue. The path is a ring by `plan`, at its speed and power, with the overlap of `incise
/// export`; the arm has its hidden errors. For studies of the bench itself.
/// @param body  stretched: its outcome is not NotConverged.
/// @throws CaseError if no such path lies on the specimen; Cancelled when the monitor asks to stop; InvalidArgument for
/// a body without equilibrium or an invalid plan.
[[nodiscard]] BenchCut cut_as_planned(const BenchBody& body, const PlanSettings& plan, Workers& workers,
                                      Monitor& monitor);

/// Cut of a specimen that was planned with the bench's own physics, but without knowledge of the arm's errors.
struct KnownPhysicsCut {
  ConvergedCompensation correction;  ///< by cuts of the bench itself, without the arm's hidden errors
  BenchCut cut;                      ///< along the corrected path, with the arm's errors
};

/// Finds the known-physics limit of every correction on the bench: the bench's own law corrects the path pass by pass,
/// as in compensate_converging, and the specimen is cut along it.
/// @param simulations  of the correction, >= 2; the final cut is one more.
/// @throws as cut_as_planned.
[[nodiscard]] KnownPhysicsCut cut_knowing_physics(const BenchBody& body, const PlanSettings& plan, int simulations,
                                                  Workers& workers, Monitor& monitor);

}  // namespace incise
