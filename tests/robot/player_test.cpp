#include "robot/ring_path.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/robot/player.hpp>
#include <incise/robot/program_verdict.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace incise {
namespace {

using incise::testing::leaning_ring;
using incise::testing::line_path;
using incise::testing::ring_path;
using ::testing::HasSubstr;

std::string script_of(const ToolPath& path, const UrScriptSettings& settings = {}) {
  const RobotProgram program = make_program(path);
  return to_urscript(program, program_header(program, path, check_program(program, path)), settings);
}

Replay replayed(const std::string& text, double slider = 1.0, const char* name = "cut.script") {
  return play(program_from_text(text, name), ur10e(), {.speed_slider = slider});
}

TEST(Player, KeepsTheTipOnTheIntendedCourseByMovep) {
  const Replay replay = replayed(script_of(leaning_ring()));
  ASSERT_EQ(replay.outcome, ReplayOutcome::Completed);
  // Chords and blends stay within 0.02 mm each.
  EXPECT_LT(replay.max_deviation_mm, 0.025);
  EXPECT_GT(replay.max_deviation_mm, 0.005);
  EXPECT_NEAR(replay.tip_speed_mm_s.mean, 7.0, 0.01);
  EXPECT_GT(replay.tip_speed_mm_s.min, 0.99 * 7.0);
  EXPECT_LT(replay.tip_speed_mm_s.max, 1.01 * 7.0);
  EXPECT_LT(replay.max_joint_speed_share, 0.2);
}

TEST(Player, KeepsTheTipOnTheIntendedCourseByServoj) {
  const Replay replay = replayed(script_of(leaning_ring(), {.motion = ScriptMotion::ServoJ}));
  ASSERT_EQ(replay.outcome, ReplayOutcome::Completed);
  EXPECT_LT(replay.max_deviation_mm, 0.1);
  EXPECT_NEAR(replay.tip_speed_mm_s.mean, 7.0, 0.07);
  EXPECT_GT(replay.tip_speed_mm_s.min, 0.98 * 7.0);
  EXPECT_LT(replay.tip_speed_mm_s.max, 1.02 * 7.0);
}

TEST(Player, PlaysTheTableAndTheJsonAsTheyWereMade) {
  const ToolPath path = leaning_ring();
  const RobotProgram program = make_program(path);
  const ProgramHeader header = program_header(program, path, check_program(program, path));
  for (const auto& [text, name] : {std::pair(to_joint_csv(program, header), "cut.csv"),
                                   std::pair(program_json(program, nullptr, header), "cut.json")}) {
    const Replay replay = replayed(text, 1.0, name);
    ASSERT_EQ(replay.outcome, ReplayOutcome::Completed);
    EXPECT_LT(replay.max_deviation_mm, 0.001) << name;
    EXPECT_GT(replay.tip_speed_mm_s.min, 0.99 * 7.0) << name;
    EXPECT_LT(replay.tip_speed_mm_s.max, 1.01 * 7.0) << name;
    EXPECT_NEAR(replay.duration_s(), program.duration_s(), 0.01) << name;
  }
}

TEST(Player, ASliderAtHalfKeepsThePathOfMovepAtHalfTheSpeed) {
  const Replay full = replayed(script_of(ring_path())), half = replayed(script_of(ring_path()), 0.5);
  EXPECT_NEAR(half.tip_speed_mm_s.mean, 3.5, 0.01);
  EXPECT_NEAR(half.max_deviation_mm, full.max_deviation_mm, 1e-3);
  EXPECT_NEAR(half.duration_s(), 2.0 * full.duration_s(), 0.1);
}

TEST(Player, ASliderAtHalfLetsAStreamTrailBehind) {
  const std::string text = script_of(ring_path(), {.motion = ScriptMotion::ServoJ});
  const Replay full = replayed(text), quarter = replayed(text, 0.25);
  EXPECT_NEAR(quarter.duration_s(), full.duration_s(), 0.01);
  // The lag of 0.1 s becomes 0.4 s: corners are cut, the ring shrinks.
  EXPECT_GT(quarter.max_deviation_mm, 2.0 * full.max_deviation_mm);
}

/// A program that does not say which course it was made for.
std::string without_waypoints(std::string text) {
  for (std::size_t at; (at = text.find("# incise.waypoint")) != std::string::npos;)
    text.erase(at, text.find('\n', at) + 1 - at);
  return text;
}

/// Two straight moves with a right angle between them.
std::string corner_script(double blend_m) {
  const RobotProgram program = make_program(line_path(), {.spin_deg = 0.0});
  const std::string path = to_urscript(program, program_header(program, line_path(), {}));
  const std::string head = without_waypoints(path.substr(0, path.find("  # phase: approach")));
  return head + fmt::format(
                    "  # phase: cut\n"
                    "  movep(p[0.50000000, 0.00000000, 0.13000000, 3.1415927, 0, 0], a=1.0, v=0.02, r=0.000000)\n"
                    "  movep(p[0.52000000, 0.00000000, 0.13000000, 3.1415927, 0, 0], a=1.0, v=0.02, r={:.6f})\n"
                    "  movep(p[0.52000000, 0.02000000, 0.13000000, 3.1415927, 0, 0], a=1.0, v=0.02, r=0.000000)\n"
                    "end\n\nincise_cut()\n",
                    blend_m);
}

TEST(Player, RoundsACornerByTheCircleThatTouchesBothSides) {
  const Replay replay = replayed(corner_script(0.005));
  ASSERT_EQ(replay.outcome, ReplayOutcome::EndsInTissue);  // it ends in its phase 'cut', and tells of no path
  const Vec3 corner(520.0, 0.0, 130.0);
  double nearest = 1e9;
  for (const auto& sample : replay.samples) nearest = std::min(nearest, (sample.tip_mm - corner).norm());
  EXPECT_NEAR(nearest, 5.0 * (std::sqrt(2.0) - 1.0), 1e-3);  // radius 5 mm for a right angle
}

TEST(Player, SpeedsUpAsTheMoveSays) {
  const Replay replay = replayed(corner_script(0.005));
  // From rest at 1 m/s² to 20 mm/s in 20 ms: 2 mm/s more in each cycle.
  for (std::size_t i = 3; i < 9; ++i)
    EXPECT_NEAR(replay.samples[i + 1].tip_speed_mm_s - replay.samples[i].tip_speed_mm_s, 2.0, 0.01) << i;
  EXPECT_NEAR(replay.samples[30].tip_speed_mm_s, 20.0, 0.01);
}

TEST(Player, NamesBlendsThatOverlapAndPosesOutOfReach) {
  const Replay overlap = replayed(corner_script(0.025));
  EXPECT_EQ(overlap.outcome, ReplayOutcome::BlendsOverlap);
  EXPECT_GT(overlap.line, 10u);
  std::string text = corner_script(0.005);
  text.replace(text.find("p[0.52000000, 0.02"), 13, "p[2.52000000,");
  const Replay far = replayed(text);
  EXPECT_EQ(far.outcome, ReplayOutcome::Unreachable);
  EXPECT_FALSE(far.samples.empty());
}

std::string table_of(const ToolPath& path) {
  const RobotProgram program = make_program(path);
  return to_joint_csv(program, program_header(program, path, check_program(program, path)));
}

/// The number of the line that holds the place `at`.
std::size_t line_at(const std::string& text, std::size_t at) {
  return static_cast<std::size_t>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n')) + 1;
}

TEST(Player, EndsAtJointsBeyondTheirLimitsAndNamesLineAndJoint) {
  std::string script = script_of(ring_path());
  const std::size_t start = script.find("  movej([") + 9;
  script.replace(start, script.find(',', start) - start, "6.6");
  const Replay turned = replayed(script);
  EXPECT_EQ(turned.outcome, ReplayOutcome::JointLimits);
  EXPECT_EQ(turned.line, line_at(script, start));
  EXPECT_EQ(turned.reason, "shoulder_pan_joint at 378.2 degrees, outside its limits of -360 to 360");

  std::string table = table_of(ring_path());
  std::size_t row = table.find("\n0.");
  for (int i = 0; i < 100; ++i) row = table.find('\n', row + 1);
  const std::size_t cell = table.find(',', row) + 1;
  table.replace(cell, table.find(',', cell) - cell, "-6.4");
  const Replay jumped = replayed(table, 1.0, "cut.csv");
  EXPECT_EQ(jumped.outcome, ReplayOutcome::JointLimits);
  EXPECT_NEAR(static_cast<double>(jumped.line), static_cast<double>(line_at(table, cell)), 1.0);
}

TEST(Player, AProgramThatEndsOrBeginsInTheTissueIsNotCompleted) {
  const std::string table = table_of(ring_path());
  const std::size_t middle = table.find('\n', table.find(",cut\n") + 4000);
  const Replay cut_short = replayed(table.substr(0, middle + 1), 1.0, "cut.csv");
  EXPECT_EQ(cut_short.outcome, ReplayOutcome::EndsInTissue);
  EXPECT_EQ(cut_short.reason, "the program ends with the tip 5.00 mm below the surface");

  const std::size_t head = table.find('\n', table.find("time_s,")) + 1;
  const Replay late = replayed(table.substr(0, head) + table.substr(middle + 1), 1.0, "cut.csv");
  EXPECT_EQ(late.outcome, ReplayOutcome::StartsInTissue);
  EXPECT_NE(late.reason.find("begins with the tip 5.00 mm below"), std::string::npos) << late.reason;

  std::string script = script_of(ring_path());
  const std::size_t exit = script.find("  # phase: exit");
  ASSERT_NE(exit, std::string::npos);
  script = script.substr(0, exit) + script.substr(script.find("end\n"));
  EXPECT_EQ(replayed(script).outcome, ReplayOutcome::EndsInTissue);
}

TEST(Player, WithoutAPathThePhasesTellWhetherTheTipIsInTheTissue) {
  const std::string table = without_waypoints(table_of(line_path()));
  EXPECT_EQ(replayed(table, 1.0, "cut.csv").outcome, ReplayOutcome::Completed);
  const Replay cut_short = replayed(table.substr(0, table.rfind(",cut\n") + 5), 1.0, "cut.csv");
  EXPECT_EQ(cut_short.outcome, ReplayOutcome::EndsInTissue);
  EXPECT_EQ(cut_short.reason, "the program ends in its phase 'cut'");
}

/// A table whose times are `factor` times as long.
std::string stretched(const std::string& table, double factor) {
  std::string result;
  bool is_row = false;
  for (std::size_t at = 0, next; at < table.size(); at = next) {
    next = table.find('\n', at) + 1;
    const std::string line = table.substr(at, next - at);
    result += is_row ? fmt::format("{}{}", factor * std::stod(line), line.substr(line.find(','))) : line;
    is_row = is_row || line.rfind("time_s,", 0) == 0;
  }
  return result;
}

TEST(Player, AJointThatIsSentFasterThanItCanTurnIsAnOutcome) {
  const std::string table = table_of(ring_path());
  EXPECT_EQ(replayed(stretched(table, 1.0), 1.0, "cut.csv").outcome, ReplayOutcome::Completed);
  const Replay fast = replayed(stretched(table, 0.01), 1.0, "cut.csv");
  EXPECT_EQ(fast.outcome, ReplayOutcome::JointSpeed);
  EXPECT_GT(fast.max_joint_speed_share, 1.0);
  EXPECT_GT(fast.line, 20u);
  EXPECT_THAT(fast.reason, HasSubstr("times its speed limit"));
}

TEST(Player, ATipThatLeavesItsCourseIsAnOutcome) {
  ToolPath beside = ring_path();
  for (Waypoint& w : beside.waypoints) w.position_mm.x() += 1.5;
  const WrittenProgram program = program_from_text(script_of(ring_path()), "cut.script");
  const Replay off = play(program, ur10e(), {}, &beside);
  EXPECT_EQ(off.outcome, ReplayOutcome::OffCourse);
  EXPECT_NEAR(off.max_cut_deviation_mm, 1.5, 0.03);
  EXPECT_THAT(off.reason, HasSubstr("up to 1.5"));
  EXPECT_EQ(play(program, ur10e(), {.max_deviation_mm = 1.6}, &beside).outcome, ReplayOutcome::Completed);
}

TEST(Player, PlaysNothingForDays) {
  const auto with = [](const std::string& old, const std::string& now) {
    std::string text = script_of(ring_path());
    const std::size_t at = text.rfind(old);
    EXPECT_NE(at, std::string::npos) << old;
    return text.replace(at, old.size(), now);
  };
  for (const auto& text : {with("v=0.050000", "v=0.000000001"), with("a=0.1000, v=0.050000", "a=1e-12, v=0.050000")}) {
    const Replay slow = replayed(text);
    EXPECT_EQ(slow.outcome, ReplayOutcome::TooLong);
    EXPECT_GT(slow.line, 10u);
    EXPECT_THAT(slow.reason, HasSubstr("at most 7200 s are played"));
  }
  // A table of an hour and a half is one of a week at a slider of a hundredth.
  const std::string table = table_of(line_path());
  const Replay crept = replayed(stretched(table, 5400.0 / make_program(line_path()).duration_s()), 0.01, "cut.csv");
  EXPECT_EQ(crept.outcome, ReplayOutcome::TooLong);
  EXPECT_TRUE(crept.samples.empty());
}

TEST(Player, RefusesSettingsOutOfRange) {
  const WrittenProgram program = program_from_text(script_of(line_path()), "cut.script");
  EXPECT_THROW(static_cast<void>(play(program, ur10e(), {.speed_slider = 0.0})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(play(program, ur10e(), {.speed_slider = 1.5})), InvalidArgument);
}

TEST(Player, RefusesASingleRowOfJointsBesideCommands) {
  WrittenProgram program = program_from_text(script_of(line_path()), "cut.script");
  ASSERT_GE(program.commands.size(), 2U);
  program.joints = {TimedJoints{}};
  EXPECT_THROW(static_cast<void>(play(program, ur10e())), InvalidArgument);
  program.joints.clear();
  program.commands.resize(1);
  EXPECT_THROW(static_cast<void>(play(program, ur10e())), InvalidArgument);
}

TEST(ProgramFromText, ReadsBackWhatWasWritten) {
  const ToolPath path = leaning_ring();
  const WrittenProgram read = program_from_text(script_of(path), "cut.script");
  ASSERT_TRUE(read.path.has_value());
  ASSERT_EQ(read.path->waypoints.size(), path.waypoints.size());
  EXPECT_LT((read.path->waypoints[7].position_mm - path.waypoints[7].position_mm).norm(), 1e-5);
  EXPECT_TRUE(read.path->is_closed);
  EXPECT_EQ(read.T_flange_tool(2, 3), 150.0);
  const RobotProgram program = make_program(path);
  EXPECT_EQ(read.commands.size(), program.poses.size());
  EXPECT_LT((read.commands[9].tip_mm - program.poses[9].tip_mm).norm(), 1e-5);
  EXPECT_EQ(read.commands[1].phase, ProgramPhase::Approach);
  EXPECT_EQ(read.commands.back().phase, ProgramPhase::Retreat);
  for (auto motion : {ScriptMotion::MoveP, ScriptMotion::ServoJ})
    EXPECT_FALSE(program_from_text(script_of(path, {.motion = motion}), "a").commands.empty());
}

std::string message_of(const std::string& text, const char* name = "cut.script") {
  return testing::refusal_of<DataError>([&] { return program_from_text(text, name); });
}

TEST(ProgramFromText, NamesTheLineOfAForeignOrDamagedStatement) {
  const std::string good = script_of(line_path());
  const auto with = [&](const std::string& old, const std::string& now) {
    std::string text = good;
    const std::size_t at = text.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    return text.replace(at, old.size(), now);
  };
  const auto line_of = [&](const std::string& word) {
    const std::size_t at = good.find(word);
    return "line " + std::to_string(std::count(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(at), '\n') + 1);
  };
  const std::string place = "cut.script: " + line_of("  movep(");
  EXPECT_THAT(message_of(with("  movep(", "  set_digital_out(")),
              HasSubstr(place + ": found 'set_digital_out', expected set_tcp, movej"));
  EXPECT_THAT(message_of(with("  movep(p[", "  movep([")), HasSubstr(place + ": found '[0.5"));
  EXPECT_THAT(message_of(with("  movep(p[0.5", "  movep(p[nan")), HasSubstr("expected a number"));
  EXPECT_THAT(message_of(with("  movep(p[0.5", "  movep(p[-1e308")), HasSubstr("expected a number within"));
  EXPECT_THAT(message_of(with(", v=0.004000", "")), HasSubstr("expected 'v='"));
  EXPECT_THAT(message_of(with("v=0.004000", "v=-0.004000")), HasSubstr("expected v above 0"));
  EXPECT_THAT(message_of(with("  movel(", "  movej(")), HasSubstr(line_of("  movel(")));
  EXPECT_THAT(message_of(with("end\n", "")), HasSubstr("expected"));
  EXPECT_THAT(message_of(good.substr(0, good.find("end\n"))), HasSubstr("cut short"));
  EXPECT_THAT(message_of(good.substr(0, good.size() / 2)), HasSubstr("line "));
  EXPECT_THAT(message_of(good + "popup(\"x\")\n"), HasSubstr("expected nothing after the function's call"));
  EXPECT_THAT(message_of("This is a letter.\n"), HasSubstr("line 1: found 'This is a letter.', expected def NAME():"));
  EXPECT_THAT(message_of(""), HasSubstr("expected def NAME():"));
  EXPECT_THAT(message_of(with("0.15000000, 0.0000000", "0.16000000, 0.0000000")),
              HasSubstr("a tool that differs from the header's"));
  EXPECT_THAT(message_of(with("# phase: plunge", "# phase: plungge")), HasSubstr("phase 'plungge'"));
}

TEST(ProgramFromText, KnowsOneToolAndNoRestsOfDays) {
  const std::string good = script_of(line_path(), {.motion = ScriptMotion::ServoJ});
  const std::size_t tool = good.find("  set_tcp("), move = good.find("  movej(");
  const std::string set_tcp = good.substr(tool, good.find('\n', tool) + 1 - tool);
  EXPECT_THAT(message_of(good.substr(0, move) + set_tcp + good.substr(move)), HasSubstr("found a second set_tcp"));
  const std::string without = good.substr(0, tool) + good.substr(tool + set_tcp.size());
  const std::size_t behind = without.find('\n', without.find("  movej(")) + 1;
  EXPECT_THAT(message_of(without.substr(0, behind) + set_tcp + without.substr(behind)),
              HasSubstr("found set_tcp after a move, expected set_tcp before the first move"));
  EXPECT_THAT(message_of(good.substr(0, good.find("end\n")) + "  sleep(1e9)\n" + good.substr(good.find("end\n"))),
              HasSubstr("found a program of 1e+09 s up to here, expected at most 7200 s"));
  std::string slow = good;
  const std::size_t at = slow.find(", t=0.008") + 4;
  slow.replace(at, slow.find(',', at) - at, "1e7");
  EXPECT_THAT(message_of(slow), HasSubstr("found a program of 1e+07 s up to here"));
}

TEST(ProgramFromText, RefusesLengthsInTheHeaderThatNoProgramHas) {
  const std::string good = script_of(ring_path());
  const auto with = [&](const std::string& key, const std::string& value) {
    const std::size_t at = good.find("# incise." + key + ": ");
    EXPECT_NE(at, std::string::npos) << key;
    return good.substr(0, at) + "# incise." + key + ": " + value + good.substr(good.find('\n', at));
  };
  for (const char* key : {"overlap_mm", "clearance_mm", "approach_height_mm"}) {
    for (const char* value : {"1e9", "-8"}) {
      EXPECT_THAT(message_of(with(key, value)),
                  HasSubstr(fmt::format("cut.script: header {}: found {}, expected 0 to 1000 mm", key, value)));
    }
    EXPECT_EQ(message_of(with(key, "12")), "accepted");
  }
  for (const char* depth : {"-5", "1e9"}) {
    EXPECT_THAT(message_of(with("waypoint", fmt::format("615 0 100 0 0 -1 {} 7", depth))),
                HasSubstr("expected a place, a unit axis, a depth of 0 to 1000 mm and a speed above 0"));
  }
  const std::size_t first = good.find("# incise.waypoint: "), second = good.find("# incise.waypoint: ", first + 1);
  EXPECT_THAT(message_of(good.substr(0, second) + good.substr(first)),
              HasSubstr("expected tips more than 0.001 mm apart, found 0 mm after waypoint 0"));
  EXPECT_THAT(message_of("joint_names:\n", "cut.yaml"),
              HasSubstr("cut.yaml: found a .yaml program, expected URScript"));
}

TEST(ProgramFromText, NamesTheRowOfADamagedTableAndTheKeyOfADamagedJson) {
  const ToolPath path = line_path();
  const RobotProgram program = make_program(path);
  const ProgramHeader header = program_header(program, path, check_program(program, path));
  std::string csv = to_joint_csv(program, header);
  EXPECT_THAT(message_of(csv.substr(0, csv.size() - 40), "cut.csv"), HasSubstr("columns, expected 23"));
  std::string json = program_json(program, nullptr, header);
  EXPECT_THAT(message_of(json.substr(0, 500), "cut.json"), HasSubstr("found the end of the text, expected JSON"));
  EXPECT_THAT(message_of("{}", "cut.json"), HasSubstr("/schema: found no such key"));
  const auto with = [&](const std::string& key, const nlohmann::json& value) {
    nlohmann::json document = nlohmann::json::parse(json);
    document[nlohmann::json::json_pointer(key)] = value;
    return message_of(document.dump(), "cut.json");
  };
  EXPECT_THAT(with("/poses", nlohmann::json::array()),
              HasSubstr("cut.json: /poses: found 0 entries, expected a list of 1 or more"));
  EXPECT_THAT(with("/poses/3/phase", "cutt"), HasSubstr("cut.json: /poses/3/phase: found \"cutt\", expected approach"));
  EXPECT_THAT(with("/motion/samples/7", {1, 2, 3}),
              HasSubstr("cut.json: /motion/samples/7: found [1,2,3], expected a list of 13 numbers"));
  EXPECT_THAT(with("/motion/samples/7/2", "x"),
              HasSubstr("cut.json: /motion/samples/7/2: found \"x\", expected a number"));
  EXPECT_THAT(with("/motion/samples/7/2", 1e300), HasSubstr("/motion/samples/7: found a joint at 1e+300 rad"));
  EXPECT_THAT(with("/motion/samples/7/0", 1e12),
              HasSubstr("/motion/samples/7: found a program of 1e+12 s, expected at most 7200 s"));
  EXPECT_THAT(with("/motion", nlohmann::json::array()), HasSubstr("cut.json: /motion: found [], expected an object"));
  std::string endless = json;
  endless.replace(endless.find("\"duration_s\":") + 13, 0, "1e400, \"was\":");
  EXPECT_THAT(message_of(endless, "cut.json"), HasSubstr("found a number beyond 1.8e308"));
  csv.replace(csv.find("elbow_joint_rad"), 5, "elbov");
  EXPECT_THAT(message_of(csv, "cut.csv"), HasSubstr("the columns that `incise export` writes"));
}

TEST(Player, AReplayThatDoesNotCompleteClosesTheGateForEverybody) {
  Replay replay;
  replay.outcome = ReplayOutcome::Completed;
  Verdict verdict;
  add_failed_replay(replay, verdict);
  EXPECT_EQ(verdict.status(), VerdictStatus::Ok);
  replay.outcome = ReplayOutcome::EndsInTissue;
  replay.reason = "the tip ends 1 mm below the surface";
  add_failed_replay(replay, verdict);
  EXPECT_FALSE(gate_of(verdict, std::vector<std::string>{"program_check"}).is_open);
  ASSERT_EQ(verdict.reasons().size(), 1U);
  EXPECT_EQ(verdict.reasons()[0].message,
            "the replay of the program ended as ends_in_tissue: the tip ends 1 mm below the surface");
}

}  // namespace
}  // namespace incise
