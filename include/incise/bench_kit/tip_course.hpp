#pragma once

#include <incise/geometry/contour.hpp>
#include <incise/geometry/tet_mesh.hpp>
#include <incise/robot/player.hpp>
#include <incise/robot/program.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace incise {

/// Where the tool's tip is and which way the tool points, at a time; specimen frame.
struct TipPose {
  double time_s = 0.0;
  Vec3 tip_mm = Vec3::Zero();
  Vec3 axis = -Vec3::UnitZ();  ///< unit, out of the tip
  bool is_cutting = true;      ///< between plunge and exit: the electrode is on
};

/// The tip's course that a program asks for, in the robot's base frame: its poses.
/// @throws InvalidArgument for a program with fewer than 2 poses or numbers that are not finite.
[[nodiscard]] std::vector<TipPose> asked_course(const RobotProgram& program);

/// The same as the arm's controller plays it: every 20 ms, and where a phase ends.
/// @param replay  completed, with at least 2 samples (InvalidArgument).  @param T_flange_tool  rigid, mm.
[[nodiscard]] std::vector<TipPose> asked_course(const Replay& replay, const Mat4& T_flange_tool,
                                                const ArmModel& arm = ur10e());

/// How an arm misses the course that it was asked for. Hidden.
struct ArmErrors {
  std::uint64_t seed = 1;         ///< of the wandering
  Vec3 offset_mm = Vec3::Zero();  ///< base frame
  double turn_deg = 0.0;          ///< about the vertical through the middle of the course
  double wander_mm = 0.0;         ///< standard deviation of a slow deviation, in waves of 20 mm
};
/// Where the arm really takes the tip, in the specimen's frame.
/// @param asked  frame robot.  @param T_specimen_robot  rigid: where the base frame really lies.
[[nodiscard]] std::vector<TipPose> tip_course(const std::vector<TipPose>& asked, const ArmErrors& errors,
                                              const Mat4& T_specimen_robot);

/// Why a course cannot be one for this specimen: while it cuts, the tip has to be in the tissue (0.5 to 12 mm below the
/// stretched skin at nine poses in ten), and the course has to go round the tumour's middle. nullopt: it can.
/// @param skin, tumor_edge  stretched.  @param approach  unit, as the camera looks.
[[nodiscard]] std::optional<std::string> find_misfit(const TriMesh& skin, const Contour& tumor_edge,
                                                     const Vec3& approach, const std::vector<TipPose>& course);

}  // namespace incise
