#include "robot/own_course.hpp"

#include "robot/hull.hpp"
#include "robot/text_form.hpp"
#include "robot/tip_curve.hpp"

#include <incise/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise::robot_detail {
namespace {

constexpr double kSpacingMm = 0.05;    // chords deviate by 2e-5 mm at 15 mm radius
constexpr double kRoundingMm_s = 0.2;  // of speeds, from a table of six decimals in cycles of 2 ms

/// One place of the course, with the speed from it to the next.
struct CoursePlace {
  Vec3 tip_mm, axis;
  double arc_mm = 0.0;  ///< from the program's first pose
  double speed_mm_s = 0.0;
};

/// The course that a program was made for: down the axis, along the curve with its overlap, up the axis.
class OwnCourse {
 public:
  explicit OwnCourse(const WrittenProgram& program) {
    const ToolPath& path = *program.path;
    const ProgramSettings& s = program.record->settings;
    double fastest = 0.0;
    for (const Waypoint& waypoint : path.waypoints) fastest = std::max(fastest, waypoint.speed_mm_s);
    ramp_mm_ = 2.0 * s.max_spacing_mm + fastest * fastest / s.acceleration_mm_s2;
    const TipCurve curve(path);
    const double length_mm = curve.length_mm() + (path.is_closed ? s.overlap_mm : 0.0);
    const TipSample first = curve.at(0.0), last = curve.at(length_mm);
    add_above(first, s.approach_height_mm, s.approach_speed_mm_s);
    add_above(first, s.clearance_mm, s.plunge_speed_mm_s);
    add_above(first, 0.0, s.plunge_speed_mm_s);
    surface_in_mm_ = places_.back().arc_mm;
    const auto steps = static_cast<std::size_t>(std::ceil(length_mm / kSpacingMm));
    for (std::size_t i = 0; i <= steps; ++i) {
      const TipSample place = curve.at(length_mm * static_cast<double>(i) / static_cast<double>(steps));
      add(place.tip_mm, place.axis, i < steps ? place.speed_mm_s : s.plunge_speed_mm_s);
      if (i == 0) cut_begin_mm_ = places_.back().arc_mm;
    }
    cut_end_mm_ = places_.back().arc_mm;
    add_above(last, 0.0, s.plunge_speed_mm_s);
    surface_out_mm_ = places_.back().arc_mm;
    add_above(last, s.clearance_mm, s.approach_speed_mm_s);
    add_above(last, s.approach_height_mm, s.approach_speed_mm_s);
  }
  [[nodiscard]] const std::vector<CoursePlace>& places() const { return places_; }
  [[nodiscard]] double length_mm() const { return places_.back().arc_mm; }
  [[nodiscard]] bool is_in_tissue(double arc_mm) const { return arc_mm > surface_in_mm_ && arc_mm < surface_out_mm_; }
  /// Whether a place lies on the curve, far enough from its ends and from other speeds for the tip to have full speed.
  [[nodiscard]] bool is_steady(std::size_t place) const {
    const double arc_mm = places_[place].arc_mm, speed = places_[place].speed_mm_s;
    if (arc_mm < cut_begin_mm_ + ramp_mm_ || arc_mm > cut_end_mm_ - ramp_mm_) return false;
    for (std::size_t i = place; places_[i].arc_mm > arc_mm - ramp_mm_; --i) {
      if (places_[i].speed_mm_s != speed) return false;
    }
    for (std::size_t i = place; places_[i].arc_mm < arc_mm + ramp_mm_; ++i) {
      if (places_[i].speed_mm_s != speed) return false;
    }
    return true;
  }
  /// The greatest intended speed near an arc length, where `place` is the place before it. Near a change, either speed
  /// is allowed: along the curve, a move may begin before its waypoint, and slowing down takes some distance. The
  /// straight legs end at rest.
  [[nodiscard]] double speed_about(std::size_t place, double arc_mm) const {
    constexpr double kNearMm = 0.3;
    const bool is_cut = arc_mm > cut_begin_mm_ + kNearMm && arc_mm < cut_end_mm_ - kNearMm;
    const double first_mm = is_cut ? std::max(cut_begin_mm_, arc_mm - ramp_mm_) : arc_mm - kNearMm;
    const double last_mm = is_cut ? std::min(cut_end_mm_, arc_mm + ramp_mm_) : arc_mm + kNearMm;
    double speed = places_[place].speed_mm_s;
    for (std::size_t i = place; i > 0 && places_[i].arc_mm > first_mm; --i)
      speed = std::max(speed, places_[i - 1].speed_mm_s);
    for (std::size_t i = place + 1; i < places_.size() && places_[i].arc_mm < last_mm; ++i)
      speed = std::max(speed, places_[i].speed_mm_s);
    return speed;
  }

