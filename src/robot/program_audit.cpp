#include "robot/own_course.hpp"
#include "robot/program_reading.hpp"
#include "robot/program_record.hpp"
#include "robot/text_form.hpp"

#include <incise/core/error.hpp>
#include <incise/core/verdict.hpp>
#include <incise/robot/program_audit.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>

namespace incise {
namespace {

constexpr std::string_view kNeedMore[]{"heat",
                                       "deviation",
                                       "surface_collision",
                                       "shaft",
                                       "needle",
                                       "power",
                                       "registration_scale",
                                       "registration_rmse",
                                       "registration_inliers",
                                       "registration_converged"};
constexpr double kSameShare = 0.01;  // of value and limit: the header has waypoints to 1 nm and values to 4 digits
constexpr double kSame = 1e-3;
constexpr double kSameAngleRad = 1e-4, kSamePlaceMm = 0.01;

bool needs_more(const std::string& check) {
  return std::find(std::begin(kNeedMore), std::end(kNeedMore), check) != std::end(kNeedMore);
}

/// A line of the header: "margin passed: 5.03 mm >= 2.2 mm" or "frame passed".
struct Claim {
  std::string text;
  bool is_passed = false;
  std::optional<double> value, limit;
};

std::optional<std::pair<std::string, Claim>> claim_of(const std::string& text) {
  std::istringstream words(text);
  std::string name, verdict, word, relation;
  words >> name >> verdict;
  Claim claim{.text = text, .is_passed = verdict == "passed" || verdict == "passed:"};
  const bool has_value = verdict.ends_with(':');
  if (!claim.is_passed && verdict != "FAILED" && verdict != "FAILED:") return std::nullopt;
  if (has_value) {
    if (!(words >> word) || !(claim.value = robot_detail::number_of(word))) return std::nullopt;
    while (words >> word && word != "<=" && word != ">=" && word != "<" && word != ">") {
    }
    if (!(words >> word) || !(claim.limit = robot_detail::number_of(word))) return std::nullopt;
  }
  return std::pair(name, claim);
}

bool is_same(double claimed, double found, double scale) {
  return claimed == found || std::abs(claimed - found) <= kSame + kSameShare * std::abs(scale);
}

class Auditor {
 public:
  explicit Auditor(const WrittenProgram& program) : program_(program) { audit_.digest = program.digest; }

  ProgramAudit audit() {
    read_claims();
    hold_verdict();
    if (!program_.path || !program_.record || !is_sane(*program_.record, *program_.path)) {
      audit_.not_recomputed.emplace_back("all: the header does not say what the program was made with");
      if (audit_.digest != ProgramDigest::Absent)
        contradict("the header does not say what the program was made with: nothing could be checked again");
      return std::move(audit_);
    }
    list_moved_limits();
    try {
      make_again();
    } catch (const InvalidArgument& error) {
      contradict("no program can be made from its header: " + error.as_hint());
    }
    return std::move(audit_);
  }

 private:
  /// Whether making the program again takes acceptable time and memory.
  static bool is_sane(const ProgramRecord& record, const ToolPath& path) {
    constexpr double kLongestPathMm = 1e4;
    double way_mm = 0.0;
    for (std::size_t i = 1; i < path.waypoints.size(); ++i)
      way_mm += (path.waypoints[i].position_mm - path.waypoints[i - 1].position_mm).norm();
    return record.settings.max_spacing_mm >= 0.05 && record.settings.chord_error_mm >= 1e-3 &&
           record.setup.period_s >= 0.002 && way_mm <= kLongestPathMm;
  }

  void contradict(std::string what) { audit_.contradictions.push_back(std::move(what)); }

  void read_claims() {
    for (const auto& [key, value] : program_.header) {
      if (key != "check") continue;
      const auto claim = claim_of(value);
      if (!claim)
        contradict(fmt::format("'{}' is not a line of a check", value));
      else if (!claims_.emplace(*claim).second)
        contradict(fmt::format("{} is listed twice", claim->first));
      else if (!claim->second.is_passed)
        contradict(fmt::format("{} has failed, and nobody accepted it", claim->first));
    }
    for (const std::string& listed : program_.listed_checks) {
      const std::string name = listed.substr(0, listed.find(' '));
      const auto claim = claims_.find(name);
      const bool is_told =
          claim != claims_.end() ? claim->second.text == listed : robot_detail::is_overridden(program_.header, name);
      if (!is_told) contradict(fmt::format("the list of checks says '{}', but the header does not", listed));
    }
  }

