#include "robot/ring_path.hpp"

#include <incise/core/error.hpp>
#include <incise/robot/program_text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <sstream>

namespace incise {
namespace {

using incise::testing::line_path;
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

ProgramHeader header_of(const RobotProgram& program, const ToolPath& path) {
  return program_header(program, path, check_program(program, path));
}

TEST(ToUrScript, WritesMetresAndOneMovePerPose) {
  const RobotProgram program = make_program(ring_path(), {.spin_deg = 0.0});
  const std::string text = to_urscript(program, {});
  const auto movel = lines_with(text, "movel("), movep = lines_with(text, "movep("),
             movej = lines_with(text, "  movej(");
  EXPECT_EQ(movej.size(), 1u);
  EXPECT_EQ(movel.size(), 4u);
  EXPECT_EQ(1 + movel.size() + movep.size(), program.poses.size());
  EXPECT_THAT(movel[0], HasSubstr("movel(p[0.61500000, 0.00000000, 0.10500000, 3.1415927, 0.0000000, 0.0000000], "
                                  "a=0.1000, v=0.050000)"));
  for (const auto& line : movep) EXPECT_THAT(line, HasSubstr("v=0.007000"));
}

TEST(ToUrScript, BlendsTheCutsPosesAndStopsAtItsEnd) {
  const RobotProgram program = make_program(ring_path());
  const auto movep = lines_with(to_urscript(program, {}, {.blend_fraction = 0.4}), "movep(");
  for (std::size_t i = 0; i + 1 < movep.size(); ++i) EXPECT_THAT(movep[i], Not(HasSubstr("r=0.000000"))) << i;
  EXPECT_THAT(movep.back(), HasSubstr("r=0.000000"));
}

TEST(ToUrScript, StreamsOneServojPerSampleAndRestsWhereAMotionEnds) {
  const RobotProgram program = make_program(ring_path());
  const auto servoj =
      lines_with(to_urscript(program, {}, {.motion = ScriptMotion::ServoJ, .settle_s = 0.08}), "servoj([");
  // Five motions from rest to rest, each followed by ten samples of rest.
  EXPECT_EQ(servoj.size(), program.motion.samples.size() + 5 * 10);
  EXPECT_THAT(servoj.front(), HasSubstr("], 0, 0, t=0.0080, lookahead_time=0.100, gain=300)"));
}

TEST(ToUrScript, DefinesAndCallsTheFunctionUnderItsName) {
  const std::string text =
      to_urscript(make_program(ring_path()), {{"made_from", "path.json\nsha256 abc"}}, {.function_name = "ring_1"});
  EXPECT_THAT(text, HasSubstr("\ndef ring_1():\n"));
  EXPECT_THAT(text, HasSubstr("\nend\n\nring_1()\n"));
  EXPECT_THAT(text, HasSubstr("# incise.made_from: path.json\n# incise.made_from: sha256 abc\n"));
}

TEST(ToUrScript, OpensNoConnectionAndSwitchesNothing) {
  const std::string text = to_urscript(make_program(ring_path()), {});
  for (const char* word : {"socket", "rpc", "set_digital", "set_standard", "set_tool"})
    EXPECT_THAT(text, Not(HasSubstr(word)));
}

TEST(ToUrScript, SetsTheToolCentrePoint) {
  EXPECT_THAT(to_urscript(make_program(ring_path()), {}),
              HasSubstr("  set_tcp(p[0.00000000, 0.00000000, 0.15000000, 0.0000000, 0.0000000, 0.0000000])\n"));
}

TEST(ToUrScript, WritesTheDwellAsASleep) {
  EXPECT_THAT(to_urscript(make_program(ring_path(), {.dwell_s = 0.18}), {}),
              HasSubstr("  # phase: dwell\n  sleep(0.180)\n"));
}

TEST(ToUrScript, RefusesNamesAndNumbersThatAControllerWouldNotTake) {
  RobotProgram program = make_program(ring_path());
  EXPECT_THROW(static_cast<void>(to_urscript(program, {}, {.function_name = "1cut"})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(to_urscript(program, {}, {.function_name = "a():\nhalt"})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(to_urscript(program, {}, {.blend_fraction = 0.5})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(to_urscript(program, {}, {.lookahead_s = 0.3})), InvalidArgument);
  program.poses[4].rotation_vector.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(to_urscript(program, {})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(program_json(program)), InvalidArgument);
}

TEST(ProgramHeader, NamesEveryOverrideAndWhatWasNotChecked) {
  ToolPath path = ring_path();
  path.waypoints[20].depth_mm = 5.8;
  const RobotProgram program = make_program(path);
  auto checks = check_program(program, path);
  override_checks(checks, {"depth"});
  const std::string text = to_urscript(program, program_header(program, path, checks));
  EXPECT_THAT(lines_with(text, "# incise.override: ").front(), HasSubstr("depth: 0.8 mm at waypoint 20 (pose "));
  EXPECT_THAT(text, HasSubstr("# incise.check: margin passed: 5 mm >= 2.2 mm\n"));
  EXPECT_THAT(text, HasSubstr("# incise.not_checked: forces"));
  EXPECT_THAT(to_joint_csv(program, program_header(program, path, checks)), HasSubstr("# incise.override: depth"));
  EXPECT_THAT(text, HasSubstr("Virtual"));
}

TEST(ToJointCsv, HasOneRowPerSampleUnderItsNames) {
  const RobotProgram program = make_program(ring_path());
  std::istringstream lines(to_joint_csv(program, {}));
  std::string head;
  std::getline(lines, head);
  EXPECT_THAT(head, ::testing::StartsWith("time_s,shoulder_pan_joint_rad,shoulder_lift_joint_rad,"));
  EXPECT_EQ(std::count(head.begin(), head.end(), ','), 22);
  std::size_t rows = 0;
  for (std::string row; std::getline(lines, row);) rows += std::count(row.begin(), row.end(), ',') == 22;
  EXPECT_EQ(rows, program.motion.samples.size());
}

TEST(ToRosYaml, IsAJointTrajectory) {
  const RobotProgram program = make_program(line_path());
  const YAML::Node message = YAML::Load(to_ros_yaml(program, header_of(program, line_path())));
  EXPECT_EQ(message["header"]["frame_id"].as<std::string>(), "base");
  ASSERT_EQ(message["joint_names"].size(), 6u);
  EXPECT_EQ(message["joint_names"][2].as<std::string>(), "elbow_joint");
  ASSERT_EQ(message["points"].size(), program.motion.samples.size());
  const YAML::Node point = message["points"][300];
  const JointSample& sample = program.motion.samples[300];
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(point["positions"][i].as<double>(), sample.q_rad[i], 1e-9);
    EXPECT_NEAR(point["velocities"][i].as<double>(), sample.speed_rad_s[i], 1e-9);
    EXPECT_NEAR(point["accelerations"][i].as<double>(), sample.acceleration_rad_s2[i], 1e-9);
  }
  const YAML::Node time = point["time_from_start"];
  EXPECT_NEAR(time["sec"].as<double>() + 1e-9 * time["nanosec"].as<double>(), 2.4, 1e-9);
}

/// A bag read by the format's description: records of a header with fields and of data.
struct BagRecord {
  std::map<std::string, std::string> fields;
  std::string data;
};
std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}
std::vector<BagRecord> records_of(const std::string& bytes, std::size_t at = 0) {
  std::vector<BagRecord> records;
  while (at < bytes.size()) {
    BagRecord record;
    const std::string header = bytes.substr(at + 4, number_at(bytes, at));
    at += 4 + header.size();
    for (std::size_t f = 0; f < header.size();) {
      const std::string field = header.substr(f + 4, number_at(header, f));
      f += 4 + field.size();
      record.fields[field.substr(0, field.find('='))] = field.substr(field.find('=') + 1);
    }
    record.data = bytes.substr(at + 4, number_at(bytes, at));
    at += 4 + record.data.size();
    records.push_back(record);
  }
  EXPECT_EQ(at, bytes.size());
  return records;
}

TEST(ToRosbag, HoldsTheTrajectoryAsItsFormatSays) {
  const RobotProgram program = make_program(line_path());
  const std::string bag = to_rosbag(program, header_of(program, line_path()));
  const std::string magic = "#ROSBAG V2.0\n";
  ASSERT_EQ(bag.substr(0, magic.size()), magic);
  const auto records = records_of(bag, magic.size());
  ASSERT_EQ(records.size(), 1u + 1u + 2u + 2u + 1u);  // header, chunk, an index each, connections, what the chunk holds
  const auto op = [&](std::size_t i) { return static_cast<int>(records[i].fields.at("op")[0]); };
  EXPECT_EQ(op(0), 3);
  EXPECT_EQ(op(1), 5);
  EXPECT_EQ(records_of(bag, magic.size() + 4096).front().fields.at("op")[0], 5)
      << "the first record is padded to 4096 bytes";
  // The connections lie where the header says.
  std::uint64_t index_pos = 0;
  std::memcpy(&index_pos, records[0].fields.at("index_pos").data(), 8);
  const auto tail = records_of(bag, index_pos);
  ASSERT_EQ(tail.size(), 3u);
  EXPECT_EQ(tail[1].fields.at("topic"), "/joint_trajectory");
  EXPECT_THAT(tail[1].data, HasSubstr("md5sum=65b4f94a94d1ed67169da35a02f33d3f"));
  // The message: header, names, points of six doubles thrice, an empty list and a time.
  const auto inside = records_of(records[1].data);
  ASSERT_EQ(inside.size(), 4u);
  const std::string& message = inside[3].data;
  std::size_t at = 12 + 4 + 4 + 4;
  for (const auto& name : program.setup.arm.joint_names) at += 4 + name.size();
  ASSERT_EQ(number_at(message, at), program.motion.samples.size());
  at += 4;
  EXPECT_EQ(message.size(), at + program.motion.samples.size() * (3 * (4 + 48) + 4 + 8));
  double q = 0.0;
  std::memcpy(&q, message.data() + at + 4 + 8 * 2, 8);
  EXPECT_EQ(q, program.motion.samples[0].q_rad[2]);
}

TEST(ProgramToJson, HoldsEveryPoseEverySampleAndEveryCheck) {
  const ToolPath path = ring_path();
  const RobotProgram program = make_program(path);
  const ProgramChecks checks = check_program(program, path);
  const auto document = nlohmann::json::parse(program_json(program, &checks));
  EXPECT_EQ(document["poses"].size(), program.poses.size());
  EXPECT_EQ(document["poses"][2]["phase"], "plunge");
  EXPECT_EQ(document["poses"][5]["tip_mm"][0].get<double>(), program.poses[5].tip_mm.x());
  EXPECT_EQ(document["motion"]["samples"].size(), program.motion.samples.size());
  EXPECT_EQ(document["duration_s"].get<double>(), program.duration_s());
  EXPECT_EQ(document["checks"].size(), checks.checks.size());
  EXPECT_FALSE(document["checks_not_made"].empty());
  EXPECT_FALSE(nlohmann::json::parse(program_json(program)).contains("checks"));
}

}  // namespace
}  // namespace incise
