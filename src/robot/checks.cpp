#include <incise/core/error.hpp>
#include <incise/robot/checks.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

constexpr double kClosedToMm = 0.01;

/// Poses that cut, the plunge's end (where the cut begins) included, the overlap not.
std::vector<std::size_t> cut_poses(const RobotProgram& program) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < program.poses.size(); ++i) {
    const ProgramPhase phase = program.poses[i].phase;
    if (phase == ProgramPhase::Cut || phase == ProgramPhase::Plunge) result.push_back(i);
  }
  return result;
}

/// The largest value over some poses and where it is.
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

ProgramCheck check_finite(const RobotProgram& program) {
  ProgramCheck check{"finite", true, 0.0, 0.0, "", "", std::nullopt, "every number of the program is finite"};
  for (std::size_t i = 0; i < program.poses.size(); ++i) {
    const ProgramPose& p = program.poses[i];
    const bool is_finite = p.tip_mm.allFinite() && p.R_robot_tool.allFinite() && p.rotation_vector.allFinite() &&
                           std::isfinite(p.time_s) && std::isfinite(p.tip_speed_mm_s) && std::isfinite(p.depth_mm);
    if (is_finite) continue;
    check.passed = false;
    check.value += 1.0;
    if (!check.pose) check.pose = i;
  }
  return check;
}

Vec3 mean_axis(const ToolPath& path) {
  Vec3 sum = Vec3::Zero();
  for (const Waypoint& waypoint : path.waypoints) sum += waypoint.axis;
  return sum;
}

class Checker {
 public:
  Checker(const RobotProgram& program, const ToolPath& path, const CheckSettings& settings)
      : program_(program), path_(path), settings_(settings), cut_(cut_poses(program)), axis_(mean_axis(path)) {}

  void frame() {
    const bool is_robot = path_.frame == PathFrame::Robot;
    add("frame", is_robot, is_robot ? 1.0 : 0.0, 1.0, "", "", std::nullopt,
        fmt::format("the path's frame is {}, and has to be robot", to_string(path_.frame)));
  }

  void closed() {
    const double gap = (program_.poses[cut_.back()].tip_mm - program_.poses[cut_.front()].tip_mm).norm();
    add("closed", path_.is_closed && program_.is_closed && gap <= kClosedToMm, gap, kClosedToMm, "<=", "mm",
        cut_.back(),
        path_.is_closed ? "gap between the end and the beginning of the ring"
                        : "the path is open, and has to be a ring");
  }

  void self_crossing() {
    const bool crosses = crosses_itself_in_view(entry_course(), axis_);
    add("self_crossing", !crosses, crosses ? 1.0 : 0.0, 0.0, "", "", std::nullopt,
        "the course crosses itself nowhere, seen along the mean axis");
  }

  void speed() {
    Worst fastest, slowest;
    for (std::size_t i = 0; i < program_.poses.size(); ++i) {
      const ProgramPose& pose = program_.poses[i];
      if (pose.phase != ProgramPhase::Cut && pose.phase != ProgramPhase::Overlap) continue;
      fastest.see(pose.tip_speed_mm_s, i);
      slowest.see(-pose.tip_speed_mm_s, i);
    }
    add("speed_min", -slowest.value >= settings_.min_speed_mm_s, -slowest.value, settings_.min_speed_mm_s, ">=", "mm/s",
        slowest.pose, "least tip speed of the cut");
    add("speed_max", fastest.value <= settings_.max_speed_mm_s, fastest.value, settings_.max_speed_mm_s, "<=", "mm/s",
        fastest.pose, "greatest tip speed of the cut");
  }

  void depth() {
    Worst worst;
    for (const std::size_t i : cut_) worst.see(std::abs(program_.poses[i].depth_mm - settings_.planned_depth_mm), i);
    add("depth", worst.value <= settings_.depth_tolerance_mm, worst.value, settings_.depth_tolerance_mm, "<=", "mm",
        worst.pose, fmt::format("greatest difference from the planned depth of {} mm", settings_.planned_depth_mm));
  }

