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

/// Position of the tool's tip and direction of the tool at one time, in the robot's base frame or the specimen's frame.
struct TipPose {
  double time_s = 0.0;
  Vec3 tip_mm = Vec3::Zero();
  Vec3 axis = -Vec3::UnitZ();  ///< unit, out of the tip
  bool is_cutting = true;      ///< from the plunge to the end of the dwell: the electrode is on
};

/// Returns the tip's course that a program requests, in the robot's base frame: its poses.
/// @throws InvalidArgument for a program with fewer than 2 poses or numbers that are not finite.
[[nodiscard]] std::vector<TipPose> asked_course(const RobotProgram& program);

/// Returns the same course as the arm's controller plays it: a pose every 20 ms and at the end of each phase.
/// @param replay  completed, with at least 2 samples (InvalidArgument).  @param T_flange_tool  rigid, mm.
[[nodiscard]] std::vector<TipPose> asked_course(const Replay& replay, const Mat4& T_flange_tool,
                                                const ArmModel& arm = ur10e());

/// Hidden errors of an arm that follows a requested course.
struct ArmErrors {
  std::uint64_t seed = 1;         ///< of the wandering
  Vec3 offset_mm = Vec3::Zero();  ///< base frame
  double turn_deg = 0.0;          ///< about the vertical through the middle of the course
  double wander_mm = 0.0;         ///< standard deviation, per axis, of a slow deviation in waves of 20 mm
};
/// Returns the true course of the tip, in the specimen's frame.
/// @param asked  the requested course, in the robot's base frame.
/// @param T_specimen_robot  true pose of the base in the specimen's frame, rigid, mm.
[[nodiscard]] std::vector<TipPose> tip_course(const std::vector<TipPose>& asked, const ArmErrors& errors,
                                              const Mat4& T_specimen_robot);

/// Returns why a course cannot belong to this specimen, for a message; nullopt if it can. Along the cut, the tip must
/// be in the tissue at nine poses in ten (0.5 to 12 mm below the stretched skin, along the tool), and the course must
/// go round the tumour's middle.
/// @param skin, tumor_edge  stretched, mm.  @param approach  direction in which the camera looks.
/// @param course  in the same frame.
[[nodiscard]] std::optional<std::string> find_misfit(const TriMesh& skin, const Contour& tumor_edge,
                                                     const Vec3& approach, const std::vector<TipPose>& course);

}  // namespace incise
