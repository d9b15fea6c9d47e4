#include "robot/tip_curve.hpp"

#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/robot/program.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

using robot_detail::TipCurve;
using robot_detail::TipSample;

constexpr double kUnitTolerance = 1e-3;

/// The rotation whose z axis is `axis` and whose x axis lies as close as possible to `hint`.
Mat3 rotation_with(const Vec3& axis, const Vec3& hint) {
  Vec3 x = hint - hint.dot(axis) * axis;
  if (x.norm() < 1e-3 * hint.norm()) {  // the hint lies along the axis: any direction across it will do
    x = Vec3::UnitY() - axis.y() * axis;
    if (x.norm() < 0.5) x = Vec3::UnitX() - axis.x() * axis;
  }
  Mat3 rotation;
  rotation.col(0) = x.normalized();
  rotation.col(2) = axis;
  rotation.col(1) = axis.cross(rotation.col(0));
  return rotation;
}

/// The nearest rotation to `previous` whose z axis is `axis`: no turn about the tool's own axis is added.
Mat3 carried_to(const Mat3& previous, const Vec3& axis) {
  const Mat3 turn = Eigen::Quaterniond::FromTwoVectors(previous.col(2), axis).toRotationMatrix();
  return rotation_with(axis, turn * previous.col(0));
}

/// Axis times angle; of the vectors that mean the same rotation the one closest to `previous`.
Vec3 rotation_vector_near(const Mat3& rotation, const Vec3& previous) {
  const Eigen::AngleAxisd angle_axis(rotation);
  const Vec3 vector = angle_axis.angle() * angle_axis.axis();
  const Vec3 other = (angle_axis.angle() - 2.0 * units::kPi) * angle_axis.axis();
  return (vector - previous).norm() <= (other - previous).norm() ? vector : other;
}

/// Appends poses and keeps the time.
class ProgramBuilder {
 public:
  explicit ProgramBuilder(RobotProgram& program, const Vec3& hint) : poses_(program.poses), hint_(hint) {}

  void move_to(const TipSample& sample, double depth_mm, double speed_mm_s, ProgramPhase phase, double arc_mm = -1.0) {
    ProgramPose pose;
    pose.tip_mm = sample.tip_mm + (depth_mm - sample.depth_mm) * sample.axis;
    pose.depth_mm = depth_mm;
    pose.phase = phase;
    if (poses_.empty()) {
      pose.R_robot_tool = rotation_with(sample.axis, hint_);
      pose.rotation_vector = rotation_vector_near(pose.R_robot_tool, Vec3::Zero());
    } else {
      const ProgramPose& last = poses_.back();
      pose.R_robot_tool = carried_to(last.R_robot_tool, sample.axis);
      pose.rotation_vector = rotation_vector_near(pose.R_robot_tool, last.rotation_vector);
      pose.tip_speed_mm_s = speed_mm_s;
      const double length = arc_mm >= 0.0 ? arc_mm : (pose.tip_mm - last.tip_mm).norm();
      pose.time_s = last.time_s + length / speed_mm_s;
    }
    poses_.push_back(pose);
  }

  void rest(double seconds) {
    ProgramPose pose = poses_.back();
    pose.time_s += seconds;
    pose.tip_speed_mm_s = 0.0;
    pose.phase = ProgramPhase::Dwell;
    poses_.push_back(pose);
  }

 private:
  std::vector<ProgramPose>& poses_;
  Vec3 hint_;
};

/// The least number of equal moves that keeps to the spacing and the chord error.
std::size_t moves_for(const TipCurve& curve, const ProgramSettings& settings) {
  constexpr int kMostRefinements = 64;
  auto moves = static_cast<std::size_t>(std::ceil(curve.length_mm() / settings.max_spacing_mm));
  moves = std::max<std::size_t>(moves, 3);
  for (int i = 0; i < kMostRefinements; ++i) {
    const double error = curve.chord_error_mm(moves);
    if (error <= settings.chord_error_mm) return moves;
    // The error falls with the square of the spacing, and a corner's only linearly: at least a tenth more moves each
    // time.
    const double factor = std::clamp(std::sqrt(error / settings.chord_error_mm), 1.1, 2.0);
    moves = static_cast<std::size_t>(std::ceil(static_cast<double>(moves) * factor));
    INCISE_REQUIRE(curve.length_mm() / static_cast<double>(moves) > 0.01,
                   fmt::format("expected a course that moves of 0.01 mm or more can follow to {} mm, found {} mm off",
                               settings.chord_error_mm, error));
  }
  INCISE_REQUIRE(false, "expected a course that straight moves can follow");
  return moves;
}

void require_valid(const ToolPath& path, const ProgramSettings& settings) {
  INCISE_REQUIRE(path.frame == PathFrame::Robot,
                 fmt::format("expected a path in the robot frame, found {}", to_string(path.frame)));
  const std::size_t least = path.is_closed ? 3 : 2;
  INCISE_REQUIRE(path.waypoints.size() >= least,
                 fmt::format("expected at least {} waypoints, found {}", least, path.waypoints.size()));
  for (std::size_t i = 0; i < path.waypoints.size(); ++i) {
    const Waypoint& w = path.waypoints[i];
    INCISE_REQUIRE(w.position_mm.allFinite() && std::isfinite(w.depth_mm),
                   fmt::format("expected finite numbers at waypoint {}", i));
    INCISE_REQUIRE(std::abs(w.axis.norm() - 1.0) < kUnitTolerance,
                   fmt::format("expected a unit axis, found length {} at waypoint {}", w.axis.norm(), i));
    INCISE_REQUIRE(w.speed_mm_s > 0.0 && std::isfinite(w.speed_mm_s),
                   fmt::format("expected a speed above 0, found {} at waypoint {}", w.speed_mm_s, i));
  }
  const auto broken = validate(settings);
  INCISE_REQUIRE(broken.empty(), fmt::format("settings: {}", fmt::join(broken, "; ")));
}

}  // namespace

