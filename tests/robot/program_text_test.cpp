#include "robot/ring_path.hpp"

#include <incise/core/error.hpp>
#include <incise/robot/program_text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <sstream>

namespace incise {
namespace {

using incise::testing::ring_path;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> lines_with(const std::string& text, const std::string& word) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (line.find(word) != std::string::npos) lines.push_back(line);
  }
  return lines;
}

TEST(ToUrScript, WritesMetresAndOneMovePerPose) {
  const RobotProgram program = make_program(ring_path(), {.spin_deg = 0.0});
  const std::string text = to_urscript(program);
  const auto movel = lines_with(text, "movel("), movep = lines_with(text, "movep(");
  EXPECT_EQ(movel.size(), 5u);
  EXPECT_EQ(movel.size() + movep.size(), program.poses.size());
  EXPECT_THAT(
      movel[0],
      HasSubstr("movel(p[0.61500000, 0.00000000, 0.13000000, 3.141593, 0.000000, 0.000000], a=0.1000, v=0.050000)"));
  for (const auto& line : movep) EXPECT_THAT(line, HasSubstr("v=0.007000"));
}

TEST(ToUrScript, BlendsTheCutsPosesAndStopsAtItsEnd) {
  const RobotProgram program = make_program(ring_path());
  const auto movep = lines_with(to_urscript(program, {.blend_fraction = 0.4}), "movep(");
  for (std::size_t i = 0; i + 1 < movep.size(); ++i) EXPECT_THAT(movep[i], Not(HasSubstr("r=0.000000"))) << i;
  EXPECT_THAT(movep.back(), HasSubstr("r=0.000000"));
}

TEST(ToUrScript, DefinesAndCallsTheFunctionUnderItsName) {
  const std::string text =
      to_urscript(make_program(ring_path()), {.function_name = "ring_1", .provenance = {"from path.json\nsha256 abc"}});
  EXPECT_THAT(text, HasSubstr("\ndef ring_1():\n"));
  EXPECT_THAT(text, HasSubstr("\nend\n\nring_1()\n"));
  EXPECT_THAT(text, HasSubstr("\n# from path.json\n# sha256 abc\n"));
  EXPECT_THAT(text, HasSubstr("Virtual"));
}

TEST(ToUrScript, OpensNoConnectionAndSwitchesNothing) {
  const std::string text = to_urscript(make_program(ring_path()));
  for (const char* word : {"socket", "rpc", "set_digital", "set_standard", "set_tool"})
    EXPECT_THAT(text, Not(HasSubstr(word)));
}

TEST(ToUrScript, SetsTheToolCentrePointWhenItIsKnown) {
  Mat4 tool = Mat4::Identity();
  tool(2, 3) = 150.0;
  EXPECT_THAT(to_urscript(make_program(ring_path()), {.T_flange_tool = tool}),
              HasSubstr("  set_tcp(p[0.00000000, 0.00000000, 0.15000000, 0.000000, 0.000000, 0.000000])\n"));
  tool(0, 0) = 2.0;
  EXPECT_THROW(static_cast<void>(to_urscript(make_program(ring_path()), {.T_flange_tool = tool})), InvalidArgument);
}

TEST(ToUrScript, WritesTheDwellAsASleep) {
  EXPECT_THAT(to_urscript(make_program(ring_path(), {.dwell_s = 0.18})), HasSubstr("  # dwell\n  sleep(0.180)\n"));
}

TEST(ToUrScript, RefusesNamesAndNumbersThatAControllerWouldNotTake) {
  RobotProgram program = make_program(ring_path());
  EXPECT_THROW(static_cast<void>(to_urscript(program, {.function_name = "1cut"})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(to_urscript(program, {.function_name = "a():\nhalt"})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(to_urscript(program, {.blend_fraction = 0.5})), InvalidArgument);
  program.poses[4].rotation_vector.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(to_urscript(program)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(to_json(program)), InvalidArgument);
}

TEST(ProgramToJson, HoldsEveryPoseAndEveryCheck) {
  const ToolPath path = ring_path();
  const RobotProgram program = make_program(path);
  const ProgramChecks checks = check_program(program, path);
  const auto document = nlohmann::json::parse(to_json(program, &checks));
  EXPECT_EQ(document["poses"].size(), program.poses.size());
  EXPECT_EQ(document["poses"][2]["phase"], "plunge");
  EXPECT_EQ(document["poses"][5]["tip_mm"][0].get<double>(), program.poses[5].tip_mm.x());
  EXPECT_EQ(document["duration_s"].get<double>(), program.duration_s());
  EXPECT_EQ(document["checks"].size(), checks.checks.size());
  EXPECT_FALSE(document["checks_not_made"].empty());
  EXPECT_FALSE(nlohmann::json::parse(to_json(program)).contains("checks"));
}

}  // namespace
}  // namespace incise