 private:
  void add(const Vec3& tip_mm, const Vec3& axis, double speed_mm_s) {
    const double way_mm = places_.empty() ? 0.0 : places_.back().arc_mm + (tip_mm - places_.back().tip_mm).norm();
    places_.push_back({tip_mm, axis, way_mm, speed_mm_s});
  }
  void add_above(const TipSample& place, double height_mm, double speed_mm_s) {
    add(place.tip_mm - (place.depth_mm + height_mm) * place.axis, place.axis, speed_mm_s);
  }
  std::vector<CoursePlace> places_;
  double ramp_mm_ = 0.0;  ///< twice the distance to reach the greatest speed, plus two moves
  double surface_in_mm_ = 0.0, surface_out_mm_ = 0.0, cut_begin_mm_ = 0.0, cut_end_mm_ = 0.0;
};

/// Finds a tip's place on the course: the nearest place in a window about the last one, so that the overlap of a ring
/// is not taken for its beginning.
class Follower {
 public:
  explicit Follower(const OwnCourse& course) : places_(course.places()) {}
  struct Place {
    std::size_t index = 0;
    double arc_mm = 0.0, distance_mm = std::numeric_limits<double>::infinity();
    Vec3 axis = Vec3::Zero();
  };
  Place operator()(const Vec3& tip_mm) {
    constexpr std::size_t kWindow = 60;  // 3 mm of the curve either way
    Place best;
    const std::size_t low = last_ > kWindow ? last_ - kWindow : 0;
    const std::size_t high = std::min(places_.size() - 1, last_ + kWindow);
    for (std::size_t i = low; i < high; ++i) {
      const auto [t, distance_mm] = nearest_on_segment(tip_mm, places_[i].tip_mm, places_[i + 1].tip_mm);
      if (distance_mm >= best.distance_mm) continue;
      best = {i, places_[i].arc_mm + t * (places_[i + 1].arc_mm - places_[i].arc_mm), distance_mm,
              ((1.0 - t) * places_[i].axis + t * places_[i + 1].axis).normalized()};
    }
    last_ = best.index;
    return best;
  }

