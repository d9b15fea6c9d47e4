#include "robot/check_list.hpp"

#include <incise/core/error.hpp>
#include <incise/core/median.hpp>
#include <incise/core/units.hpp>
#include <incise/geometry/contour_checks.hpp>
#include <incise/robot/checks.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace incise {
namespace {

using robot_detail::CheckList;
using robot_detail::Worst;

constexpr double kClosedToMm = 0.01;
constexpr double kLeastAreaMm2 = 0.01;  // of a tumour edge: with less it is a line or a point
constexpr std::array<const char*, 33> kNames{"finite",
                                             "frame",
                                             "closed",
                                             "gap",
                                             "self_crossing",
                                             "speed_min",
                                             "speed_max",
                                             "depth",
                                             "margin",
                                             "heat",
                                             "encloses",
                                             "edge_distance",
                                             "deviation",
                                             "chord_error",
                                             "tilt",
                                             "tool_table",
                                             "reach",
                                             "joint_limits",
                                             "joint_speed",
                                             "joint_acceleration",
                                             "singularity",
                                             "tip_speed",
                                             "table",
                                             "self_collision",
                                             "base",
                                             "surface_collision",
                                             "shaft",
                                             "needle",
                                             "power",
                                             "registration_scale",
                                             "registration_rmse",
                                             "registration_inliers",
                                             "registration_converged"};
constexpr std::array<const char*, 4> kFixed{"finite", "frame", "reach", "margin"};

/// Poses of the cut, with the end of the plunge, where the cut begins, but without the overlap.
std::vector<std::size_t> cut_poses(const RobotProgram& program) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < program.poses.size(); ++i) {
    const ProgramPhase phase = program.poses[i].phase;
    if (phase == ProgramPhase::Cut || phase == ProgramPhase::Plunge) result.push_back(i);
  }
  return result;
}

/// The needle's entry points at these poses.
Contour entries_of(const RobotProgram& program, const std::vector<std::size_t>& cut) {
  Contour entries{{}, program.is_closed};
  for (const std::size_t i : cut) entries.points.push_back(program.poses[i].entry_mm());
  return entries;
}

bool is_finite(const ProgramPose& p) {
  return p.tip_mm.allFinite() && p.R_robot_tool.allFinite() && p.rotation_vector.allFinite() &&
         std::isfinite(p.time_s) && std::isfinite(p.tip_speed_mm_s) && std::isfinite(p.depth_mm);
}

bool check_finite(CheckList& list) {
  const RobotProgram& program = list.program();
  std::optional<std::size_t> bad;
  for (std::size_t i = program.poses.size(); i-- > 0;) {
    if (!is_finite(program.poses[i])) bad = i;
  }
  for (const JointSample& s : program.motion.samples) {
    const bool is_good = s.q_rad.allFinite() && s.speed_rad_s.allFinite() && s.acceleration_rad_s2.allFinite();
    if (!is_good && !bad) bad = s.pose;
  }
  list.holds("finite", !bad, "every number of the program is finite", bad);
  return !bad;
}

/// A place on the course that is checked: a pose of the cut or a waypoint.
struct CoursePlace {
  Vec3 entry_mm;
  Vec3 tip_mm;
  double depth_mm;
  std::size_t pose;  ///< the pose that a failed check names
};

std::vector<CoursePlace> places_of(const RobotProgram& program, const ToolPath& path,
                                   const std::vector<std::size_t>& cut) {
  std::vector<CoursePlace> places;
  for (const std::size_t i : cut)
    places.push_back({program.poses[i].entry_mm(), program.poses[i].tip_mm, program.poses[i].depth_mm, i});
  for (std::size_t w = 0; w < path.waypoints.size(); ++w) {
    // The first pose at or after the waypoint; a course may have fewer poses than waypoints.
    const auto after =
        std::find_if(cut.begin(), cut.end(), [&](std::size_t i) { return program.poses[i].waypoint >= w; });
    const Waypoint& waypoint = path.waypoints[w];
    const Vec3 tip_mm = waypoint.position_mm + waypoint.depth_mm * waypoint.axis;
    places.push_back({waypoint.position_mm, tip_mm, waypoint.depth_mm, after == cut.end() ? cut.back() : *after});
  }
  return places;
}

