#pragma once

#include "point_lattice.hpp"

#include <incise/cutting/carving.hpp>

#include <span>
#include <vector>

namespace incise {

inline constexpr double kLeastFill = 1e-3;  ///< of the stiffness of a tet that is not empty

/// The hold of the tool on the points about it, slice by slice along its axis: each pulls the mean of its points to
/// where it took hold of them. Linear in the displacements; weights are those of the moment that it was made for.
struct PointHold {
  MeanStiffness means;                ///< per slice
  std::vector<Vec3> target_mm;        ///< per slice: where the mean is pulled to
  std::vector<Vec3> middle_mm;        ///< per slice: where the mean is
  std::vector<double> elastic_mn_mm;  ///< per slice: stiffness of the hold, which `means` has where it does not slip
  std::vector<int> number;            ///< per slice: how many hats up from the tip
};

/// Makes the points of tets that the tool comes near for the first time.
void meet_points(std::span<const TetId> candidates, PointLattice& lattice, CutPoints& points);

/// What the tool holds where it stands. @param candidates  live tets near the tool, ascending.
/// @param next  where the tool goes in the step: the pull is that of the step's end, with the dose of its middle.
[[nodiscard]] PointHold hold_points(const TissueModel& model, const CutSettings& settings, const Tool& tool,
                                    const CutState& state, const ToolPose& next, double step_s,
                                    const PointLattice& lattice, std::span<const TetId> candidates, Workers& workers);

/// Adds the pull to the forces, mN. @returns its norm over all vertices, mN.
double add_pull(const PointHold& hold, std::span<Vec3> forces);

/// Finds the load on the tool, and lets slices slip that are pulled harder than the limit. Tissue and offsets are those
/// of the step's end. @param next  where the tool is then.
void load_tool(const CutSettings& settings, const Tool& tool, const ToolPose& next, const PointHold& hold,
               const PointLattice& lattice, CutState& state, CutStepReport& report);

/// Gives the points of the candidates, those of removed tets among them, their dose of a step, and takes hold of those
/// that come within reach.
/// @param cores  of the tool at evenly spaced moments. @returns live tets without a point that is not
/// parted, ascending.
std::vector<TetId> dose_points(const TissueModel& model, const CutSettings& settings, CutState& state,
                               const PointLattice& lattice, std::span<const Vec3> before, const ToolPose& next,
                               std::span<const ToolCore> cores, double step_s, std::span<const TetId> candidates,
                               Workers& workers, CutStepReport& report);

}  // namespace incise
