#pragma once

#include "point_lattice.hpp"

#include <incise/cutting/carving.hpp>

#include <array>
#include <span>
#include <vector>

namespace incise {

inline constexpr double kLeastFill = 1e-3;  ///< least share of its stiffness that a live tet retains

/// The hold of the tool on the points of one tet, linear in the displacement of its corners.
struct HeldTet {
  TetId tet;
  std::array<double, 16> stiffness_mn_mm{};  ///< 4 x 4 over the corners, by rows; in the directions of the hold
  std::array<Vec3, 4> pull_mn{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  ///< at the present positions
};
/// The hold of the tool on the points near it: each is pulled to its holding place. The kernel's weights are constant
/// over the step.
struct PointHold {
  std::vector<HeldTet> tets;           ///< ascending
  Mat3 directions = Mat3::Identity();  ///< projection onto the directions in which the tool holds
};

/// Adds the points of those candidates that have none yet.
void meet_points(std::span<const TetId> candidates, PointLattice& lattice, CutPoints& points);

/// Returns the hold of the tool in a step: its pull at the step's end, with the doses expected in the middle of the
/// step and the kernel's weights at its beginning.
/// @param next        pose of the tool at the end of the step.
/// @param candidates  live tets near the tool, ascending; their points are in `lattice`.
[[nodiscard]] PointHold hold_points(const TissueModel& model, const CutSettings& settings, const Tool& tool,
                                    const CutState& state, const ToolPose& next, double step_s,
                                    const PointLattice& lattice, std::span<const TetId> candidates, Workers& workers);

/// Adds the force and torque of the tissue on the tool to `report`, and lets points slip that are too far behind their
/// holding places.
/// @param next    pose of the tool at the end of the step.
/// @param before  positions of the tissue when the hold was made; `state` has the new ones.
void load_tool(const TissueModel& model, const CutSettings& settings, const Tool& tool, const ToolPose& next,
               const PointHold& hold, const PointLattice& lattice, std::span<const Vec3> before, CutState& state,
               CutStepReport& report);

/// Adds a step's dose to the points of the candidates, those of removed tets included. Takes hold of points that come
/// within reach, and releases those that leave it.
/// @param next   pose of the tool at the end of the step.
/// @param cores  of the tool at evenly spaced moments of the step.
/// @returns live tets whose points are all parted, ascending.
std::vector<TetId> dose_points(const TissueModel& model, const CutSettings& settings, CutState& state,
                               const PointLattice& lattice, std::span<const Vec3> before, const ToolPose& next,
                               std::span<const ToolCore> cores, double step_s, std::span<const TetId> candidates,
                               Workers& workers, CutStepReport& report);

}  // namespace incise