Vec3 mean_axis(const ToolPath& path) {
  Vec3 sum = Vec3::Zero();
  for (const Waypoint& waypoint : path.waypoints) sum += waypoint.axis;
  return sum;
}

/// Projects a point along `axis` (unit) into the plane through the origin.
Vec3 seen_along(const Vec3& axis, const Vec3& point) {
  return point - axis.dot(point) * axis;
}
Contour seen_along(const Vec3& axis, Contour contour) {
  for (Vec3& point : contour.points) point = seen_along(axis, point);
  return contour;
}

/// Number of points that represent a contour, its sides included.
std::size_t places_along(const Contour& contour) {
  constexpr double kStepMm = 0.2;
  constexpr double kMost = 5000.0;
  return static_cast<std::size_t>(std::clamp(std::ceil(length_mm(contour) / kStepMm), 3.0, kMost));
}

std::string place_text(const Vec3& p) {
  return fmt::format("{:.2f}, {:.2f}, {:.2f} mm", p.x(), p.y(), p.z());
}

/// Makes the checks of the course, which need no arm.
class CourseChecker {
 public:
  CourseChecker(CheckList& list, const ToolPath& path, const CheckSettings& settings)
      : list_(list),
        program_(list.program()),
        path_(path),
        settings_(settings),
        cut_(cut_poses(program_)),
        entries_(entries_of(program_, cut_)),
        places_(places_of(program_, path, cut_)),
        axis_(mean_axis(path).normalized()) {}

  void closed() {
    const double gap = (program_.poses[cut_.back()].tip_mm - program_.poses[cut_.front()].tip_mm).norm();
    if (path_.is_closed && program_.is_closed) {
      list_.at_most("closed", gap, kClosedToMm, "mm", cut_.back(), "gap between the end and the beginning of the ring");
    } else {
      list_.holds("closed", false, "the path is open but must be a ring", cut_.back());
    }
  }

  /// A lost waypoint would go unnoticed otherwise: the course joins any two neighbouring waypoints.
  void gap() {
    const WaypointGap widest = widest_gap(path_, settings_);
    const auto pose = std::find_if(cut_.begin(), cut_.end(),
                                   [&](std::size_t i) { return program_.poses[i].waypoint >= widest.after; });
    list_.at_most("gap", widest.longest_mm, widest.limit_mm, "mm", pose == cut_.end() ? cut_.back() : *pose,
                  "longest distance between neighbouring waypoints of the ring. The check assumes evenly spaced "
                  "waypoints: sample long straight sides as finely as curves");
  }

  void self_crossing() {
    Contour course = entries_;
    if (program_.is_closed && course.points.size() > 1) course.points.pop_back();  // it does not repeat its first
    const auto place = first_crossing(course);
    list_.holds("self_crossing", !place, "the course does not cross itself, seen along the mean axis", place);
  }

  void speed() {
    const bool is_mark = path_.kind == PathKind::Mark;
    const double least =
        is_mark ? settings_.mark_speed_mm_s * (1.0 - settings_.mark_speed_tolerance) : settings_.min_speed_mm_s;
    const double most =
        is_mark ? settings_.mark_speed_mm_s * (1.0 + settings_.mark_speed_tolerance) : settings_.max_speed_mm_s;
    Worst fastest, slowest;
    for (std::size_t i = 0; i < program_.poses.size(); ++i) {
      const ProgramPose& pose = program_.poses[i];
      if (!is_cut(pose.phase)) continue;
      fastest.see(pose.tip_speed_mm_s, i);
      slowest.see(-pose.tip_speed_mm_s, i);
    }
    const char* what = is_mark ? "mark" : "cut";
    list_.at_least("speed_min", -slowest.value, least, "mm/s", slowest.pose,
                   fmt::format("least tip speed of the {}", what));
    list_.at_most("speed_max", fastest.value, most, "mm/s", fastest.pose,
                  fmt::format("greatest tip speed of the {}", what));
  }

