#include "robot/joint_motion.hpp"

#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/core/units.hpp>
#include <incise/robot/program.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

using robot_detail::Course;
using robot_detail::Leg;
using robot_detail::TipCurve;
using robot_detail::TipSample;
using robot_detail::ToolFrame;

constexpr double kUnitTolerance = 1e-3;

/// Axis times angle; of the vectors for the same rotation, the one closest to `previous`.
Vec3 rotation_vector_near(const Mat3& rotation, const Vec3& previous) {
  const Eigen::AngleAxisd angle_axis(rotation);
  const Vec3 vector = angle_axis.angle() * angle_axis.axis();
  const Vec3 other = (angle_axis.angle() - 2.0 * units::kPi) * angle_axis.axis();
  return (vector - previous).norm() <= (other - previous).norm() ? vector : other;
}

/// Adds a pose; phase and speed are those of the move to it.
void add_pose(RobotProgram& program, const ToolFrame& frame, double time_s, const TipSample& place, ProgramPhase phase,
              double speed_mm_s) {
  const Mat3 R = frame.at(place.axis);
  const Vec3 before = program.poses.empty() ? Vec3::Zero() : program.poses.back().rotation_vector;
  program.poses.push_back(
      {place.tip_mm, R, rotation_vector_near(R, before), time_s, speed_mm_s, place.depth_mm, phase, place.waypoint});
}

/// Adds poses evenly along the cut and, separately, along the overlap.
void add_cut(RobotProgram& program, const Course& course, const ToolFrame& frame, const Leg& leg, std::size_t moves) {
  const TipCurve& curve = course.curve();
  const double length = curve.length_mm();
  double begin = 0.0;
  const auto along = [&](double arc, ProgramPhase phase) {
    add_pose(program, frame, leg.begin_s + leg.law.time_s(arc), curve.at(arc), phase, curve.at(begin).speed_mm_s);
    begin = arc;
  };
  for (std::size_t i = 1; i <= moves; ++i)
    along(i == moves ? length : program.spacing_mm * static_cast<double>(i), ProgramPhase::Cut);
  const double overlap = course.overlap_mm();
  const auto overlap_moves = static_cast<std::size_t>(std::ceil(overlap / program.spacing_mm));
  for (std::size_t i = 1; i <= overlap_moves; ++i)
    along(length + overlap * static_cast<double>(i) / static_cast<double>(overlap_moves), ProgramPhase::Overlap);
}

/// The place of a straight leg where the tip is that deep.
TipSample at_depth(const Leg& leg, double depth_mm) {
  TipSample place = leg.place;
  place.tip_mm += (depth_mm - place.depth_mm) * place.axis;
  place.depth_mm = depth_mm;
  return place;
}

/// Number of equal moves, as few as possible, that keep the spacing and the chord error.
std::size_t moves_for(const TipCurve& curve, const ProgramSettings& settings) {
  constexpr int kMostRefinements = 64;
  auto moves = static_cast<std::size_t>(std::ceil(curve.length_mm() / settings.max_spacing_mm));
  moves = std::max<std::size_t>(moves, 3);
  for (int i = 0; i < kMostRefinements; ++i) {
    const double error = curve.chord_error_mm(moves);
    if (error <= settings.chord_error_mm) return moves;
    // The error falls with the square of the spacing, but only linearly at a corner: at least a tenth more each time.
    const double factor = std::clamp(std::sqrt(error / settings.chord_error_mm), 1.1, 2.0);
    moves = static_cast<std::size_t>(std::ceil(static_cast<double>(moves) * factor));
    INCISE_REQUIRE(curve.length_mm() / static_cast<double>(moves) > 0.01,
                   fmt::format("expected a course that moves of 0.01 mm or more can follow within {} mm, found {} mm",
                               settings.chord_error_mm, error));
  }
  INCISE_REQUIRE(false, "expected a course that straight moves can follow");
  return moves;
}

