#include "support/temporary_folder.hpp"

#include <incise/io/json_text.hpp>
#include <incise/storage/robust_files.hpp>

#include <gmock/gmock.h>

namespace incise {
namespace {

using ::testing::HasSubstr;
using testing::TemporaryFolder;

constexpr RunSetting kTissue{.speed_mm_s = 13.0, .dullness = 5.5, .stiffness_of_case = 0.9};

class Heard : public Monitor {
 public:
  void message(Severity, std::string_view text) override { told += std::string(text); }
  std::string told;
};

class ScenarioRuns : public ::testing::Test {
 protected:
  static ToolPath path(double shift_mm) {
    ToolPath path;
    for (const Vec3& p : {Vec3(0, 0, 1), Vec3(9, 0, 1), Vec3(4, 7, 1)})
      path.waypoints.push_back({.position_mm = p + shift_mm * Vec3::UnitX()});
    return path;
  }
  static ScenarioRun measured() {
    ScenarioRun run{.setting = kTissue};
    run.errors = PathErrors{{Vec3(1.0 / 3.0, 2, 3), Vec3(4, 5, 6)}, {-1.1, 0.1 + 0.2}, 1.7, false};
    return run;
  }
  TemporaryFolder folder_;
  ScenarioRunFolder runs_{folder_.path() / "scenario_runs", "key of the case"};
  Heard heard_;
};

TEST_F(ScenarioRuns, AreKeptToTheLastBit) {
  runs_.save(measured(), path(0.0));
  const ScenarioRun read = runs_.load(kTissue, path(0.0), heard_).value();
  ASSERT_TRUE(read.errors);
  EXPECT_EQ(read.errors->places, measured().errors->places);
  EXPECT_EQ(read.errors->signed_error_mm, measured().errors->signed_error_mm);
  EXPECT_EQ(read.errors->lag_mm, 1.7);
  EXPECT_FALSE(read.errors->is_success);
  EXPECT_EQ(read.setting, kTissue);
}

TEST_F(ScenarioRuns, ARingThatStayedOpenIsKeptAsOne) {
  runs_.save({.setting = kTissue, .errors = std::nullopt, .problem = "the tool is too thick"}, path(0.0));
  const ScenarioRun read = runs_.load(kTissue, path(0.0), heard_).value();
  EXPECT_FALSE(read.errors);
  EXPECT_EQ(read.problem, "the tool is too thick");
}

TEST_F(ScenarioRuns, OfAnotherPathTissueOrCaseAreNotThere) {
  runs_.save(measured(), path(0.0));
  EXPECT_FALSE(runs_.load(kTissue, path(1e-9), heard_));
  RunSetting stiffer = kTissue;
  stiffer.stiffness_of_case = 1.1;
  EXPECT_FALSE(runs_.load(stiffer, path(0.0), heard_));
  ScenarioRunFolder other(folder_.path() / "scenario_runs", "key of another case");
  EXPECT_FALSE(other.load(kTissue, path(0.0), heard_));
  ToolPath elsewhere = path(0.0);
  elsewhere.source_sha256 = std::string(64, 'a');
  EXPECT_TRUE(runs_.load(kTissue, elsewhere, heard_)) << "which file a path was read from does not count";
  ToolPath from_file = path(0.0);
  from_file.is_virtual = true;
  EXPECT_TRUE(runs_.load(kTissue, from_file, heard_)) << "nor that its file says what the specimen is";
  EXPECT_EQ(heard_.told, "");
}

TEST_F(ScenarioRuns, ADamagedOneIsToldAndCountsAsAbsent) {
  runs_.save(measured(), path(0.0));
  const std::filesystem::path file = runs_.file_of(kTissue, path(0.0));
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  EXPECT_FALSE(runs_.load(kTissue, path(0.0), heard_));
  EXPECT_THAT(heard_.told, ::testing::AllOf(HasSubstr(file.filename().string()), HasSubstr("simulated anew")));
  runs_.save(measured(), path(0.0));
  nlohmann::ordered_json json = read_json(file);
  json["errors"]["signed_error_mm"] = {1.0};
  write_json(file, json);
  heard_.told.clear();
  EXPECT_FALSE(runs_.load(kTissue, path(0.0), heard_));
  EXPECT_THAT(heard_.told, HasSubstr("errors.signed_error_mm"));
}

}  // namespace
}  // namespace incise