  void depth(const TriMesh* surface) {
    const bool is_mark = path_.kind == PathKind::Mark;
    const double planned = is_mark ? settings_.mark_depth_mm : settings_.planned_depth_mm;
    const double tolerance = is_mark ? settings_.mark_depth_tolerance_mm : settings_.depth_tolerance_mm;
    if (surface != nullptr) return robot_detail::check_depth_in(list_, *surface, planned, tolerance);
    Worst worst;
    double at_worst = planned;
    for (const CoursePlace& p : places_) {
      const double difference = std::abs(p.depth_mm - planned);
      if (difference > worst.value) at_worst = p.depth_mm;
      worst.see(difference, p.pose);
    }
    list_.at_most("depth", worst.value, tolerance, "mm", worst.pose,
                  fmt::format("greatest difference between the path's depth ({:.4g} mm there) and the planned {} mm",
                              at_worst, planned));
  }

  void margin(const std::optional<double>& heat_half_width_mm) {
    if (path_.kind == PathKind::Mark) return edge_distance();
    if (!heat_half_width_mm) list_.not_made("heat beside the needle: power or tissue is not known");
    if (path_.tumor_edge.points.empty() && !settings_.must_be_ring)
      return list_.not_made("margin to the tumour edge: the path has none");
    if (path_.tumor_edge.points.size() < 3) {
      return list_.holds("margin", false,
                         "the cut keeps clear of the tumour edge: the path has no tumour edge of three or more points");
    }
    if (!path_.tumor_edge.is_closed) {
      list_.holds("margin", false, "the tumour edge is closed: this one is open, so its inside is not known");
    } else if (const auto at = first_crossing_in_view(path_.tumor_edge, axis_)) {
      list_.holds(
          "margin", false,
          fmt::format("the tumour edge is a simple curve, seen along the mean axis: it crosses itself at {}, so "
                      "its inside is not known",
                      place_text(*at)));
    } else if (std::abs(signed_area_mm2(path_.tumor_edge, axis_)) < kLeastAreaMm2) {
      list_.holds("margin", false,
                  fmt::format("the tumour edge has an area, seen along the mean axis: its {} points lie on a line or "
                              "coincide",
                              path_.tumor_edge.points.size()));
    } else {
      keeps_away(heat_half_width_mm);
    }
    if (settings_.must_be_ring) encloses();
  }

  void keeps_away(const std::optional<double>& heat_half_width_mm) {
    const Contour seen_edge = seen_along(axis_, path_.tumor_edge);
    Worst closest;  // of the negative margin
    const auto see = [&](double distance, const Vec3& point, std::size_t pose) {
      const bool is_inside = contains_in_view(path_.tumor_edge, point, axis_);
      closest.see(is_inside ? distance : -distance, pose);
    };
    for (const CoursePlace& p : places_) {
      see(nearest_on(path_.tumor_edge, p.entry_mm).distance_mm, p.entry_mm, p.pose);
      // The tumour beneath the edge is not known, so the tip must stay outside the whole edge as seen from above.
      see(nearest_on(seen_edge, seen_along(axis_, p.tip_mm)).distance_mm, p.tip_mm, p.pose);
    }
    list_.at_least("margin", -closest.value, settings_.close_margin_mm, "mm", closest.pose,
                   "least distance from the tumour edge of the needle's entry, and of its tip as seen along the mean "
                   "axis (negative: inside)");
    if (!heat_half_width_mm) return;
    list_.at_least("heat", -closest.value, *heat_half_width_mm, "mm", closest.pose,
                   "the same distance; the limit is how far beside the needle heat damages tissue where the path is "
                   "slowest and shallowest");
  }

