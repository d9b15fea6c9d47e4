#pragma once

#include "point_lattice.hpp"

#include <incise/cutting/carving.hpp>

#include <array>
#include <span>
#include <vector>

namespace incise {

inline constexpr double kLeastFill = 1e-3;  ///< of the stiffness of a tet that is not empty

/// The hold of the tool on the points of one tet, linear in the displacement of its corners.
struct HeldTet {
  TetId tet;
  std::array<double, 16> stiffness_mn_mm{};  ///< of its corners, row by row; along the directions of the hold
  std::array<Vec3, 4> pull_mn{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  ///< where they are
};
/// The hold of the tool on the points about it: each is pulled to where the tool took hold of it. Weights are those of
/// the moment that it was made for.
struct PointHold {
  std::vector<HeldTet> tets;           ///< ascending
  Mat3 directions = Mat3::Identity();  ///< in which the tool holds: a projection
};

/// Makes the points of tets that the tool comes near for the first time.
void meet_points(std::span<const TetId> candidates, PointLattice& lattice, CutPoints& points);

/// What the tool holds where it stands. @param candidates  live tets near the tool, ascending.
/// @param next  where the tool goes in the step: the pull is that of the step's end, with the dose of its middle.
[[nodiscard]] PointHold hold_points(const TissueModel& model, const CutSettings& settings, const Tool& tool,
                                    const CutState& state, const ToolPose& next, double step_s,
                                    const PointLattice& lattice, std::span<const TetId> candidates, Workers& workers);

/// Finds the load on the tool, and lets points slip that it has left too far behind. @param next  where the tool is
/// now. @param before  where the tissue was when the hold was made; the state has where it is.
void load_tool(const TissueModel& model, const CutSettings& settings, const Tool& tool, const ToolPose& next,
               const PointHold& hold, const PointLattice& lattice, std::span<const Vec3> before, CutState& state,
               CutStepReport& report);

/// Gives the points of the candidates, those of removed tets among them, their dose of a step, and takes hold of those
/// that come within reach.
/// @param cores  of the tool at evenly spaced moments. @returns live tets without a point that is not
/// parted, ascending.
std::vector<TetId> dose_points(const TissueModel& model, const CutSettings& settings, CutState& state,
                               const PointLattice& lattice, std::span<const Vec3> before, const ToolPose& next,
                               std::span<const ToolCore> cores, double step_s, std::span<const TetId> candidates,
                               Workers& workers, CutStepReport& report);

}  // namespace incise