 private:
  const std::vector<CoursePlace>& places_;
  std::size_t last_ = 0;
};

/// The greatest of some positive values, and its time.
struct Peak {
  double value = 0.0, time_s = 0.0, limit = 0.0;
  void see(double candidate, double at_s, double its_limit = 0.0) {
    if (candidate <= value) return;
    *this = {candidate, at_s, its_limit};
  }
};

/// Measures of a replay along the course in its program's header.
struct Conduct {
  Peak deviation_mm, lean_deg, way_back_mm;
  Peak too_fast, too_slow;  ///< excess over the tolerance, mm/s; `limit` is the intended speed
  double first_arc_mm = 0.0, last_arc_mm = 0.0, rest_s = 0.0;
};

Conduct conduct_of(const Replay& replay, const OwnCourse& course, const PlayerSettings& settings) {
  constexpr double kRestShare = 0.2;  // of the intended speed
  Conduct conduct;
  Follower follow(course);
  double farthest_mm = 0.0, last_s = replay.samples.front().time_s;
  for (const ReplaySample& sample : replay.samples) {
    const Follower::Place place = follow(sample.tip_mm);
    if (&sample == &replay.samples.front()) conduct.first_arc_mm = place.arc_mm;
    conduct.last_arc_mm = place.arc_mm;
    conduct.deviation_mm.see(place.distance_mm, sample.time_s);
    conduct.lean_deg.see(
        units::deg_from_rad(std::atan2(place.axis.cross(sample.axis).norm(), place.axis.dot(sample.axis))),
        sample.time_s);
    farthest_mm = std::max(farthest_mm, place.arc_mm);
    conduct.way_back_mm.see(farthest_mm - place.arc_mm, sample.time_s);
    const double speed = sample.tip_speed_mm_s, nominal = course.places()[place.index].speed_mm_s;
    const double most = course.speed_about(place.index, place.arc_mm);
    conduct.too_fast.see(speed - most * (1.0 + settings.speed_tolerance) - kRoundingMm_s, sample.time_s, most);
    const double least = settings.speed_slider * nominal;
    if (course.is_steady(place.index))
      conduct.too_slow.see(least * (1.0 - settings.speed_tolerance) - kRoundingMm_s - speed, sample.time_s, nominal);
    if (course.is_in_tissue(place.arc_mm) && speed < kRestShare * least) conduct.rest_s += sample.time_s - last_s;
    last_s = sample.time_s;
  }
  return conduct;
}

/// The first move with more acceleration than the program was made with, or a movej faster than incise writes it.
const ScriptCommand* hasty_command(const WrittenProgram& program) {
  constexpr double kRounding = 1.001;
  for (const ScriptCommand& command : program.commands) {
    using Kind = ScriptCommand::Kind;
    const bool is_straight = command.kind == Kind::MoveL || command.kind == Kind::MoveP;
    if (is_straight && command.acceleration > kRounding * program.record->settings.acceleration_mm_s2) return &command;
    if (command.kind == Kind::MoveJ &&
        (command.acceleration > kRounding * kStartAcceleration || command.speed > kRounding * kStartSpeed))
      return &command;
  }
  return nullptr;
}

}  // namespace

void end_replay(Replay& replay, ReplayOutcome outcome, std::string reason, std::size_t line) {
  replay.outcome = outcome;
  replay.reason = std::move(reason);
  replay.line = line;
}

void judge_own_course(Replay& replay, const WrittenProgram& program, const PlayerSettings& settings) {
  if (replay.outcome != ReplayOutcome::Completed || !program.path || !program.record) return;
  const OwnCourse course(program);
  const Conduct conduct = conduct_of(replay, course, settings);
  const double left_mm = std::max(conduct.first_arc_mm, course.length_mm() - conduct.last_arc_mm);
  const bool is_at_full_speed = settings.speed_slider == 1.0;  // a slowed arm has not arrived when its stream ends
  if (conduct.deviation_mm.value > settings.max_deviation_mm) {
    end_replay(replay, ReplayOutcome::OffCourse,
               fmt::format("at {:.2f} s the tip is {:.2f} mm off the course in the header; at most {} mm are allowed",
                           conduct.deviation_mm.time_s, conduct.deviation_mm.value, settings.max_deviation_mm));
  } else if (conduct.lean_deg.value > settings.max_lean_deg) {
    end_replay(replay, ReplayOutcome::WrongAxis,
               fmt::format("at {:.2f} s the tool leans {:.1f} degrees from its intended axis; at most {} are allowed",
                           conduct.lean_deg.time_s, conduct.lean_deg.value, settings.max_lean_deg));
  } else if (conduct.way_back_mm.value > settings.max_way_back_mm) {
    end_replay(replay, ReplayOutcome::WrongOrder,
               fmt::format("at {:.2f} s the tip has gone back {:.2f} mm along its course", conduct.way_back_mm.time_s,
                           conduct.way_back_mm.value));
  } else if (is_at_full_speed && left_mm > settings.max_way_left_mm) {
    end_replay(replay, ReplayOutcome::WrongOrder,
               fmt::format("the program leaves out {:.2f} mm of its course at the {}", left_mm,
                           left_mm == conduct.first_arc_mm ? "beginning" : "end"));
  } else if (conduct.too_fast.value > 0.0 || conduct.too_slow.value > 0.0) {
    const bool is_fast = conduct.too_fast.value > 0.0;
    const Peak& worst = is_fast ? conduct.too_fast : conduct.too_slow;
    end_replay(
        replay, ReplayOutcome::WrongSpeed,
        fmt::format("at {:.2f} s the tip is {} than the intended {} mm/s, by {:.3g} mm/s more than the tolerance",
                    worst.time_s, is_fast ? "faster" : "slower", worst.limit, worst.value));
  } else if (const ScriptCommand* command = hasty_command(program)) {
    end_replay(replay, ReplayOutcome::WrongSpeed,
               "a move has more acceleration or speed than the program was made with", command->line);
  } else if (is_at_full_speed && conduct.rest_s > program.record->settings.dwell_s + settings.max_rest_s) {
    end_replay(replay, ReplayOutcome::RestsInTissue,
               fmt::format("the tip rests in the tissue for {:.2f} s; the intended rest is {} s", conduct.rest_s,
                           program.record->settings.dwell_s));
  }
}