  void encloses() {
    const Contour ring{entries_.points, true};
    const Contour seen_ring = seen_along(axis_, ring);
    Worst outside, farthest;  // index: of the edge's point
    for (std::size_t k = 0; k < path_.tumor_edge.points.size(); ++k) {
      const Vec3& point = path_.tumor_edge.points[k];
      if (!contains_in_view(ring, point, axis_))
        outside.see(nearest_on(seen_ring, seen_along(axis_, point)).distance_mm, k);
      farthest.see(std::abs(height_above(ring, point)), k);
    }
    if (outside.pose) {
      const Vec3& point = path_.tumor_edge.points[*outside.pose];
      return list_.holds("encloses", false,
                         fmt::format("the ring goes round the tumour edge, seen along the mean axis: the edge lies "
                                     "outside it at {}, by {:.2f} mm",
                                     place_text(point), outside.value),
                         pose_next_to(nearest_on(seen_ring, seen_along(axis_, point))));
    }
    const Vec3& point = path_.tumor_edge.points[*farthest.pose];
    list_.at_most("encloses", farthest.value, settings_.max_edge_height_mm, "mm", pose_next_to(nearest_on(ring, point)),
                  fmt::format("the ring goes round the tumour edge, seen along the mean axis; the edge's point that "
                              "differs most in height lies {} the ring, at {}",
                              height_above(ring, point) < 0.0 ? "below" : "above", place_text(point)));
  }

  void deviation(const ToolPath* intended) {
    if (intended == nullptr) return list_.not_made("deviation from the intended path: no intended path was given");
    const Contour course = entry_contour(*intended);
    Worst worst;
    for (const CoursePlace& p : places_) worst.see(nearest_on(course, p.entry_mm).distance_mm, p.pose);
    for (const Vec3& point : course.points) worst.see(nearest_on(entries_, point).distance_mm, cut_.back());
    list_.at_most("deviation", worst.value, settings_.max_deviation_mm, "mm", worst.pose,
                  "greatest distance between the course and the intended one, measured from each to the other");
  }

  /// Robot and tissue are on or above the table, so a tool that comes from below indicates a wrong frame.
  void tilt() {
    Worst steepest;
    for (std::size_t i = 0; i < program_.poses.size(); ++i) {
      steepest.see(tilt_deg(program_.poses[i].R_robot_tool.col(2)), i);
    }
    list_.at_most("tilt", steepest.value, settings_.max_tilt_deg, "deg", steepest.pose,
                  "greatest angle of the tool from straight down");
  }

  void tool_table() {
    const double table_z_mm = program_.setup.table_z_mm;
    const Vec3 flange_in_tool = program_.setup.T_flange_tool.inverse().topRightCorner<3, 1>();
    Worst lowest;
    for (std::size_t i = 0; i < program_.poses.size(); ++i) {
      const ProgramPose& pose = program_.poses[i];
      const Vec3 needle_mm = pose.tip_mm - settings_.needle_length_mm * pose.R_robot_tool.col(2);
      const Vec3 flange_mm = pose.tip_mm + pose.R_robot_tool * flange_in_tool;
      const double shaft_z_mm = std::min(needle_mm.z(), flange_mm.z()) - settings_.shaft_radius_mm;
      lowest.see(table_z_mm - std::min(pose.tip_mm.z(), shaft_z_mm), i);
    }
    list_.at_least("tool_table", -lowest.value, settings_.tool_table_clearance_mm, "mm", lowest.pose,
                   fmt::format("least height of the tool's tip and shaft above the table at z = {} mm", table_z_mm));
  }

  void chord_error() {
    list_.at_most("chord_error", program_.chord_error_mm, settings_.max_chord_error_mm, "mm", std::nullopt,
                  "greatest distance of the straight moves from the smooth course");
  }