std::string_view to_string(ProgramPhase phase) {
  switch (phase) {
    case ProgramPhase::Approach:
      return "approach";
    case ProgramPhase::Plunge:
      return "plunge";
    case ProgramPhase::Cut:
      return "cut";
    case ProgramPhase::Overlap:
      return "overlap";
    case ProgramPhase::Dwell:
      return "dwell";
    case ProgramPhase::Exit:
      return "exit";
    case ProgramPhase::Retreat:
      return "retreat";
  }
  return "unknown";
}

std::vector<std::string> validate(const ProgramSettings& s) {
  std::vector<std::string> broken;
  const auto positive = [&](double value, const char* name) {
    if (!(value > 0.0) || !std::isfinite(value))
      broken.push_back(fmt::format("{}: found {}, expected a number above 0", name, value));
  };
  const auto not_negative = [&](double value, const char* name) {
    if (!(value >= 0.0) || !std::isfinite(value))
      broken.push_back(fmt::format("{}: found {}, expected 0 or more", name, value));
  };
  positive(s.clearance_mm, "clearance_mm");
  positive(s.approach_speed_mm_s, "approach_speed_mm_s");
  positive(s.plunge_speed_mm_s, "plunge_speed_mm_s");
  positive(s.chord_error_mm, "chord_error_mm");
  positive(s.max_spacing_mm, "max_spacing_mm");
  not_negative(s.overlap_mm, "overlap_mm");
  not_negative(s.dwell_s, "dwell_s");
  if (!(s.approach_height_mm > s.clearance_mm) || !std::isfinite(s.approach_height_mm)) {
    broken.push_back(
        fmt::format("approach_height_mm: found {}, expected more than clearance_mm", s.approach_height_mm));
  }
  if (!s.tool_x_hint.allFinite() || s.tool_x_hint.norm() == 0.0) broken.push_back("tool_x_hint: expected a direction");
  return broken;
}

void require_robot_frame(const ToolPath& path, const std::filesystem::path& file) {
  if (path.frame == PathFrame::Robot) return;
  throw DataError(file, "frame", std::string(to_string(path.frame)), "robot",
                  "Project it into the robot's frame first.");
}

RobotProgram make_program(const ToolPath& path, const ProgramSettings& settings) {
  require_valid(path, settings);
  const TipCurve curve(path);
  RobotProgram program;
  program.kind = path.kind;
  program.is_closed = path.is_closed;
  program.cut_length_mm = curve.length_mm();
  INCISE_REQUIRE(
      !path.is_closed || settings.overlap_mm < curve.length_mm(),
      fmt::format("expected an overlap below the path's {} mm, found {}", curve.length_mm(), settings.overlap_mm));
  const std::size_t moves = moves_for(curve, settings);
  program.spacing_mm = curve.length_mm() / static_cast<double>(moves);
  program.chord_error_mm = curve.chord_error_mm(moves);

  ProgramBuilder builder(program, settings.tool_x_hint);
  const TipSample start = curve.at(0.0);
  builder.move_to(start, -settings.approach_height_mm, settings.approach_speed_mm_s, ProgramPhase::Approach);
  builder.move_to(start, -settings.clearance_mm, settings.approach_speed_mm_s, ProgramPhase::Approach);
  builder.move_to(start, start.depth_mm, settings.plunge_speed_mm_s, ProgramPhase::Plunge);
  for (std::size_t i = 1; i <= moves; ++i) {
    const double begin = program.spacing_mm * static_cast<double>(i - 1);
    const TipSample sample = curve.at(std::min(begin + program.spacing_mm, curve.length_mm()));
    builder.move_to(sample, sample.depth_mm, curve.at(begin).speed_mm_s, ProgramPhase::Cut, program.spacing_mm);
  }
  if (path.is_closed && settings.overlap_mm > 0.0) {
    program.overlap_mm = settings.overlap_mm;
    const auto overlap_moves = static_cast<std::size_t>(std::ceil(settings.overlap_mm / program.spacing_mm));
    const double spacing = settings.overlap_mm / static_cast<double>(overlap_moves);
    for (std::size_t i = 1; i <= overlap_moves; ++i) {
      const TipSample sample = curve.at(spacing * static_cast<double>(i));
      builder.move_to(sample, sample.depth_mm, curve.at(spacing * static_cast<double>(i - 1)).speed_mm_s,
                      ProgramPhase::Overlap, spacing);
    }
  }
  if (settings.dwell_s > 0.0) builder.rest(settings.dwell_s);
  const TipSample end = curve.at(path.is_closed ? program.overlap_mm : curve.length_mm());
  builder.move_to(end, -settings.clearance_mm, settings.plunge_speed_mm_s, ProgramPhase::Exit);
  builder.move_to(end, -settings.approach_height_mm, settings.approach_speed_mm_s, ProgramPhase::Retreat);
  return program;
}

}  // namespace incise
