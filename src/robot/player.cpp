#include "robot/own_course.hpp"
#include "robot/replay_measures.hpp"
#include "robot/tip_route.hpp"

#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/core/units.hpp>
#include <incise/robot/player.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

using robot_detail::end_replay;
using robot_detail::TipRoute;

constexpr double kWithinRad = 1e-6;  // a table has ten digits
constexpr double kJumpRad = 0.05;    // in a cycle of 2 ms: 25 rad/s, ten times the speed of any joint

/// Plays the commands, or the timed joints, into samples.
class Playing {
 public:
  Playing(const WrittenProgram& program, const ArmModel& arm, const PlayerSettings& settings, Replay& replay)
      : program_(program),
        arm_(arm),
        settings_(settings),
        replay_(replay),
        T_tool_flange_(program.T_flange_tool.inverse()) {}

  void run() {
    if (!program_.joints.empty()) return timed_joints();
    const auto& commands = program_.commands;
    q_ = commands.front().q_rad;
    phase_ = commands.front().phase;
    if (!keep(commands.front().line)) return;
    for (std::size_t i = 1; i < commands.size() && replay_.outcome == ReplayOutcome::Completed;) {
      using Kind = ScriptCommand::Kind;
      phase_ = commands[i].phase;
      if (commands[i].kind == Kind::MoveL || commands[i].kind == Kind::MoveP) {
        i = route(i);
      } else if (commands[i].kind == Kind::ServoJ) {
        servo(commands[i++]);
      } else if (commands[i].kind == Kind::Sleep) {
        rest(commands[i++]);
      } else {
        speed_.setZero();  // stopj: the stream has ended
        is_streaming_ = false;
        ++i;
      }
    }
  }

  /// Sets the outcome JointSpeed of a completed replay, if a joint was too fast.
  void judge_speed() {
    constexpr double kRounding = 1e-6;
    if (replay_.outcome != ReplayOutcome::Completed || replay_.max_joint_speed_share <= 1.0 + kRounding) return;
    end_replay(replay_, ReplayOutcome::JointSpeed,
               fmt::format("{} would turn at {:.3g} times its speed limit",
                           arm_.joint_names[static_cast<std::size_t>(fastest_joint_)], replay_.max_joint_speed_share),
               fastest_line_);
  }

 private:
  /// Adds a sample of the arm's present state. @returns whether the replay can continue
  bool keep(std::size_t line) {
    ReplaySample sample;
    sample.time_s = time_;
    sample.q_rad = q_;
    const Mat4 T_base_tool = forward_kinematics(arm_, q_) * program_.T_flange_tool;
    sample.tip_mm = T_base_tool.topRightCorner<3, 1>();
    sample.axis = T_base_tool.block<3, 1>(0, 2);
    sample.phase = phase_;
    if (!replay_.samples.empty()) {
      const ReplaySample& last = replay_.samples.back();
      const double cycle = time_ - last.time_s;
      sample.tip_speed_mm_s = (sample.tip_mm - last.tip_mm).norm() / cycle;
      const Joints share = ((q_ - last.q_rad) / cycle).cwiseAbs().cwiseQuotient(arm_.max_speed_rad_s);
      see_speed(share, line);
    }
    replay_.samples.push_back(sample);
    return is_within_limits(line);
  }

  void see_speed(const Joints& share, std::size_t line) {
    int joint = 0;
    const double fastest = share.maxCoeff(&joint);
    if (fastest <= replay_.max_joint_speed_share) return;
    replay_.max_joint_speed_share = fastest;
    fastest_joint_ = joint;
    fastest_line_ = line;
  }

  /// @returns whether `duration_s` still fits into kLongestProgramS; if not, the replay ends
  bool has_time_for(double duration_s, std::size_t line) {
    if (time_ + duration_s <= kLongestProgramS) return true;
    end_replay(replay_, ReplayOutcome::TooLong,
               fmt::format("the program takes {:.4g} s or more; at most {} s are played", time_ + duration_s,
                           kLongestProgramS),
               line);
    return false;
  }

  bool is_within_limits(std::size_t line) {
    for (int i = 0; i < 6; ++i) {
      if (q_[i] >= arm_.min_rad[i] - kWithinRad && q_[i] <= arm_.max_rad[i] + kWithinRad) continue;
      end_replay(replay_, ReplayOutcome::JointLimits,
                 fmt::format("{} at {:.1f} degrees, outside its limits of {:.0f} to {:.0f}",
                             arm_.joint_names[static_cast<std::size_t>(i)], units::deg_from_rad(q_[i]),
                             units::deg_from_rad(arm_.min_rad[i]), units::deg_from_rad(arm_.max_rad[i])),
                 line);
      return false;
    }
    return true;
  }

