#pragma once

#include <incise/robot/checks.hpp>

#include <limits>

namespace incise::robot_detail {

/// The greatest value over some poses, and its pose.
struct Worst {
  double value = -std::numeric_limits<double>::infinity();
  std::optional<std::size_t> pose;
  void see(double candidate, std::size_t at) {
    if (candidate > value) {
      value = candidate;
      pose = at;
    }
  }
};

/// Collects the checks of one program.
class CheckList {
 public:
  CheckList(const RobotProgram& program, ProgramChecks& result) : program_(program), result_(result) {}

  /// Adds a check that requires value <= limit.
  void at_most(const char* name, double value, double limit, const char* unit, std::optional<std::size_t> pose,
               std::string text) {
    add({name, value <= limit, value, limit, "<=", unit, pose, std::move(text)});
  }
  /// Adds a check that requires value >= limit.
  void at_least(const char* name, double value, double limit, const char* unit, std::optional<std::size_t> pose,
                std::string text) {
    add({name, value >= limit, value, limit, ">=", unit, pose, std::move(text)});
  }
  /// Adds a check that requires low < value < high; it states the nearer limit.
  void inside(const char* name, double value, double low, double high, std::string text) {
    const bool is_low = value - low < high - value;
    add({name, value > low && value < high, value, is_low ? low : high, is_low ? ">" : "<", "", std::nullopt,
         std::move(text)});
  }
  /// Adds a yes or no. @param pose  where it fails.
  void holds(const char* name, bool passed, std::string text, std::optional<std::size_t> pose = std::nullopt) {
    add({name, passed, passed ? 1.0 : 0.0, 1.0, "", "", pose, std::move(text)});
  }
  void not_made(std::string what) { result_.not_made.push_back(std::move(what)); }

  [[nodiscard]] const RobotProgram& program() const { return program_; }

 private:
  void add(ProgramCheck check) {
    if (check.pose && *check.pose < program_.poses.size()) check.waypoint = program_.poses[*check.pose].waypoint;
    result_.checks.push_back(std::move(check));
  }
  const RobotProgram& program_;
  ProgramChecks& result_;
};

/// Adds the checks reach, joint_limits, joint_speed, joint_acceleration, singularity, tip_speed and table.
void check_motion(CheckList& list, const CheckSettings& settings);

/// Adds the check depth, measured below a surface (robot frame).
void check_depth_in(CheckList& list, const TriMesh& surface, double depth_mm, double tolerance_mm);

/// Adds the checks self_collision, base and, if there is a surface, surface_collision, shaft and needle.
void check_collisions(CheckList& list, const TriMesh* surface, const CheckSettings& settings);

}  // namespace incise::robot_detail