 private:
  void edge_distance() {
    if (path_.tumor_edge.points.size() < 2) {
      return list_.holds("edge_distance", false, "a mark follows the tumour edge: the path has none");
    }
    Worst farthest;
    for (const CoursePlace& p : places_) farthest.see(nearest_on(path_.tumor_edge, p.entry_mm).distance_mm, p.pose);
    // A part of the edge that the mark omits shows only in the distances from the edge.
    Points edge = path_.tumor_edge.points;
    if (length_mm(path_.tumor_edge) > 0.0) {
      const Points between = resample(path_.tumor_edge, places_along(path_.tumor_edge)).points;
      edge.insert(edge.end(), between.begin(), between.end());
    }
    for (const Vec3& point : edge) {
      const ContourPoint place = nearest_on(entries_, point);
      farthest.see(place.distance_mm, pose_next_to(place));
    }
    list_.at_most("edge_distance", farthest.value, settings_.mark_distance_mm, "mm", farthest.pose,
                  "greatest distance between the mark and the tumour edge, measured from each to the other");
  }

  /// Height of `point` above the nearest place of the ring, against the mean axis, mm; negative below it.
  [[nodiscard]] double height_above(const Contour& ring, const Vec3& point) const {
    return axis_.dot(nearest_on(ring, point).position_mm - point);
  }

  /// The pose next to a place on the contour of the entry points.
  [[nodiscard]] std::size_t pose_next_to(const ContourPoint& place) const {
    return cut_[(place.segment + (place.fraction > 0.5 ? 1 : 0)) % cut_.size()];
  }

  /// The pose at which the course first crosses itself, found by bisection over the number of points.
  [[nodiscard]] std::optional<std::size_t> first_crossing(const Contour& course) const {
    if (!crosses_itself_in_view(course, axis_)) return std::nullopt;
    std::size_t low = 3, high = course.points.size();  // the first `low` points, joined openly, do not cross
    const auto crosses = [&](std::size_t count) {
      return crosses_itself_in_view(
          {{course.points.begin(), course.points.begin() + static_cast<std::ptrdiff_t>(count)}, false}, axis_);
    };
    while (low + 1 < high) {
      const std::size_t middle = (low + high) / 2;
      (crosses(middle) ? high : low) = middle;
    }
    return cut_[high - 1];
  }

  CheckList& list_;
  const RobotProgram& program_;
  const ToolPath& path_;
  const CheckSettings& settings_;
  std::vector<std::size_t> cut_;
  Contour entries_;  ///< point i: of pose cut_[i]
  std::vector<CoursePlace> places_;
  Vec3 axis_;
};

void check_power(CheckList& list, const CheckInputs& inputs, const CheckSettings& s) {
  if (!inputs.power_w) return list.not_made("power of the electrode: not given");
  const bool is_low = *inputs.power_w < s.min_power_w;
  const std::string text = fmt::format("power of the electrode, in {} to {} W", s.min_power_w, s.max_power_w);
  if (is_low)
    list.at_least("power", *inputs.power_w, s.min_power_w, "W", std::nullopt, text);
  else
    list.at_most("power", *inputs.power_w, s.max_power_w, "W", std::nullopt, text);
}

void check_registration(CheckList& list, const CheckInputs& inputs, const CheckSettings& s) {
  if (!inputs.registration) return list.not_made("registration: none was given");
  const RegistrationSummary& r = *inputs.registration;
  list.inside("registration_scale", r.scale, s.min_scale, s.max_scale,
              fmt::format("scale between the two clouds as the sensors gave them, between {} and {}: both sensors are "
                          "metric",
                          s.min_scale, s.max_scale));
  list.at_most("registration_rmse", r.rmse_mm, s.max_rmse_mm, "mm", std::nullopt, "residual of the registration");
  list.at_least("registration_inliers", r.inlier_fraction, s.min_inlier_fraction, "", std::nullopt,
                "share of points that the registration explains");
  list.holds("registration_converged", r.is_converged, "the registration has converged");
}

}  // namespace