  /// Plays moves up to the next stop. @returns the index of the command after it
  std::size_t route(std::size_t first) {
    const auto& commands = program_.commands;
    std::size_t last = first;
    while (commands[last].blend_mm > 0.0 && last + 1 < commands.size() &&
           commands[last + 1].kind == ScriptCommand::Kind::MoveP)
      ++last;
    const Mat4 here = forward_kinematics(arm_, q_) * program_.T_flange_tool;
    const TipRoute way(here.topRightCorner<3, 1>(), here.topLeftCorner<3, 3>(),
                       std::span(commands).subspan(first, last + 1 - first), settings_.speed_slider);
    if (way.do_blends_overlap()) {
      end_replay(replay_, ReplayOutcome::BlendsOverlap, {}, way.overlap_line());
      return commands.size();
    }
    if (!has_time_for(way.duration_s(), commands[first].line)) return commands.size();
    const double begin = time_;
    const auto cycles = static_cast<std::size_t>(std::ceil(way.duration_s() / settings_.cycle_s - 1e-9));
    for (std::size_t k = 1; k <= cycles; ++k) {
      std::size_t command = 0;
      const Mat4 T = way.at(settings_.cycle_s * static_cast<double>(k), command);
      const std::size_t line = commands[first + command].line;
      phase_ = commands[first + command].phase;
      if (!follow(T, line)) return commands.size();
      time_ = begin + settings_.cycle_s * static_cast<double>(k);
      if (!keep(line)) return commands.size();
    }
    speed_.setZero();
    return last + 1;
  }

  /// Sets the joints to the solution for a pose that is nearest to the present joints.
  bool follow(const Mat4& T_base_tool, std::size_t line) {
    const InverseResult inverse = inverse_kinematics(arm_, T_base_tool * T_tool_flange_, q_[5]);
    double nearest = std::numeric_limits<double>::infinity();
    Joints found = q_;
    for (const InverseSolution& solution : inverse.solutions) {
      const Joints q = nearest_turns(solution.q_rad, q_);
      const double step = (q - q_).cwiseAbs().maxCoeff();
      if (step >= nearest) continue;
      nearest = step;
      found = q;
    }
    if (inverse.solutions.empty() || nearest > kJumpRad) {
      end_replay(replay_, inverse.solutions.empty() ? ReplayOutcome::Unreachable : ReplayOutcome::Jump, {}, line);
      return false;
    }
    q_ = found;
    return true;
  }

  void servo(const ScriptCommand& command) {
    // The stream keeps its time; the slider slows the arm.
    if (!is_streaming_) servo_until_ = time_;
    is_streaming_ = true;
    if (!has_time_for(command.seconds, command.line)) return;
    servo_until_ += command.seconds;
    const Joints& target = command.q_rad;
    const auto pull = [&](const Joints& q, const Joints& speed) {
      return Joints(command.gain * (target - q - command.lookahead_s * speed));
    };
    while (time_ + settings_.cycle_s <= servo_until_ + 1e-9) {
      // Classical Runge-Kutta; at 2 ms and the greatest gain the error is below 1e-6 of the step.
      const double h = settings_.speed_slider * settings_.cycle_s;
      const Joints a1 = pull(q_, speed_), v2 = speed_ + 0.5 * h * a1, a2 = pull(q_ + 0.5 * h * speed_, v2);
      const Joints v3 = speed_ + 0.5 * h * a2, a3 = pull(q_ + 0.5 * h * v2, v3);
      const Joints v4 = speed_ + h * a3, a4 = pull(q_ + h * v3, v4);
      q_ += h / 6.0 * (speed_ + 2.0 * v2 + 2.0 * v3 + v4);
      speed_ += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
      time_ += settings_.cycle_s;
      if (!keep(command.line)) return;
    }
  }

  void rest(const ScriptCommand& command) {
    if (!has_time_for(command.seconds, command.line)) return;
    const auto cycles = static_cast<std::size_t>(std::lround(command.seconds / settings_.cycle_s));
    for (std::size_t k = 0; k < cycles; ++k) {
      time_ += settings_.cycle_s;
      if (!keep(command.line)) return;
    }
  }

