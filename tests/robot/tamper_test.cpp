#include "robot/comment_text.hpp"
#include "robot/program_digest.hpp"
#include "robot/ring_path.hpp"

#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/robot/program_audit.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <sstream>

namespace incise {
namespace {

using incise::testing::ring_path;
using ::testing::HasSubstr;
using ::testing::Not;

/// A program's text as lines, with what the matrix does to them.
struct Lines {
  std::vector<std::string> all;
  explicit Lines(const std::string& text) {
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) all.push_back(line);
  }
  [[nodiscard]] std::string text() const {
    std::string joined;
    for (const auto& line : all) joined += line + "\n";
    return joined;
  }
};

/// Numbers of the lines with moves or rows of a phase, of `count` phases from it on.
std::vector<std::size_t> moves_of(const Lines& lines, const std::string& phase) {
  std::vector<std::size_t> found;
  std::string now;
  for (std::size_t i = 0; i < lines.all.size(); ++i) {
    const std::string& line = lines.all[i];
    if (line.starts_with("  # phase: ")) now = line.substr(11);
    const bool is_row = !line.empty() && std::isdigit(static_cast<unsigned char>(line[0])) != 0;
    if (is_row) now = line.substr(line.rfind(',') + 1);
    const bool is_move =
        line.starts_with("  movel(") || line.starts_with("  movep(") || line.starts_with("  servoj(") || is_row;
    if (is_move && now == phase) found.push_back(i);
  }
  return found;
}

/// The number behind the `n`th of `mark` becomes what `change` makes of it.
void change_number(std::string& line, const std::string& mark, int n, const std::function<double(double)>& change) {
  std::size_t at = 0;
  for (int k = 0; k <= n; ++k) at = line.find(mark, at) + mark.size();
  const std::size_t end = line.find_first_of(",])", at);
  line.replace(at, std::min(end, line.size()) - at, fmt::format("{:.8f}", change(std::stod(line.substr(at)))));
}

std::string sealed_again(std::string text) {
  const std::size_t at = text.find("sha256 ", text.find("digest"));
  text.replace(at + 7, 64, std::string(64, '0'));
  return robot_detail::sealed(std::move(text));
}

/// How a replay of it ends: an outcome, or "refused" by the reader.
std::string ending_of(const std::string& text, const char* name = "cut.script") {
  try {
    const WrittenProgram program = program_from_text(text, name);
    Replay replay = play(program);
    judge_audit(replay, audit_program(program));
    return std::string(to_string(replay.outcome));
  } catch (const DataError&) {
    return "refused";
  }
}

constexpr int kSoundPrograms = 16;

/// Its digest shows that it was changed, or the reader refuses it.
bool is_another(const std::string& text, const char* name = "cut.script") {
  try {
    return program_from_text(text, name).digest == ProgramDigest::Differs;
  } catch (const DataError&) {
    return true;
  }
}

ProgramHeader provenance() {
  return {{"made_by", "incise 1 (abc)"},
          {"made_from", "path.json"},
          {"title", "A ring"},
          {"verdict", "caution"},
          {"reason", "caution: depth: shallow at one place"},
          {"accepted", "depth"}};
}

std::string script_of(ScriptMotion motion = ScriptMotion::MoveP) {
  const ToolPath path = ring_path();
  const RobotProgram program = make_program(path);
  return to_urscript(program, program_header(program, path, check_program(program, path), provenance()),
                     {.motion = motion});
}
std::string table() {
  const ToolPath path = ring_path();
  const RobotProgram program = make_program(path);
  return to_joint_csv(program, program_header(program, path, check_program(program, path), provenance()));
}
std::string json() {
  const ToolPath path = ring_path();
  const RobotProgram program = make_program(path);
  const ProgramChecks checks = check_program(program, path);
  return program_json(program, &checks, program_header(program, path, checks, provenance()));
}

TEST(Tamper, AnUntouchedProgramOfEachFormIsTheCheckedOne) {
  for (const auto& [text, name] :
       {std::pair(script_of(), "a.script"), std::pair(script_of(ScriptMotion::ServoJ), "b.script"),
        std::pair(table(), "c.csv"), std::pair(json(), "d.json")}) {
    EXPECT_EQ(ending_of(text, name), "completed") << name;
    const WrittenProgram program = program_from_text(text, name);
    const ProgramAudit audit = audit_program(program);
    EXPECT_TRUE(audit.is_checked()) << name << ::testing::PrintToString(audit.contradictions);
    EXPECT_THAT(audit.recomputed, ::testing::IsSupersetOf({"margin", "table", "base", "self_collision", "joint_speed"}))
        << name;
    EXPECT_EQ(ending_of(sealed_again(text), name), "completed") << name;
  }
}

/// A ring of some size and height anywhere in front of the arm, with leaning axes, and speeds that change along it.
ToolPath random_ring(Random& random) {
  ToolPath path = ring_path(static_cast<std::size_t>(24 + random.below(60)));
  const double size = random.uniform(0.6, 1.6), lean = random.uniform(-0.3, 0.3), turn = random.uniform(-1.0, 1.0);
  const double slow = random.uniform(2.0, 12.0), fast = random.below(2) == 0 ? slow : random.uniform(slow, 25.0);
  const Vec3 old_middle(600.0, 0.0, 100.0), middle(random.uniform(450.0, 850.0), 0.0, random.uniform(60.0, 350.0));
  const Mat3 R = Eigen::AngleAxisd(turn, Vec3::UnitZ()).toRotationMatrix();
  for (Waypoint& w : path.waypoints) {
    const Vec3 outwards = w.position_mm - old_middle;
    w.axis = R * (lean * outwards.normalized() - Vec3::UnitZ()).normalized();
    w.position_mm = R * (middle + size * outwards + 0.01 * outwards.x() * outwards.x() * Vec3::UnitZ());
    w.speed_mm_s = outwards.x() > 0.0 ? slow : fast;
  }
  for (Vec3& point : path.tumor_edge.points) point = R * (middle + (size - 0.2) * (point - old_middle));
  return path;
}

TEST(Tamper, SoundProgramsOfManyKindsAreAllCheckedAndCompleted) {
  Random random(5);
  int sound = 0;
  for (int i = 0; i < kSoundPrograms; ++i) {
    const ToolPath path = random_ring(random);
    const RobotProgram program = make_program(path);
    ASSERT_EQ(program.motion.outcome, MotionOutcome::Found) << i;
    const ProgramChecks checks = check_program(program, path);
    if (!testing::failures(checks).empty()) continue;  // speeds that change faster than the tip can
    ++sound;
    const ProgramHeader header = program_header(program, path, checks, provenance());
    const int form = i % 4;
    const char* name = form == 2 ? "cut.csv" : form == 3 ? "cut.json" : "cut.script";
    const std::string text =
        form == 2   ? to_joint_csv(program, header)
        : form == 3 ? program_json(program, &checks, header)
                    : to_urscript(program, header, {.motion = form == 0 ? ScriptMotion::MoveP : ScriptMotion::ServoJ});
    const WrittenProgram written = program_from_text(text, name);
    const ProgramAudit audit = audit_program(written);
    EXPECT_TRUE(audit.is_checked()) << i << ::testing::PrintToString(audit.contradictions);
    for (const double slider : {1.0, 0.5}) {
      const Replay replay = play(written, ur10e(), {.speed_slider = slider});
      EXPECT_EQ(replay.outcome, ReplayOutcome::Completed)
          << i << " " << name << ", slider " << slider << ": " << to_string(replay.outcome) << ": " << replay.reason;
    }
  }
  EXPECT_GT(2 * sound, kSoundPrograms);
}

TEST(Tamper, ASoundMarkAndAProgramWithAnOverrideAreChecked) {
  ToolPath mark = ring_path();
  mark.kind = PathKind::Mark;
  for (std::size_t i = 0; i < mark.waypoints.size(); ++i)
    mark.waypoints[i] = {mark.tumor_edge.points[i], -Vec3::UnitZ(), 1.0, 2.0};
  const RobotProgram marked = make_program(mark, {.plunge_speed_mm_s = 2.0, .overlap_mm = 0.0, .dwell_s = 0.3});
  EXPECT_EQ(ending_of(to_urscript(marked, program_header(marked, mark, check_program(marked, mark), provenance()))),
            "completed");
  ToolPath deep = ring_path();
  deep.waypoints[12].depth_mm = 5.8;
  const RobotProgram program = make_program(deep);
  ProgramChecks checks = check_program(program, deep);
  ASSERT_THAT(testing::failures(checks), ::testing::ElementsAre("depth"));
  override_checks(checks, {"depth"});
  for (const auto& [text, name] :
       {std::pair(to_urscript(program, program_header(program, deep, checks, provenance())), "a.script"),
        std::pair(program_json(program, &checks, program_header(program, deep, checks, provenance())), "b.json")})
    EXPECT_EQ(ending_of(text, name), "completed") << name;
}

/// Nobody can take a cut that comes near the tumour on them, not by writing so into the program either.
TEST(Tamper, AnOverrideOfTheMarginIsNoneToReplay) {
  ToolPath close = ring_path();
  close.waypoints[12].position_mm = Vec3(600.0, 12.0, 100.0);
  const RobotProgram program = make_program(close);
  ProgramChecks checks = check_program(program, close);
  ASSERT_FALSE(testing::failures(checks).empty());
  for (ProgramCheck& check : checks.checks) check.is_overridden = !check.passed;  // as an edited header would have it
  EXPECT_NE(ending_of(to_urscript(program, program_header(program, close, checks, provenance()))), "completed");
}

/// A header that does not say what its program was made with leaves nothing to check again: the digest alone makes no
/// checked program.
TEST(Tamper, AProgramThatCannotBeMadeAgainIsNotChecked) {
  Lines lines(script_of());
  lines.all.erase(std::find_if(lines.all.begin(), lines.all.end(),
                               [](const std::string& l) { return l.find("setting: dwell_s") != std::string::npos; }));
  const WrittenProgram written = program_from_text(sealed_again(lines.text()), "a.script");
  const ProgramAudit audit = audit_program(written);
  EXPECT_EQ(audit.digest, ProgramDigest::Matches);
  EXPECT_FALSE(audit.is_checked());
}

/// The verdict's lines are held against the gate, whoever made the digest again.
TEST(Tamper, TheLinesOfTheVerdictAreHeldAgainstTheGate) {
  const auto audited = [](std::initializer_list<const char*> more) {
    Lines lines(script_of());
    std::erase_if(lines.all, [](const std::string& l) {
      return l.starts_with("# incise.verdict") || l.starts_with("# incise.reason") ||
             l.starts_with("# incise.accepted");
    });
    for (const char* line : more) lines.all.insert(lines.all.begin() + 1, std::string("# incise.") + line);
    return audit_program(program_from_text(sealed_again(lines.text()), "a.script"));
  };
  EXPECT_TRUE(audited({"verdict: ok"}).is_checked());
  EXPECT_TRUE(audited({"verdict: caution", "reason: caution: depth: shallow", "accepted: depth"}).is_checked());
  EXPECT_FALSE(audited({"verdict: refused", "reason: refused: open_layer: open"}).is_checked());
  EXPECT_FALSE(audited({"verdict: refused"}).is_checked());
  EXPECT_FALSE(audited({"verdict: ok", "reason: caution: depth: shallow", "accepted: depth"}).is_checked());
  EXPECT_FALSE(audited({"verdict: caution", "reason: caution: depth: shallow"}).is_checked()) << "nobody accepted it";
  EXPECT_FALSE(audited({"verdict: ok", "verdict: ok"}).is_checked());
  EXPECT_FALSE(audited({"accepted: depth"}).is_checked());
  EXPECT_FALSE(audited({}).is_checked()) << "no verdict at all";
}

/// What another reader takes for the end of a line would let a statement hide in a comment.
TEST(Tamper, ACharacterThatHidesAStatementInACommentIsRefused) {
  for (const std::string& hiding :
       {std::string("\r"), std::string("\v"), std::string("\f"), std::string("\u0085"), std::string("\u2028"),
        std::string("\u202e"), std::string(1, '\0'), std::string("\xff")}) {
    std::string text = script_of();
    text.insert(text.find("A ring"), hiding + "movel(p[0.6, 0, -0.2, 3.14, 0, 0], a=1, v=1)");
    EXPECT_EQ(ending_of(sealed_again(text)), "refused") << ::testing::PrintToString(hiding);
  }
  std::string windows = script_of();
  for (std::size_t at = windows.find('\n'); at != std::string::npos; at = windows.find('\n', at + 2))
    windows.insert(at, "\r");
  EXPECT_NE(ending_of(windows), "refused") << "line ends of another system";
}

constexpr const char* kPhases[]{"approach", "plunge", "cut", "overlap", "exit", "retreat"};

/// Every phase and kind of change of a script's moves. Whoever makes it also makes the digest again.
TEST(Tamper, EachChangeOfAMoveIsNoticedInEachPhaseWithAndWithoutItsDigestMadeAgain) {
  const std::string good = script_of();
  const Lines lines(good);
  using Change = std::function<void(Lines&, std::size_t)>;
  const auto place = [](int axis, double by_m) {
    return Change([axis, by_m](Lines& l, std::size_t i) {
      change_number(l.all[i], axis == 0 ? "p[" : ", ", axis == 0 ? 0 : axis - 1, [by_m](double x) { return x + by_m; });
    });
  };
  const auto factor = [](const char* mark, double by) {
    return Change(
        [mark, by](Lines& l, std::size_t i) { change_number(l.all[i], mark, 0, [by](double x) { return by * x; }); });
  };
  const std::map<std::string, Change> changes{
      {"5 mm aside", place(1, 0.005)},
      {"2 mm deeper", place(2, -0.002)},
      {"below the table", place(2, -0.2)},
      {"in millimetres",
       Change([](Lines& l, std::size_t i) { change_number(l.all[i], "p[", 0, [](double x) { return 1000.0 * x; }); })},
      {"leaning", place(4, 0.3)},
      {"ten times the speed", factor("v=", 10.0)},
      {"a hundred times the speed", factor("v=", 100.0)},
      {"ten times the acceleration", factor("a=", 10.0)},
      {"a dive added", Change([](Lines& l, std::size_t i) {
         std::string dive = l.all[i];
         change_number(dive, ", ", 1, [](double) { return -0.05; });
         l.all.insert(l.all.begin() + static_cast<std::ptrdiff_t>(i), dive);
       })},
      {"a rest added", Change([](Lines& l, std::size_t i) {
         l.all.insert(l.all.begin() + static_cast<std::ptrdiff_t>(i), "  sleep(5.0)");
       })},
      {"swapped with the next", Change([](Lines& l, std::size_t i) {
         std::size_t next = i + 1;
         while (next + 1 < l.all.size() && !l.all[next].starts_with("  move")) ++next;
         std::swap(l.all[i], l.all[next]);
       })},
      {"removed", Change([](Lines& l, std::size_t i) { l.all.erase(l.all.begin() + static_cast<std::ptrdiff_t>(i)); })},
      {"made twice", Change([](Lines& l, std::size_t i) {
         l.all.insert(l.all.begin() + static_cast<std::ptrdiff_t>(i), l.all[i]);
       })}};
  int cells = 0;
  for (const char* phase : kPhases) {
    const auto moves = moves_of(lines, phase);
    ASSERT_FALSE(moves.empty()) << phase;
    for (const auto& [name, change] : changes) {
      Lines changed = lines;
      change(changed, moves[moves.size() / 2]);
      if (changed.text() == good) continue;
      ++cells;
      EXPECT_TRUE(is_another(changed.text())) << phase << ": " << name;
      EXPECT_NE(ending_of(sealed_again(changed.text())), "completed") << phase << ": " << name << ", sealed again";
    }
  }
  EXPECT_GT(cells, 70);
}

TEST(Tamper, TheWayToTheStartIsHeldToIts) {
  for (int joint = 0; joint < 6; ++joint) {
    Lines lines(script_of());
    for (std::string& line : lines.all) {
      if (!line.starts_with("  movej(")) continue;
      change_number(line, joint == 0 ? "[" : ", ", joint == 0 ? 0 : joint - 1, [](double q) { return q + 0.5; });
    }
    EXPECT_NE(ending_of(sealed_again(lines.text())), "completed") << joint;
  }
  Lines hasty(script_of());
  for (std::string& line : hasty.all) {
    if (line.starts_with("  movej(")) change_number(line, "v=", 0, [](double v) { return 10.0 * v; });
  }
  EXPECT_EQ(ending_of(sealed_again(hasty.text())), "wrong_speed");
}

TEST(Tamper, EachChangeOfARowIsNoticedInEachPhase) {
  for (const bool is_stream : {false, true}) {
    const std::string good = is_stream ? script_of(ScriptMotion::ServoJ) : table();
    const char* name = is_stream ? "cut.script" : "cut.csv";
    const Lines lines(good);
    for (const char* phase : kPhases) {
      const auto rows = moves_of(lines, phase);
      ASSERT_GT(rows.size(), 10U);
      // Half a phase of joint 2, lowered or raised by a degree: some 10 mm at the tip.
      for (const double by_rad : {-0.02, 0.02}) {
        Lines changed = lines;
        for (std::size_t k = rows.size() / 4; k < 3 * rows.size() / 4; ++k)
          change_number(changed.all[rows[k]], is_stream ? ", " : ",", is_stream ? 0 : 1,
                        [by_rad](double q) { return q + by_rad; });
        EXPECT_TRUE(is_another(changed.text(), name)) << phase;
        EXPECT_NE(ending_of(sealed_again(changed.text()), name), "completed") << phase << ", sealed again";
      }
    }
  }
}

/// Cells that our own player does not need, and another may run by.
TEST(Tamper, TheOtherCellsOfARowAndAStreamsGainAreHeld) {
  const std::string good = table();
  const Lines lines(good);
  const std::size_t row = moves_of(lines, "cut")[20];
  const auto with = [&](const std::function<void(std::string&)>& change) {
    Lines changed = lines;
    change(changed.all[row]);
    EXPECT_NE(changed.all[row], lines.all[row]);
    return ending_of(sealed_again(changed.text()), "cut.csv");
  };
  EXPECT_EQ(with([](std::string& l) { change_number(l, ",", 13, [](double) { return 999.0; }); }), "false_checks");
  EXPECT_EQ(with([](std::string& l) { change_number(l, ",", 20, [](double z) { return z - 5.0; }); }), "false_checks");
  EXPECT_EQ(with([](std::string& l) { l.replace(l.rfind(',') + 1, 3, "retreat"); }), "false_checks");

  Lines stream(script_of(ScriptMotion::ServoJ));
  for (std::string& line : stream.all) {
    if (line.starts_with("  servoj(")) change_number(line, "gain=", 0, [](double) { return 2000.0; });
  }
  EXPECT_EQ(ending_of(sealed_again(stream.text())), "false_checks");
}

TEST(Tamper, ForgedLinesOfTheHeaderDoNotPass) {
  const std::string good = script_of();
  const auto with = [&good](const std::string& key, const std::string& value) {
    const std::string mark = "# incise." + key;
    const std::size_t at = good.find(mark);
    EXPECT_NE(at, std::string::npos) << key;
    return good.substr(0, at) + value + good.substr(good.find('\n', at) + (value.empty() ? 1 : 0));
  };
  const std::map<std::string, std::string> forged{
      {"check: margin", "# incise.check: margin passed: 7.5 mm >= 2.2 mm"},
      {"check: table", ""},
      {"check: tilt", "# incise.check: tilt passed: 0 deg <= 80 deg\n# incise.check: tilt passed: 0 deg <= 80 deg"},
      {"check: base", "# incise.check: base FAILED: 2 mm >= 10 mm"},
      {"check: gap", "# incise.check: tests passed"},
      {"check: singularity", "# incise.check: singularity passed: 0.4 >= 0.01"},
      {"duration_s", "# incise.duration_s: 12.000"},
      {"cut_length_mm", "# incise.cut_length_mm: 50"},
      {"branch", "# incise.branch: shoulder left, elbow positive, wrist flipped"},
      {"robot", "# incise.robot: ur5e"},
      {"kind", "# incise.kind: mark"},
      {"closed", "# incise.closed: false"},
      {"overlap_mm", "# incise.overlap_mm: 1"},
      {"T_flange_tool", "# incise.T_flange_tool: 1 0 0 0 0 1 0 0 0 0 1 160 0 0 0 1"},
      {"waypoint", "# incise.waypoint: 625 0 100 0 0 -1 5 7"},
      {"setting: approach_speed_mm_s", "# incise.setting: approach_speed_mm_s 500"},
      {"setting: table_z_mm", "# incise.setting: table_z_mm -300"},
      {"limit: close_margin_mm", "# incise.limit: close_margin_mm 0.1"},
      {"limit: table_clearance_mm", "# incise.limit: table_clearance_mm -500"},
      {"tumor_edge: ", "# incise.tumor_edge: 613 0 100"}};
  for (const auto& [key, value] : forged) {
    const std::string text = with(key, value);
    EXPECT_TRUE(is_another(text)) << key;
    EXPECT_NE(ending_of(sealed_again(text)), "completed") << key << ", sealed again";
  }
  // What only the digest can tell.
  for (const char* key : {"made_by", "made_from", "title", "verdict", "accepted", "note"})
    EXPECT_EQ(ending_of(with(key, "# incise." + std::string(key) + ": another")), "altered") << key;
  EXPECT_EQ(ending_of(good + "# a comment\n"), "altered");
  EXPECT_EQ(ending_of(with("digest", "# incise.digest: sha256 00")), "altered");
  EXPECT_EQ(ending_of(with("digest", "# incise.digest: sha256 " + std::string(64, '0') + "\n# incise.digest: sha256 " +
                                         std::string(64, '0'))),
            "altered");
}

TEST(Tamper, AForgedJsonDoesNotPass) {
  const std::string good = json();
  const auto with = [&good](const std::string& old, const std::string& now) {
    std::string text = good;
    const std::size_t at = text.rfind(old);
    EXPECT_NE(at, std::string::npos) << old;
    return text.replace(at, old.size(), now);
  };
  for (const std::string& text :
       {with("\"passed\": true", "\"passed\": false"), with("\"limit\": 2.2,", "\"limit\": 1.2,"),
        with("\"phase\": \"exit\"", "\"phase\": \"cut\"")})
    EXPECT_EQ(ending_of(text, "cut.json"), "altered");
  EXPECT_EQ(ending_of(sealed_again(with("\"limit\": 2.2,", "\"limit\": 1.2,")), "cut.json"), "false_checks");
  std::string poses = good;
  change_number(poses, "\"tip_mm\": [\n        ", 20, [](double x) { return x + 3.0; });
  EXPECT_EQ(ending_of(sealed_again(poses), "cut.json"), "false_checks");
  for (const char* key :
       {"\"rotation_vector\": [\n        ", "\"tip_speed_mm_s\": ", "\"time_s\": ", "\"depth_mm\": "}) {
    std::string pose = good;
    const std::size_t at = pose.find(key, pose.find("\"phase\": \"cut\""));
    ASSERT_NE(at, std::string::npos) << key;
    std::string rest = pose.substr(at);
    change_number(rest, key, 0, [](double x) { return x + 1.0; });
    EXPECT_NE(ending_of(sealed_again(pose.substr(0, at) + rest), "cut.json"), "completed") << key;
  }
  const std::string twice = with("\"motion\": {", "\"motion\": {\"outcome\": \"found\"},\n  \"motion\": {");
  EXPECT_EQ(ending_of(sealed_again(twice), "cut.json"), "refused") << "a key that is there twice";
}

TEST(Tamper, AProgramWithoutADigestPlaysAndIsNotACheckedOne) {
  std::string text = script_of();
  const std::size_t at = text.find("# incise.digest");
  text.erase(at, text.find('\n', at) + 1 - at);
  EXPECT_EQ(ending_of(text), "completed");
  const ProgramAudit audit = audit_program(program_from_text(text, "cut.script"));
  EXPECT_EQ(audit.digest, ProgramDigest::Absent);
  EXPECT_FALSE(audit.is_checked());
}

TEST(Tamper, AnOptionThatMovedALimitIsListed) {
  const ToolPath path = ring_path();
  const RobotProgram program = make_program(path);
  const ProgramChecks checks = check_program(program, path, {.close_margin_mm = 1.0});
  const ProgramAudit audit = audit_program(
      program_from_text(to_urscript(program, program_header(program, path, checks, provenance())), "cut.script"));
  EXPECT_TRUE(audit.is_checked());
  EXPECT_THAT(audit.moved_limits, ::testing::ElementsAre("close_margin_mm 1, by default 2.2"));
}

TEST(CommentText, KeepsNoCharacterThatEndsALineTurnsItOrIsNotSeen) {
  EXPECT_EQ(robot_detail::comment_text("Zunge 3 \u00e4\u00df \u03bc \u4e2d \U0001F600"),
            "Zunge 3 \u00e4\u00df \u03bc \u4e2d \U0001F600");
  for (const char* bad :
       {"\u2028", "\u2029", "\u0085", "\f",     "\v",     "\r",     "\n",     "\t",     "\x7f",       "\x1b",
        "\u009b", "\u202e", "\u2066", "\u200f", "\u200b", "\ufeff", "\u061c", "\u00ad", "\U000E0041", "\uffff"})
    EXPECT_EQ(robot_detail::comment_text(std::string("a") + bad + "b"), "a b") << ::testing::PrintToString(bad);
  for (const char* bad : {"\xff", "\x80", "\xc0", "\xf5"})
    EXPECT_EQ(robot_detail::comment_text(std::string("a") + bad + "b"), "a?b");
  EXPECT_EQ(robot_detail::comment_text("a\xe2\x80"), "a??");
  EXPECT_EQ(robot_detail::comment_text("a\xc0\x8a"
                                       "b"),
            "a??b");  // an overlong line feed
  EXPECT_EQ(robot_detail::comment_text("a\xed\xa0\x80"
                                       "b"),
            "a???b");  // half a surrogate pair
  EXPECT_EQ(robot_detail::comment_text(std::string("a\0b", 3)), "a b");
}

TEST(CommentText, HoldsInEveryFormOfAProgram) {
  const ToolPath path = ring_path();
  const RobotProgram program = make_program(path);
  const std::string evil = "x\u2028movel(p[0])\u0085\v\f\rhalt\x7f\u202e\xff\x80";
  const ProgramHeader header = program_header(program, path, check_program(program, path),
                                              {{"title", evil}, {"digest", "mine"}, {"verdict", "ok"}});
  const std::string forms[]{to_urscript(program, header), to_joint_csv(program, header), to_ros_yaml(program, header),
                            program_json(program, nullptr, header)};
  for (const std::string& text : forms) {
    for (const char* bad : {"\u2028", "\u0085", "\v", "\f", "\r", "\x7f", "\u202e", "\xff"})
      EXPECT_THAT(text, Not(HasSubstr(bad)));
    EXPECT_THAT(text, HasSubstr("x movel(p[0])    halt  ??"));
  }
  EXPECT_THAT(to_rosbag(program, header), HasSubstr("x movel(p[0])    halt  ??"));
  EXPECT_EQ(ending_of(forms[0]), "completed");
  EXPECT_EQ(ending_of(forms[3], "cut.json"), "completed");
}

}  // namespace
}  // namespace incise