WaypointGap widest_gap(const ToolPath& path, const CheckSettings& settings) {
  INCISE_REQUIRE(!path.waypoints.empty(), "expected a path with waypoints, found none");
  std::vector<double> ways_mm;
  for (std::size_t w = 0; w < path.waypoints.size(); ++w) {
    const Waypoint& next = path.waypoints[(w + 1) % path.waypoints.size()];
    ways_mm.push_back((next.position_mm - path.waypoints[w].position_mm).norm());
  }
  const auto longest = std::max_element(ways_mm.begin(), ways_mm.end());
  WaypointGap gap{*longest, 0.0, static_cast<std::size_t>(longest - ways_mm.begin())};
  gap.limit_mm = std::max(settings.max_gap_mm, settings.max_gap_ratio * median(ways_mm));
  return gap;
}

double tilt_deg(const Vec3& axis) {
  return units::deg_from_rad(std::acos(std::clamp(-axis.z(), -1.0, 1.0)));
}

std::string ProgramCheck::message() const {
  std::string where;
  if (waypoint) where = fmt::format(" at waypoint {} (pose {})", *waypoint, *pose);
  if (relation.empty()) return fmt::format("{}: not satisfied{}: {}", name, where, text);
  const std::string with_unit = unit.empty() ? "" : " " + unit;
  return fmt::format("{}: {:.4g}{}{}, must be {} {:.4g}{}: {}", name, value, with_unit, where, relation, limit,
                     with_unit, text);
}

std::span<const char* const> check_names() {
  return kNames;
}

bool can_be_overridden(const std::string& check) {
  return std::find(kNames.begin(), kNames.end(), check) != kNames.end() &&
         std::find(kFixed.begin(), kFixed.end(), check) == kFixed.end();
}

void override_checks(ProgramChecks& checks, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    INCISE_REQUIRE(can_be_overridden(name), fmt::format("expected a check that can be overridden, found '{}'", name));
    for (ProgramCheck& check : checks.checks) {
      if (check.name == name && !check.passed) check.is_overridden = true;
    }
  }
}

ProgramChecks check_program(const RobotProgram& program, const ToolPath& path, const CheckSettings& settings,
                            const CheckInputs& inputs) {
  INCISE_REQUIRE(cut_poses(program).size() >= 2, "expected a program with a cut, found none");
  INCISE_REQUIRE(inputs.intended == nullptr || inputs.intended->frame == path.frame,
                 "expected the intended path in the same frame as the path");
  ProgramChecks result;
  result.settings = settings;
  result.not_made = {
      "forces on the tissue and on the tool; switching of the electrode",
      "collisions with anything but the arm itself, its base, the table's plane and the given surface; cables; the "
      "way to the start",
      "how well the controller keeps to the program (see the player)"};
  CheckList list(program, result);
  if (!check_finite(list)) {
    result.not_made.insert(result.not_made.begin(), "all others: the program contains numbers that are not finite");
    return result;
  }
  list.holds("frame", path.frame == PathFrame::Robot,
             fmt::format("the path's frame is {}; it must be robot", to_string(path.frame)));
  CourseChecker course(list, path, settings);
  if (settings.must_be_ring) {
    course.closed();
    course.gap();
  } else {
    list.not_made(path.kind == PathKind::Mark ? "closed, gap: the path need not be a ring"
                                              : "closed, gap, encloses: the path need not be a ring");
  }
  course.self_crossing();
  course.speed();
  course.depth(inputs.surface);
  course.margin(inputs.heat_half_width_mm);
  course.deviation(inputs.intended);
  course.chord_error();
  course.tilt();
  course.tool_table();
  robot_detail::check_motion(list, settings);
  robot_detail::check_collisions(list, inputs.surface, settings);
  check_power(list, inputs, settings);
  check_registration(list, inputs, settings);
  return result;
}

}  // namespace incise