  void timed_joints() {
    const auto& rows = program_.joints;
    std::size_t i = 0;
    const double end_s = rows.back().time_s - rows.front().time_s;
    if (!has_time_for(end_s / settings_.speed_slider, rows.back().line)) return;
    for (std::size_t k = 0;; ++k) {
      time_ = settings_.cycle_s * static_cast<double>(k);
      const double at = std::min(end_s, settings_.speed_slider * time_) + rows.front().time_s;
      while (i + 2 < rows.size() && rows[i + 1].time_s <= at) ++i;
      const TimedJoints &a = rows[i], &b = rows[i + 1];
      const double h = b.time_s - a.time_s, t = (at - a.time_s) / h, t2 = t * t, t3 = t2 * t;
      q_ = (2 * t3 - 3 * t2 + 1) * a.q_rad + (t3 - 2 * t2 + t) * h * a.speed_rad_s + (3 * t2 - 2 * t3) * b.q_rad +
           (t3 - t2) * h * b.speed_rad_s;
      phase_ = a.phase;
      if (!keep(a.line)) return;
      if (settings_.speed_slider * time_ >= end_s) break;
    }
  }

  const WrittenProgram& program_;
  const ArmModel& arm_;
  const PlayerSettings& settings_;
  Replay& replay_;
  Mat4 T_tool_flange_;
  double time_ = 0.0;
  bool is_streaming_ = false;
  double servo_until_ = 0.0;
  int fastest_joint_ = 0;
  std::size_t fastest_line_ = 0;
  Joints q_ = Joints::Zero(), speed_ = Joints::Zero();
  ProgramPhase phase_ = ProgramPhase::Approach;
};

}  // namespace

void describe(Visitor& v, Replay& r) {
  PlayerSettings& s = r.settings;
  const bool is_course_known = !r.intended_mm.empty();
  const auto if_known = [is_course_known](double value) {
    return is_course_known ? std::optional(value) : std::nullopt;
  };
  v("outcome", r.outcome, "How the replay ended.");
  v.derived("line", r.line > 0 ? std::optional(r.line) : std::nullopt,
            "Line of the program that ends the replay early or demands too much.");
  v("reason", r.reason, "Explanation of the outcome, if it needs one.");
  v.derived("speed_slider_percent", 100.0 * s.speed_slider, "Setting of the controller's speed slider, per cent.");
  v.derived("duration_s", r.duration_s(), "Duration of the whole program.");
  v.derived("max_deviation_mm", if_known(r.max_deviation_mm), "Greatest distance of the tip from the intended course.");
  v.derived("max_deviation_at_s", if_known(r.max_deviation_at_s), "Time of the greatest deviation.");
  v.derived("mean_deviation_mm", if_known(r.mean_deviation_mm), "Mean distance in the cut.");
  v.derived("max_cut_deviation_mm", if_known(r.max_cut_deviation_mm),
            "Greatest distance in the cut; without a cut, in the whole program.");
  v({"allowed_deviation_mm", "Greatest distance allowed for a success.", "mm"}, s.max_deviation_mm);
  v("tip_speed_mm_s", r.tip_speed_mm_s, "Speed of the tip in the cut, away from its ends.");
  v({"end_zone_mm", "Length of the cut at either end in which the tip speeds up or slows down.", "mm"}, s.end_zone_mm);
  v("max_joint_speed_share", r.max_joint_speed_share, "Greatest joint speed, as a share of the joint's limit.");
  v.derived("min_singular_value", if_finite(r.min_singular_value), "Smallest singular value of the arm's Jacobian.");
  v.bulk("samples", r.samples, "Joints and tip over time.");
  v.bulk("intended_mm", r.intended_mm, "The intended course of the tip.");
}

Replay play(const WrittenProgram& program, const ArmModel& arm, const PlayerSettings& settings,
            const ToolPath* intended) {
  require_none(problems_of(settings));
  INCISE_REQUIRE(program.joints.size() >= 2 || (program.joints.empty() && program.commands.size() >= 2),
                 fmt::format("found a program of {} commands and {} rows of joints, expected at least 2 rows of joints "
                             "or, without joints, at least 2 commands",
                             program.commands.size(), program.joints.size()));
  Replay replay;
  replay.settings = settings;
  Playing playing(program, arm, settings, replay);
  playing.run();
  if (intended == nullptr && program.path) intended = &*program.path;
  if (intended != nullptr) replay.intended_mm = robot_detail::intended_course(*intended, program);
  robot_detail::measure_deviation(replay);
  robot_detail::measure_speed(replay, settings.end_zone_mm);
  robot_detail::judge_ends(replay, intended);
  playing.judge_speed();
  robot_detail::judge_deviation(replay, settings.max_deviation_mm);
  robot_detail::judge_own_course(replay, program, settings);
  robot_detail::judge_limits(replay, program, arm);
  replay.min_singular_value = std::numeric_limits<double>::infinity();
  constexpr std::size_t kStride = 10;  // every 20 ms
  for (std::size_t i = 0; i < replay.samples.size(); i += kStride)
    replay.min_singular_value =
        std::min(replay.min_singular_value, smallest_singular_value(arm, replay.samples[i].q_rad));
  return replay;
}

}  // namespace incise