  /// Checks the header's lines on the simulated cut: exactly one verdict, equal to the worst of its reasons and not
  /// refused; each caution accepted.
  void hold_verdict() {
    std::vector<std::string> verdicts, accepted;
    for (const auto& [key, value] : program_.header) {
      if (key == "verdict") verdicts.push_back(value);
      if (key == "accepted") accepted.push_back(value);
    }
    constexpr std::string_view kRefused = to_string(VerdictStatus::Refused), kOk = to_string(VerdictStatus::Ok);
    std::string worst(kOk);
    for (const auto& [key, value] : program_.header) {
      if (key != "reason") continue;
      const std::string severity = value.substr(0, value.find(": "));
      const std::string id =
          severity.size() + 2 <= value.size()
              ? value.substr(severity.size() + 2, value.find(": ", severity.size() + 2) - severity.size() - 2)
              : "";
      if (severity == kRefused || worst == kOk) worst = severity;
      if (severity == to_string(VerdictStatus::Caution) &&
          std::find(accepted.begin(), accepted.end(), id) == accepted.end())
        contradict(fmt::format("nobody accepted its caution '{}'", id));
    }
    if (verdicts.size() != 1)
      return contradict(fmt::format("found {} lines with a verdict on the cut, expected one", verdicts.size()));
    if (verdicts.front() == kRefused || worst == kRefused)
      return contradict("the simulated cut is refused: no program is written for it");
    if (verdicts.front() != worst)
      contradict(fmt::format("its verdict is {}, but its reasons give {}", verdicts.front(), worst));
  }

  void list_moved_limits() {
    ProgramRecord usual;
    std::map<std::string, double> by_default;
    robot_detail::describe(usual,
                           [&](const char*, const char* name, const auto& number) { by_default[name] = number; });
    robot_detail::describe(*program_.record, [&](const char* key, const char* name, const auto& number) {
      if (std::string_view(key) == "limit" && by_default[name] != static_cast<double>(number))
        audit_.moved_limits.push_back(
            fmt::format("{} {}, by default {}", name, static_cast<double>(number), by_default[name]));
    });
  }

  void make_again() {
    const ProgramRecord& record = *program_.record;
    const RobotProgram made = make_program(*program_.path, record.settings, record.setup);
    const ProgramChecks checks = check_program(made, *program_.path, record.limits);
    const bool has_surface = claims_.contains("surface_collision") || claims_.contains("shaft");
    for (const ProgramCheck& check : checks.checks) {
      // At a change of speed, rounding in the header decides which sample counts; hold_motion compares the motion.
      if ((check.name == "depth" && has_surface) || (check.name == "tip_speed" && has_changing_speed())) {
        audit_.not_recomputed.push_back(check.name);
        continue;
      }
      audit_.recomputed.push_back(check.name);
      hold(check);
    }
    for (const auto& [name, claim] : claims_) {
      const bool is_made =
          std::any_of(checks.checks.begin(), checks.checks.end(), [&name = name](const auto& c) { return c.name == name; });
      if (is_made) continue;
      if (needs_more(name))
        audit_.not_recomputed.push_back(name);
      else
        contradict(fmt::format("'{}' is not a check of such a program", claim.text));
    }
    hold_numbers(made);
    hold_motion(made);
  }

  [[nodiscard]] bool has_changing_speed() const {
    const auto& waypoints = program_.path->waypoints;
    return std::any_of(waypoints.begin(), waypoints.end(),
                       [&](const Waypoint& w) { return w.speed_mm_s != waypoints.front().speed_mm_s; });
  }

  /// Compares one line of the header with the check that was made again.
  void hold(const ProgramCheck& check) {
    if (robot_detail::is_overridden(program_.header, check.name)) return;
    const auto at = claims_.find(check.name);
    if (at == claims_.end()) return contradict(fmt::format("the header does not mention {}", check.name));
    const Claim& claim = at->second;
    if (!check.passed) return contradict(fmt::format("'{}', but: {}", claim.text, check.message()));
    const bool is_same_kind = claim.value.has_value() == !check.relation.empty();
    const double scale = std::max(std::abs(check.value), std::abs(check.limit));
    if (!is_same_kind || (claim.value && (!is_same(*claim.value, check.value, scale) ||
                                          !is_same(*claim.limit, check.limit, check.limit))))
      contradict(fmt::format("'{}', recomputed '{}'", claim.text, robot_detail::held_against_its_limit(check)));
  }

