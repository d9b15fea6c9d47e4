#include "io/io_test_support.hpp"

#include <incise/core/described_json.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/path_io.hpp>

#include <nlohmann/json.hpp>

#include <limits>

namespace incise {
namespace {

using incise::testing::refusal_of;
using incise::testing::TemporaryFolder;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

ToolPath sample_path() {
  ToolPath path{.frame = PathFrame::Robot};
  path.waypoints = {{Vec3(1.0 / 3.0, -0.1, 1e-17), -Vec3::UnitZ(), 5.0, 7.0},
                    {Vec3(10.0, 0.0, 0.0), Vec3(0.6, 0.0, -0.8), 4.75, 7.0},
                    {Vec3(0.0, 10.0, 0.0), -Vec3::UnitZ(), 5.0, 3.3}};
  path.tumor_edge.points = {Vec3(1, 1, 0), Vec3(2, 1, 0), Vec3(1, 2, 0.7)};
  path.T_robot_sim = Mat4::Identity();
  (*path.T_robot_sim)(0, 3) = 512.123456789;
  path.source_sha256 = std::string(64, 'a');
  return path;
}

/// The message for the sample's JSON after a change.
template <class Change>
std::string message_after(Change change) {
  json document = json::parse(path_json(sample_path()));
  change(document);
  return refusal_of<DataError>([&] { return tool_path_from_json(document.dump(), "path.json"); });
}

TEST(ToolPathFile, ReadsBackTheSameDoubles) {
  const TemporaryFolder folder;
  const ToolPath path = sample_path();
  write_tool_path(folder / "path.json", path);
  const ToolPath back = read_tool_path(folder / "path.json");
  EXPECT_EQ(back.frame, PathFrame::Robot);
  EXPECT_EQ(back.kind, PathKind::Incise);
  EXPECT_TRUE(back.is_closed);
  ASSERT_EQ(back.waypoints.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(back.waypoints[i].position_mm, path.waypoints[i].position_mm);
    EXPECT_EQ(back.waypoints[i].axis, path.waypoints[i].axis);
    EXPECT_EQ(back.waypoints[i].depth_mm, path.waypoints[i].depth_mm);
    EXPECT_EQ(back.waypoints[i].speed_mm_s, path.waypoints[i].speed_mm_s);
    EXPECT_EQ(back.tumor_edge.points[i], path.tumor_edge.points[i]);
  }
  EXPECT_EQ(*back.T_robot_sim, *path.T_robot_sim);
  EXPECT_EQ(back.source_sha256, path.source_sha256);
}

TEST(ToolPathFile, KeepsAnOpenPathWithoutOptionalParts) {
  ToolPath path = sample_path();
  path.is_closed = false;
  path.kind = PathKind::Mark;
  path.frame = PathFrame::SimRest;
  path.tumor_edge = {{}, false};
  path.T_robot_sim.reset();
  path.source_sha256.clear();
  const ToolPath back = tool_path_from_json(path_json(path), "x");
  EXPECT_FALSE(back.is_closed);
  EXPECT_FALSE(back.tumor_edge.is_closed);
  EXPECT_EQ(back.kind, PathKind::Mark);
  EXPECT_EQ(back.frame, PathFrame::SimRest);
  EXPECT_FALSE(back.T_robot_sim.has_value());
  EXPECT_TRUE(back.source_sha256.empty());
}

TEST(ToolPathFile, NamesTheNearestKeyForAnUnknownOne) {
  EXPECT_THAT(message_after([](json& d) { d["fame"] = "robot"; }),
              AllOf(HasSubstr("path.json: /: found unknown key 'fame'"), HasSubstr("'frame'?")));
  EXPECT_THAT(message_after([](json& d) { d["waypoints"][1]["speed_mm"] = 1; }),
              AllOf(HasSubstr("/waypoints/1: "), HasSubstr("'speed_mm_s'?")));
}

TEST(ToolPathFile, NamesThePlaceOfWhatIsMissingOrOfTheWrongType) {
  EXPECT_THAT(message_after([](json& d) { d.erase("frame"); }), HasSubstr("/frame: found no such key"));
  EXPECT_THAT(message_after([](json& d) { d["waypoints"][2].erase("axis"); }),
              HasSubstr("/waypoints/2/axis: found no such key"));
  EXPECT_THAT(message_after([](json& d) { d["frame"] = "world"; }),
              HasSubstr("/frame: found \"world\", expected sim_rest, sim_stretched or robot"));
  EXPECT_THAT(message_after([](json& d) { d["closed"] = 1; }), HasSubstr("/closed: found 1, expected true or false"));
  EXPECT_THAT(message_after([](json& d) {
                d["waypoints"][0]["position_mm"] = {1, 2};
              }),
              HasSubstr("/waypoints/0/position_mm: found [1,2], expected a list of 3 numbers"));
  for (const char* key :
       {"schema", "tumor_edge", "tumor_edge_closed", "T_robot_sim", "source_sha256", "specimen_id", "specimen_is"}) {
    EXPECT_THAT(message_after([key](json& d) { d[key] = nullptr; }),
                HasSubstr(std::string("/") + key + ": found null, expected a value, or no such key"));
  }
  EXPECT_THAT(message_after([](json& d) { d["waypoints"][0]["position_mm"][1] = nullptr; }),
              HasSubstr("/waypoints/0/position_mm/1: found null, expected a number"));
  EXPECT_THAT(message_after([](json& d) { d["waypoints"].erase(0); }), HasSubstr("found 2 items, expected at least 3"));
  EXPECT_THAT(message_after([](json& d) { d["schema"] = "incise.path/2"; }), HasSubstr("/schema"));
}

TEST(ToolPathFile, RefusesValuesOutOfRange) {
  EXPECT_THAT(message_after([](json& d) {
                d["waypoints"][1]["axis"] = {0, 0, -2};
              }),
              HasSubstr("/waypoints/1/axis: found a vector of length 2, expected a unit vector"));
  EXPECT_THAT(message_after([](json& d) { d["waypoints"][1]["depth_mm"] = -1; }), HasSubstr("/waypoints/1/depth_mm"));
  EXPECT_THAT(message_after([](json& d) { d["waypoints"][1]["speed_mm_s"] = 0; }),
              HasSubstr("/waypoints/1/speed_mm_s"));
  EXPECT_THAT(message_after([](json& d) { d["T_robot_sim"][3][0] = 1; }),
              HasSubstr("/T_robot_sim: found the last row 1 0 0 1"));
  EXPECT_THAT(message_after([](json& d) { d["T_robot_sim"][0][0] = -1; }), HasSubstr("determinant -1"));
  EXPECT_THAT(message_after([](json& d) { d["source_sha256"] = "abc"; }), HasSubstr("64 lower-case hex digits"));
}

TEST(ToolPathFile, RefusesTextThatIsNotJson) {
  EXPECT_THAT(refusal_of<DataError>([] { return tool_path_from_json("{\"frame\": NaN}", "path.json"); }),
              HasSubstr("path.json: line 1, column"));
}

TEST(ToolPathFile, IsNotWrittenWhenItCouldNotBeReadBack) {
  const TemporaryFolder folder;
  ToolPath path = sample_path();
  path.waypoints[0].position_mm.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_tool_path(folder / "path.json", path), InvalidArgument);
  path = sample_path();
  path.waypoints[1].axis *= 1.1;
  EXPECT_THROW(write_tool_path(folder / "path.json", path), InvalidArgument);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

Verdict sample_verdict() {
  Verdict verdict;
  verdict.add("depth", 0.52, "2.6 mm deep", VerdictPlace{12.5, Vec3(1.0 / 3.0, 2, 3), "12 mm along the path"});
  verdict.add("open_layer", 3.25, "open at 4 mm");
  verdict.add("mesh_resolution", {}, "coarse");
  return verdict;
}

TEST(VerdictJson, ReadsBackWhatWasWritten) {
  const Verdict verdict = sample_verdict();
  EXPECT_EQ(to_json(from_json<Verdict>(to_json(verdict), "x")), to_json(verdict));
  EXPECT_EQ(to_json(verdict).at("status"), "refused");
  EXPECT_EQ(to_json(verdict).at("reasons").at(0).at("id"), "open_layer");
  EXPECT_EQ(to_json(from_json<Verdict>(to_json(Verdict()), "x")), to_json(Verdict()));
}

TEST(VerdictJson, RefusesAStatusThatIsNotThatOfItsReasonsAndASeverityThatIsNotItsRules) {
  const auto says = [](auto change) {
    nlohmann::ordered_json document = to_json(sample_verdict());
    change(document);
    return refusal_of<DataError>([&] { return from_json<Verdict>(document, "x"); });
  };
  EXPECT_THAT(says([](auto& found) { found["status"] = "ok"; }),
              HasSubstr("expected refused, the severity of the worst reason"));
  EXPECT_THAT(says([](auto& found) { found["reasons"][0]["severity"] = "caution"; }), HasSubstr("/reasons/0/severity"));
  EXPECT_THAT(says([](auto& found) { found["reasons"][0]["id"] = "nonsense"; }), HasSubstr("the id of a rule"));
  EXPECT_THAT(says([](auto& found) { found["reasons"][1].erase("message"); }), HasSubstr("message"));
}

/// Ids of the reasons that a path's file holds against it.
std::vector<std::string> ids_in(const std::filesystem::path& file) {
  std::vector<std::string> ids;
  const Verdict verdict = read_path_verdict(file);
  for (const VerdictReason& reason : verdict.reasons()) ids.push_back(reason.id);
  return ids;
}

TEST(PathVerdict, TravelsWithThePathAndIsOfNoUseOnceEitherWasChanged) {
  const TemporaryFolder folder;
  const auto file = folder / "path.json";
  write_tool_path(file, sample_path());
  EXPECT_THAT(ids_in(file), ::testing::ElementsAre("not_simulated")) << "a path made by hand";
  write_tool_path(file, sample_path(), sample_verdict());
  EXPECT_EQ(to_json(read_path_verdict(file)), to_json(sample_verdict()));
  EXPECT_EQ(read_tool_path(file).waypoints.size(), 3U);
  const nlohmann::ordered_json written = read_json(file);
  for (const char* place : {"/waypoints/1/position_mm/2", "/waypoints/2/depth_mm", "/tumor_edge/0/0", "/T_robot_sim/0/3"}) {
    nlohmann::ordered_json changed = written;
    double& number = changed.at(nlohmann::ordered_json::json_pointer(place)).get_ref<double&>();
    number += 1e-9;
    write_json(file, changed);
    EXPECT_THAT(ids_in(file), ::testing::UnorderedElementsAre("open_layer", "not_simulated")) << place;
  }
  nlohmann::ordered_json forged = written;
  forged["verdict"]["reasons"] = nlohmann::ordered_json::array();
  forged["verdict"]["status"] = "ok";
  write_json(file, forged);
  EXPECT_THAT(ids_in(file), ::testing::ElementsAre("not_simulated")) << "a verdict written by hand";
}

TEST(ToolPathFile, ItsTransformIsASimilarity) {
  const auto with = [](auto change) {
    return message_after([&](json& document) { change(document["T_robot_sim"]); });
  };
  EXPECT_THAT(with([](json& T) { T[0][1] = 0.05; }), AllOf(HasSubstr("/T_robot_sim"), HasSubstr("a similarity"))) << "shear";
  EXPECT_THAT(with([](json& T) { T[2][2] = 1.05; }), HasSubstr("a similarity")) << "unequal axes";
  json scaled = json::parse(path_json(sample_path()));
  for (int i = 0; i < 3; ++i) scaled["T_robot_sim"][i][i] = 1.02;
  EXPECT_NO_THROW(static_cast<void>(tool_path_from_json(scaled.dump(), "x")));
}

}  // namespace
}  // namespace incise
