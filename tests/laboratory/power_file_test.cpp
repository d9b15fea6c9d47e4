#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"

#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/io/json_file.hpp>
#include <incise/laboratory/power_file.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace incise {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

PowerCut kept_cut() {
  PowerCut cut;
  cut.specimen = "seed 1";
  cut.power_w = 35.0;
  cut.speed_mm_s = 7.0;
  cut.outcome = Outcome::Success;
  cut.bulge_mm = 1.0 / 3.0;
  cut.thermal_width_mm = 0.94;
  cut.mean_abs_error_mm = 1.5;
  return cut;
}

TEST(PowerTable, SaysWhatASeriesFoundAndLeavesOutWhatWasNotMeasured) {
  PowerSeries series{.cuts = {kept_cut()}};
  PowerCut none = kept_cut();
  none.outcome = Outcome::NotConverged;
  none.bulge_mm.reset();
  none.problem = "the specimen could not be stretched";
  series.speed_cuts = {none};
  const TextTable table = power_table(series);
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[0][0], "power");
  EXPECT_EQ(table.rows[1][0], "speed");
  EXPECT_EQ(table.rows[1][4], "not_converged");
  EXPECT_EQ(table.rows[1][5], "");
  EXPECT_EQ(table.rows[1].back(), "the specimen could not be stretched");
  const nlohmann::ordered_json json = to_json(series);
  EXPECT_EQ(json["verdict"], "no_power_fits");
  EXPECT_TRUE(json["chosen_w"].is_null());
  EXPECT_TRUE(json["speed_rows"][0]["bulge_mm"].is_null());
}

class TimedCutsTest : public ::testing::Test {
 protected:
  std::vector<TimedCut> read(const std::string& text) {
    std::ofstream(folder_ / "cuts.csv") << text;
    return read_timed_cuts(folder_ / "cuts.csv");
  }
  std::string refusal(const std::string& text) {
    return testing::refusal_of<DataError>([&] { return read(text); });
  }
  testing::TemporaryFolder folder_;
};

TEST_F(TimedCutsTest, ThePapersSixCutsGiveThePapersSpeed) {
  const SpeedEstimate speed = estimate_speed(
      read_timed_cuts(std::filesystem::path(INCISE_SOURCE_DIR) / "data/published_tables/timed_cuts.csv"));
  EXPECT_NEAR(speed.mean_mm_s, 7.22, 0.005);
  EXPECT_NEAR(speed.population_sd_mm_s, 1.89, 0.005);
  EXPECT_NEAR(speed.sample_sd_mm_s.value(), 2.07, 0.005);
}

TEST_F(TimedCutsTest, ColumnsMayComeInAnyOrderAmongOthers) {
  const std::vector<TimedCut> cuts = read("tongue,time_s,length_mm\nA,20,100\n\nB,10,50\n");
  ASSERT_EQ(cuts.size(), 2U);
  EXPECT_EQ(cuts[0].length_mm, 100.0);
  EXPECT_EQ(cuts[1].time_s, 10.0);
}

TEST_F(TimedCutsTest, ABadRowIsNamedByLineAndColumn) {
  EXPECT_THAT(
      refusal("length_mm,time_s\n100,9\n\n100,0\n"),
      AllOf(HasSubstr("cuts.csv"), HasSubstr("line 4, column time_s"), HasSubstr("found 0"), HasSubstr("above 0")));
  EXPECT_THAT(refusal("length_mm,time_s\n-5,9\n"), HasSubstr("line 2, column length_mm"));
  EXPECT_THAT(refusal("length_mm,time_s\n100,nan\n"), HasSubstr("line 2, column time_s"));
  EXPECT_THAT(refusal("length_mm,time_s\n100\n"), HasSubstr("line 2"));
  EXPECT_THAT(refusal("length_mm,seconds\n100,9\n"), HasSubstr("the column time_s"));
  EXPECT_THAT(refusal("length_mm,time_s\n"), HasSubstr("no rows"));
}

TEST_F(TimedCutsTest, ACutThatNobodyMakesIsNamedByLineAndColumn) {
  EXPECT_THAT(refusal("length_mm,time_s\n100,9\n1e300,1e-300\n"),
              AllOf(HasSubstr("line 3, column length_mm: found 1e+300"), HasSubstr("1 to 2000 mm")));
  EXPECT_THAT(refusal("length_mm,time_s\n0.1,0.02\n"), HasSubstr("line 2, column length_mm: found 0.1"));
  EXPECT_THAT(
      refusal("length_mm,time_s\n30,1e-9\n"),
      AllOf(HasSubstr("line 2, column time_s: found 30 mm in 1e-09 s: 3e+10 mm/s"), HasSubstr("0.5 to 50 mm/s")));
  EXPECT_THAT(refusal("length_mm,time_s\n30,1e300\n"), HasSubstr("line 2, column time_s"));
  EXPECT_EQ(read("length_mm,time_s\n100,2\n100,200\n").size(), 2U);
}

}  // namespace
}  // namespace incise