  /// Compares the header's own numbers, and the poses of JSON.
  void hold_numbers(const RobotProgram& made) {
    const auto told = [this](const char* key) {
      const auto at =
          std::find_if(program_.header.begin(), program_.header.end(), [&](const auto& e) { return e.first == key; });
      return at == program_.header.end() ? std::string("nothing") : at->second;
    };
    for (const auto& [key, value] :
         {std::pair("duration_s", made.duration_s()), std::pair("cut_length_mm", made.cut_length_mm)}) {
      const std::string text = told(key);
      const auto number = robot_detail::number_of(text);
      if (!number || !is_same(*number, value, 0.0))
        contradict(fmt::format("{} {}, recomputed {:.6f}", key, text, value));
    }
    for (const auto& [key, value] :
         {std::pair("branch", to_string(made.motion.branch)), std::pair("robot", made.setup.arm.name)})
      if (told(key) != value) contradict(fmt::format("{} {}, recomputed {}", key, told(key), value));
    if (program_.listed_poses.empty()) return;
    bool is_same_course = program_.listed_poses.size() == made.poses.size();
    for (std::size_t i = 0; is_same_course && i < made.poses.size(); ++i)
      is_same_course = is_same_pose(program_.listed_poses[i], made.poses, i);
    if (!is_same_course) contradict("the poses are not those of the path in the header");
  }

  static bool is_same_pose(const ProgramPose& listed, const std::vector<ProgramPose>& made, std::size_t i) {
    const auto is_same_move = [&](std::size_t k) {
      return listed.phase == made[k].phase &&
             is_same(listed.tip_speed_mm_s, made[k].tip_speed_mm_s, made[k].tip_speed_mm_s);
    };
    return (listed.tip_mm - made[i].tip_mm).norm() < kSamePlaceMm &&
           (listed.rotation_vector - made[i].rotation_vector).norm() <= kSameAngleRad &&
           is_same(listed.time_s, made[i].time_s, 0.0) && std::abs(listed.depth_mm - made[i].depth_mm) < kSamePlaceMm &&
           is_at_or_beside(i, made.size(), is_same_move);
  }

  /// At a change of phase or speed, rounding in the header may move an entry to the other side.
  template <class Holds>
  static bool is_at_or_beside(std::size_t i, std::size_t size, const Holds& holds) {
    return holds(i) || (i > 0 && holds(i - 1)) || (i + 1 < size && holds(i + 1));
  }

  /// Compares moves or rows with those of the program that was made again.
  void hold_motion(const RobotProgram& made) {
    if (made.motion.outcome != MotionOutcome::Found) return;
    if (!program_.joints.empty()) return hold_rows(made);
    const bool is_stream = std::any_of(program_.commands.begin(), program_.commands.end(),
                                       [](const auto& c) { return c.kind == ScriptCommand::Kind::ServoJ; });
    const std::string script =
        to_urscript(made, program_.header, {.motion = is_stream ? ScriptMotion::ServoJ : ScriptMotion::MoveP});
    const std::vector<ScriptCommand> expected = program_from_text(script, "made again").commands;
    hold_commands(program_.commands, expected);
  }

  /// Compares commands one after the other. A stream holds still where a motion ends. The header does not state for how
  /// long, so any number of rests is accepted.
  void hold_commands(const std::vector<ScriptCommand>& found, const std::vector<ScriptCommand>& expected) {
    std::size_t i = 0, k = 0;
    while (i < found.size() || k < expected.size()) {
      if (i < found.size() && k < expected.size() && is_same_command(found[i], expected, k)) {
        ++i;
        ++k;
      } else if (is_rest(found, i)) {
        ++i;
      } else if (is_rest(expected, k)) {
        ++k;
      } else {
        const std::string where = i < found.size() ? fmt::format("line {}", found[i].line) : "its end";
        return contradict(where + ": not the statement that incise writes for the path in the header");
      }
    }
  }

  static bool is_rest(const std::vector<ScriptCommand>& commands, std::size_t i) {
    constexpr double kStillRad = 1e-7;
    return i > 0 && i < commands.size() && commands[i].kind == ScriptCommand::Kind::ServoJ &&
           commands[i - 1].kind == ScriptCommand::Kind::ServoJ &&
           (commands[i].q_rad - commands[i - 1].q_rad).cwiseAbs().maxCoeff() <= kStillRad;
  }

