#include <incise/bench_kit/smooth_field.hpp>
#include <incise/bench_kit/tip_course.hpp>
#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/geometry/surface_query.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace incise {
namespace {

constexpr double kLeastDepthMm = 0.5;
constexpr double kMostDepthMm = 12.0;
constexpr double kCoursePeriodS = 0.02;
constexpr double kWanderWaveMm = 20.0;
constexpr std::uint64_t kWanderStream = 0x9e3779b1ULL;

bool cuts(ProgramPhase phase) {
  return phase == ProgramPhase::Plunge || is_cut(phase) || phase == ProgramPhase::Dwell;
}

}  // namespace

std::vector<TipPose> asked_course(const RobotProgram& program) {
  INCISE_REQUIRE(program.poses.size() >= 2, fmt::format("expected at least 2 poses, found {}", program.poses.size()));
  std::vector<TipPose> course;
  for (std::size_t i = 0; i < program.poses.size(); ++i) {
    const ProgramPose& pose = program.poses[i];
    INCISE_REQUIRE(pose.tip_mm.allFinite() && pose.R_robot_tool.allFinite() && std::isfinite(pose.time_s),
                   fmt::format("expected finite numbers, found a non-finite one at pose {}", i));
    course.push_back({pose.time_s, pose.tip_mm, pose.R_robot_tool.col(2), cuts(pose.phase)});
  }
  return course;
}

std::vector<TipPose> asked_course(const Replay& replay, const Mat4& T_flange_tool, const ArmModel& arm) {
  INCISE_REQUIRE(replay.outcome == ReplayOutcome::Completed && replay.samples.size() >= 2,
                 "expected a program that was played to its end");
  std::vector<TipPose> course;
  for (std::size_t i = 0; i < replay.samples.size(); ++i) {
    const ReplaySample& sample = replay.samples[i];
    const bool is_end = i == 0 || i + 1 == replay.samples.size() || replay.samples[i + 1].phase != sample.phase;
    if (!is_end && sample.time_s < course.back().time_s + kCoursePeriodS) continue;
    const Mat4 T_robot_tool = forward_kinematics(arm, sample.q_rad) * T_flange_tool;
    course.push_back(
        {sample.time_s, T_robot_tool.topRightCorner<3, 1>(), T_robot_tool.block<3, 1>(0, 2), cuts(sample.phase)});
  }
  return course;
}

std::vector<TipPose> tip_course(const std::vector<TipPose>& asked, const ArmErrors& errors,
                                const Mat4& T_specimen_robot) {
  Random random(errors.seed ^ kWanderStream);
  const std::array<SmoothField, 3> wander{SmoothField(kWanderWaveMm, random), SmoothField(kWanderWaveMm, random),
                                          SmoothField(kWanderWaveMm, random)};
  Vec3 middle = Vec3::Zero();
  std::size_t count = 0;
  for (const TipPose& pose : asked) {
    if (!pose.is_cutting) continue;
    middle += pose.tip_mm;
    ++count;
  }
  if (count > 0) middle /= static_cast<double>(count);
  const Mat3 turn = Eigen::AngleAxisd(units::rad_from_deg(errors.turn_deg), Vec3::UnitZ()).toRotationMatrix();
  const Mat3 R = T_specimen_robot.topLeftCorner<3, 3>();
  const Vec3 t = T_specimen_robot.topRightCorner<3, 1>();
  std::vector<TipPose> course;
  for (const TipPose& pose : asked) {
    Vec3 tip = middle + turn * (pose.tip_mm - middle) + errors.offset_mm;
    for (int axis = 0; axis < 3; ++axis)
      tip[axis] += errors.wander_mm * wander[static_cast<std::size_t>(axis)].at(pose.tip_mm - middle);
    course.push_back({pose.time_s, R * tip + t, (R * turn * pose.axis).normalized(), pose.is_cutting});
  }
  return course;
}

std::optional<std::string> find_misfit(const TriMesh& skin, const Contour& tumor_edge, const Vec3& approach,
                                       const std::vector<TipPose>& course) {
  const SurfaceQuery surface(skin);
  const Vec3 middle = curve_centroid(tumor_edge);
  Contour tips;
  std::size_t in_tissue = 0;
  double farthest_mm = 0.0;
  for (std::size_t i = 1; i < course.size(); ++i) {
    // The plunge begins above the tissue, so only poses that the tip reaches sideways count.
    const Vec3 way = course[i].tip_mm - course[i - 1].tip_mm;
    if (!course[i].is_cutting || !(way.cross(course[i].axis).norm() > 0.5 * way.norm())) continue;
    tips.points.push_back(course[i].tip_mm);
    const auto seen = surface.seen_at(course[i].tip_mm, course[i].axis);
    if (seen && seen->distance_mm < -kLeastDepthMm && seen->distance_mm > -kMostDepthMm) ++in_tissue;
    farthest_mm = std::max(farthest_mm, (course[i].tip_mm - middle).norm());
  }
  if (tips.points.size() < 3) return "no course that cuts";
  if (10 * in_tissue < 9 * tips.points.size())
    return fmt::format("a tip in this specimen's tissue at {} of {} poses, up to {:.0f} mm from its tumour", in_tissue,
                       tips.points.size(), farthest_mm);
  if (!contains_in_view(tips, middle, approach))
    return fmt::format("a course that does not go round this specimen's tumour, up to {:.0f} mm from it", farthest_mm);
  return std::nullopt;
}

}  // namespace incise