  void margin() {
    Worst closest;  // of the negative margin
    const bool has_inside = path_.tumor_edge.is_closed;
    for (const std::size_t i : cut_) {
      const Vec3 entry = program_.poses[i].entry_mm();
      const double distance = nearest_on(path_.tumor_edge, entry).distance_mm;
      const bool is_inside = has_inside && contains_in_view(path_.tumor_edge, entry, axis_);
      closest.see(is_inside ? distance : -distance, i);
    }
    add("margin", -closest.value >= settings_.close_margin_mm, -closest.value, settings_.close_margin_mm, ">=", "mm",
        closest.pose, "least distance of the course from the tumour edge (negative: inside it)");
  }

  void deviation(const ToolPath& intended) {
    const Contour course = entry_contour(intended);
    Worst worst;
    for (const std::size_t i : cut_) worst.see(nearest_on(course, program_.poses[i].entry_mm()).distance_mm, i);
    add("deviation", worst.value <= settings_.max_deviation_mm, worst.value, settings_.max_deviation_mm, "<=", "mm",
        worst.pose, "greatest distance of the course from the intended one");
  }

  void reach() {
    Worst worst;
    for (std::size_t i = 0; i < program_.poses.size(); ++i) {
      const ProgramPose& pose = program_.poses[i];
      worst.see((pose.tip_mm - settings_.tool_length_mm * pose.R_robot_tool.col(2)).norm(), i);
    }
    add("reach", worst.value <= settings_.max_reach_mm, worst.value, settings_.max_reach_mm, "<=", "mm", worst.pose,
        "greatest distance of the flange from the base");
  }

  std::vector<ProgramCheck> take() { return std::move(checks_); }

 private:
  void add(const char* name, bool passed, double value, double limit, const char* relation, const char* unit,
           std::optional<std::size_t> pose, std::string text) {
    checks_.push_back({name, passed, value, limit, relation, unit, pose, std::move(text)});
  }

  /// The entry points of the cut; a closed course does not repeat its first.
  [[nodiscard]] Contour entry_course() const {
    Contour contour{{}, program_.is_closed};
    for (const std::size_t i : cut_) contour.points.push_back(program_.poses[i].entry_mm());
    if (program_.is_closed && contour.points.size() > 1) contour.points.pop_back();
    return contour;
  }

  const RobotProgram& program_;
  const ToolPath& path_;
  const CheckSettings& settings_;
  std::vector<std::size_t> cut_;
  Vec3 axis_;
  std::vector<ProgramCheck> checks_;
};

}  // namespace

bool ProgramChecks::all_passed() const {
  return std::all_of(checks.begin(), checks.end(), [](const ProgramCheck& check) { return check.passed; });
}

ProgramChecks check_program(const RobotProgram& program, const ToolPath& path, const CheckSettings& settings,
                            const ToolPath* intended) {
  INCISE_REQUIRE(cut_poses(program).size() >= 2, "expected a program with a cut, found none");
  INCISE_REQUIRE(intended == nullptr || intended->frame == path.frame,
                 "expected the intended path in the frame of the path");
  ProgramChecks result;
  result.not_made = {"inverse kinematics: whether each pose can be reached, and with which arm configuration",
                     "distance from singularities",
                     "joint limits, joint speeds and joint travel",
                     "collisions of the arm, the tool's shaft and the cables with anything",
                     "accelerations, jerk and path accuracy of the controller",
                     "forces on the tissue and on the tool; the electrode's power"};
  result.checks.push_back(check_finite(program));
  if (!result.checks.front().passed) {
    result.not_made.insert(result.not_made.begin(), "all others: the program holds numbers that are not finite");
    return result;
  }
  Checker checker(program, path, settings);
  checker.frame();
  if (settings.must_be_ring) checker.closed();
  checker.self_crossing();
  checker.speed();
  checker.depth();
  if (path.tumor_edge.points.size() >= 2)
    checker.margin();
  else
    result.not_made.push_back("margin to the tumour edge: the path holds none");
  if (intended != nullptr)
    checker.deviation(*intended);
  else
    result.not_made.push_back("deviation from the intended path: none was given");
  checker.reach();
  for (ProgramCheck& check : checker.take()) result.checks.push_back(std::move(check));
  return result;
}

}  // namespace incise