  void hold_rows(const RobotProgram& made) {
    constexpr double kSameRad_s = 1e-2, kSameRad_s2 = 0.1, kSameS = 1e-5;
    const auto& rows = program_.joints;
    const auto& samples = made.motion.samples;
    for (std::size_t i = 0; i < std::min(rows.size(), samples.size()); ++i) {
      const TimedJoints& row = rows[i];
      const auto is_same_phase = [&](std::size_t k) {
        return row.phase == made.poses[std::min(samples[k].pose + 1, made.poses.size() - 1)].phase;
      };
      const auto is_same_acceleration = [&](std::size_t k) {
        const Joints& a = samples[k].acceleration_rad_s2;
        return (*row.acceleration_rad_s2 - a).cwiseAbs().maxCoeff() <=
               kSameRad_s2 + kSameShare * a.cwiseAbs().maxCoeff();
      };
      const Vec3 tip = robot_detail::tip_at(made.setup, row.q_rad);
      const bool is_same_row = (row.q_rad - samples[i].q_rad).cwiseAbs().maxCoeff() <= kSameAngleRad &&
                               (row.speed_rad_s - samples[i].speed_rad_s).cwiseAbs().maxCoeff() <= kSameRad_s &&
                               std::abs(row.time_s - samples[i].time_s) <= kSameS &&
                               (!row.tip_mm || (*row.tip_mm - tip).norm() <= kSamePlaceMm) &&
                               (!row.acceleration_rad_s2 || is_at_or_beside(i, samples.size(), is_same_acceleration)) &&
                               is_at_or_beside(i, samples.size(), is_same_phase);
      if (!is_same_row) return contradict(fmt::format("row {}: not the joints for the path in the header", i));
    }
    if (rows.size() != samples.size())
      contradict(fmt::format("{} rows, but the path in the header gives {}", rows.size(), samples.size()));
  }

  static bool is_same_command(const ScriptCommand& found, const std::vector<ScriptCommand>& expected, std::size_t i) {
    const std::size_t first = i > 0 ? i - 1 : 0, last = std::min(i + 1, expected.size() - 1);
    for (std::size_t k = first; k <= last; ++k) {
      if (expected[k].kind != expected[i].kind) continue;
      ScriptCommand same = expected[i];
      same.phase = expected[k].phase;
      same.speed = expected[k].speed;
      if (is_same_command(found, same)) return true;
    }
    return false;
  }

  static bool is_same_command(const ScriptCommand& a, const ScriptCommand& b) {
    constexpr double kSameBlendShare = 0.3;  // blends are 0 to below 0.5 of the spacing, usually 0.4
    const auto is_near = [](double x, double y) { return std::abs(x - y) <= 1e-3 * std::abs(y) + 1e-9; };
    return a.kind == b.kind && a.phase == b.phase && (a.q_rad - b.q_rad).cwiseAbs().maxCoeff() <= kSameAngleRad &&
           (a.tip_mm - b.tip_mm).norm() <= kSamePlaceMm &&
           (a.rotation_vector - b.rotation_vector).norm() <= kSameAngleRad && is_near(a.gain, b.gain) &&
           is_near(a.lookahead_s, b.lookahead_s) && is_near(a.acceleration, b.acceleration) &&
           is_near(a.speed, b.speed) && is_near(a.seconds, b.seconds) &&
           a.blend_mm <= (1.0 + kSameBlendShare) * b.blend_mm + kSame;
  }

  const WrittenProgram& program_;
  ProgramAudit audit_;
  std::map<std::string, Claim> claims_;
};

}  // namespace

ProgramAudit audit_program(const WrittenProgram& program) {
  return Auditor(program).audit();
}

void judge_audit(Replay& replay, const ProgramAudit& audit) {
  if (replay.outcome != ReplayOutcome::Completed) return;
  if (audit.digest == ProgramDigest::Differs) {
    robot_detail::end_replay(replay, ReplayOutcome::Altered,
                             "its digest differs: the program was changed after it was checked");
  } else if (!audit.contradictions.empty()) {
    robot_detail::end_replay(replay, ReplayOutcome::FalseChecks, audit.contradictions.front());
  }
}

}  // namespace incise