bool is_overridden(const ProgramHeader& header, const std::string& check) {
  return can_be_overridden(check) && std::any_of(header.begin(), header.end(), [&check](const auto& entry) {
           return entry.first == "override" && entry.second.starts_with(check + ":");
         });
}

void judge_limits(Replay& replay, const WrittenProgram& program, const ArmModel& arm) {
  constexpr std::size_t kStride = 2;  // every 4 ms: 0.2 mm at 50 mm/s
  constexpr double kMarginMm = 0.5;   // by this sampling, and by chords, a value may lie below that of the export
  constexpr double kMarginDeg = 0.1;
  if (replay.outcome != ReplayOutcome::Completed) return;
  const ProgramRecord record = program.record.value_or(ProgramRecord{});
  const CheckSettings& limits = record.limits;
  const double table_z_mm = record.setup.table_z_mm;
  const Instrument instrument = instrument_of(program.T_flange_tool, limits);
  struct Limit {
    const char* name;
    double least, found, time_s;
  };
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::array all{Limit{"table", limits.table_clearance_mm - kMarginMm, kFar, 0.0},
                 Limit{"tool_table", limits.tool_table_clearance_mm - kMarginMm, kFar, 0.0},
                 Limit{"self_collision", limits.arm_clearance_mm - kMarginMm, kFar, 0.0},
                 Limit{"base", limits.arm_clearance_mm - kMarginMm, kFar, 0.0},
                 Limit{"joint_limits", limits.joint_margin_deg - kMarginDeg, kFar, 0.0},
                 Limit{"singularity", 0.99 * limits.min_singular_value, kFar, 0.0}};
  for (std::size_t i = 0; i < replay.samples.size(); i += kStride) {
    const ReplaySample& sample = replay.samples[i];
    const Hulls hulls = hulls_at(arm, sample.q_rad, instrument, table_z_mm);
    const Capsule& shaft = of(hulls, Hull::Shaft);
    const double found[]{
        table_clearance_mm(arm, sample.q_rad, table_z_mm),
        std::min(sample.tip_mm.z(), std::min(shaft.from_mm.z(), shaft.to_mm.z()) - shaft.radius_mm) - table_z_mm,
        least_distance_mm(hulls, self_pairs()),
        least_distance_mm(hulls, base_pairs()),
        units::deg_from_rad(std::min((sample.q_rad - arm.min_rad).minCoeff(), (arm.max_rad - sample.q_rad).minCoeff())),
        smallest_singular_value(arm, sample.q_rad)};
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (found[k] >= all[k].found) continue;
      all[k].found = found[k];
      all[k].time_s = sample.time_s;
    }
  }
  for (const Limit& limit : all) {
    if (limit.found >= limit.least || is_overridden(program.header, limit.name)) continue;
    return end_replay(
        replay, ReplayOutcome::BreaksLimit,
        fmt::format("{}: {:.4g} at {:.2f} s, must be >= {:.4g}", limit.name, limit.found, limit.time_s, limit.least));
  }
}

}  // namespace incise::robot_detail