void write_poses(RobotProgram& program, const Course& course, const ToolFrame& frame, std::size_t moves) {
  program.poses.clear();
  const Leg& first = course.legs().front();
  add_pose(program, frame, 0.0, at_depth(first, first.from_depth_mm), ProgramPhase::Approach, 0.0);
  for (const Leg& leg : course.legs()) {
    if (leg.phase == ProgramPhase::Cut)
      add_cut(program, course, frame, leg, moves);
    else
      add_pose(program, frame, leg.end_s, at_depth(leg, leg.to_depth_mm), leg.phase, leg.nominal_speed_mm_s);
  }
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
    INCISE_REQUIRE(w.position_mm.cwiseAbs().maxCoeff() <= kFarthestPlaceMm,
                   fmt::format("expected places within {:.0e} mm of the base, found {:.3g} mm at waypoint {}",
                               kFarthestPlaceMm, w.position_mm.cwiseAbs().maxCoeff(), i));
    INCISE_REQUIRE(
        std::abs(w.depth_mm) <= kLargestLengthMm,
        fmt::format("expected a depth of at most {} mm, found {} at waypoint {}", kLargestLengthMm, w.depth_mm, i));
    INCISE_REQUIRE(std::abs(w.axis.norm() - 1.0) < kUnitTolerance,
                   fmt::format("expected a unit axis, found length {} at waypoint {}", w.axis.norm(), i));
    INCISE_REQUIRE(w.speed_mm_s > 0.0 && std::isfinite(w.speed_mm_s),
                   fmt::format("expected a speed above 0, found {} at waypoint {}", w.speed_mm_s, i));
  }
  require_none(validate(settings));
}

}  // namespace

std::vector<Problem> validate(const ProgramSettings& s) {
  std::vector<Problem> broken = problems_of(s);
  Expect{broken}(s.approach_height_mm > s.clearance_mm, "approach_height_mm", s.approach_height_mm,
                 "more than clearance_mm");
  return broken;
}

Mat4 tool_pose(const Vec3& tip_mm, const Vec3& rotation_vector) {
  Mat4 T = Mat4::Identity();
  const double angle = rotation_vector.norm();
  if (angle > 0.0) T.topLeftCorner<3, 3>() = Eigen::AngleAxisd(angle, rotation_vector.normalized()).toRotationMatrix();
  T.topRightCorner<3, 1>() = tip_mm;
  return T;
}

void require_robot_frame(const ToolPath& path, const std::filesystem::path& file) {
  if (path.frame == PathFrame::Robot) return;
  throw DataError(file, "frame", std::string(to_string(path.frame)), "robot",
                  "Project it into the robot's frame first.");
}

RobotProgram make_program(const ToolPath& path, const ProgramSettings& settings, const ArmSetup& setup) {
  require_valid(path, settings);
  require_none(validate(setup));
  const Course course(path, settings);
  INCISE_REQUIRE(course.duration_s() <= kLongestProgramS,
                 fmt::format("expected speeds at which the program takes at most {} s, found {:.4g} s", kLongestProgramS,
                             course.duration_s()));
  RobotProgram program;
  program.kind = path.kind;
  program.is_closed = path.is_closed;
  program.settings = settings;
  program.setup = setup;
  program.cut_length_mm = course.curve().length_mm();
  program.overlap_mm = course.overlap_mm();
  const std::size_t moves = moves_for(course.curve(), settings);
  program.spacing_mm = program.cut_length_mm / static_cast<double>(moves);
  program.chord_error_mm = course.curve().chord_error_mm(moves);

  write_poses(program, course, ToolFrame(path, settings.tool_x_hint, 0.0), moves);
  const auto choice = robot_detail::choose_branch(program, setup, settings.spin_deg);
  const ToolFrame frame(path, settings.tool_x_hint, units::rad_from_deg(choice.spin_deg));
  write_poses(program, course, frame, moves);
  program.motion = robot_detail::follow_branch(course, frame, choice, program, setup);
  return program;
}

}  // namespace incise
