#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/io/json_file.hpp>
#include <incise/laboratory/pooling.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace incise {
namespace {

using ::incise::testing::TemporaryFolder;
using ::testing::HasSubstr;
using PooledJson = nlohmann::ordered_json;

PooledJson cut(const char* path, const PooledJson& error_mm, const PooledJson& margin_mm = nullptr) {
  return {{"path", path},
          {"end", error_mm.is_null() ? "not_cut" : "measured"},
          {"mean_abs_error_mm", error_mm},
          {"least_margin_mm", margin_mm}};
}

PooledJson advised(double p_worse, double planned_mm, double corrected_mm) {
  const auto made = [](double error_mm) {
    return PooledJson{{"p_close_margin", 0.1},
                      {"error_80_mm", {error_mm - 0.1, error_mm + 0.1}},
                      {"error_95_mm", {error_mm + 0.1, error_mm + 0.2}},
                      {"photographed_mm", error_mm},
                      {"true_mm", error_mm},
                      {"least_margin_mm", 3.0}};
  };
  return {{"specimen", "S3"},
          {"role", "test"},
          {"kind", ""},
          {"advice", "compensate"},
          {"p_worse", p_worse},
          {"planned", made(planned_mm)},
          {"corrected", made(corrected_mm)}};
}

/// Finished experiments by hand.
class Pooling : public ::testing::Test {
 protected:
  /// Two test specimens, the first one unlike the calibration's. @param incise_mm  of both.
  std::filesystem::path series(std::uint64_t seed, double incise_mm, double p_worse = 0.1,
                               const std::function<void(PooledJson&)>& change = {}) const {
    const std::filesystem::path at = folder_ / ("series" + std::to_string(seed));
    std::filesystem::create_directories(at);
    write_json(at / "experiment.json", {{"schema", "incise.experiment/1"}, {"seed", seed}, {"bench", 2}});
    PooledJson tested = PooledJson::array();
    PooledJson learning = PooledJson::array();
    for (const char* path : {"photographs", "learned"}) {
      PooledJson part = cut(path, 0.7);
      part["photographs"] = 1;
      learning.push_back(part);
    }
    for (const std::size_t unlike : {2, 1}) {
      tested.push_back(
          {{"specimen", "S" + std::to_string(5 - unlike)},
           {"unlike", unlike},
           {"learning", learning},
           {"cuts",
            {cut("as_planned", 1.5, 2.0), cut("incise_uncalibrated", 0.9), cut("learned", 0.6),
             cut("photographs", 0.5, 2.5), cut("incise", incise_mm, 2.1), cut("robust", incise_mm + 0.1, 2.6)}}});
    }
    const PooledJson advice{{"specimens", PooledJson::array({advised(p_worse, 1.5, incise_mm)})}};
    PooledJson study{{"specimens", 4},
                     {"tested_specimens", tested},
                     {"table_2",
                      {{{"role", "calibrate"}, {"mean_abs_error_mm", 1.4}},
                       {{"role", "calibrate"}, {"mean_abs_error_mm", nullptr}},
                       {{"role", "test"}, {"mean_abs_error_mm", 1.5}}}},
                     {"left_out_of_calibration", PooledJson::array()},
                     {"advice", advice}};
    if (change) change(study);
    write_json(at / "study.json", study);
    return at;
  }
  [[nodiscard]] PooledJson pool(const std::vector<std::filesystem::path>& folders) const {
    Monitor quiet;
    return pool_experiments(folders, folder_ / "pooled", {"test", 1, 1}, quiet);
  }
  void expect_refused(const std::vector<std::filesystem::path>& folders, const char* why) const {
    EXPECT_THAT(testing::refusal_of<DataError>([&] { return pool(folders); }), HasSubstr(why));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "pooled"));
  }
  TemporaryFolder folder_;
};

TEST_F(Pooling, HoldsEveryPathAgainstTheBestOneAndDrawsWholeSeriesAnew) {
  const PooledJson found = pool({series(100, 0.4), series(200, 0.8)});
  EXPECT_EQ(found.at("bench"), 2);
  EXPECT_EQ(found.at("tested"), 4);
  EXPECT_EQ(found.at("best_without_simulation"), "photographs");
  const PooledJson& incise = found.at("rivals").at("incise");
  EXPECT_EQ(incise.at("compared"), 4);
  EXPECT_NEAR(incise.at("difference_mm"), 0.1, 1e-12);
  EXPECT_TRUE(incise.at("confidence_mm").is_null()) << "two series tell no interval";
  EXPECT_EQ(incise.at("close_margins"), 4);
  EXPECT_EQ(found.at("unlike").at("tested"), 2);
  EXPECT_EQ(found.at("like").at("tested"), 2);
  const PooledJson& robust = found.at("robust_against_default");
  EXPECT_NEAR(robust.at("difference_mm"), 0.1, 1e-12);
  EXPECT_EQ(robust.at("close_margins_first"), 4);
  EXPECT_EQ(robust.at("close_margins_second"), 0);
  const PooledJson& first = found.at("series").at(0);
  EXPECT_EQ(first.at("photographs"), 1);
  EXPECT_EQ(first.at("tested_unlike"), 1);
  EXPECT_NEAR(first.at("differences_mm").at("incise"), -0.1, 1e-12);
  for (const char* file : {"pooled.json", "paths.csv", "paths.svg", "learning.svg", "reliability.svg", "manifest.json"})
    EXPECT_TRUE(std::filesystem::is_regular_file(folder_ / "pooled" / file)) << file;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "pooled/roc.svg")) << "nobody was worse";
}

TEST_F(Pooling, DrawsWholeSeriesAnewFromFiveOn) {
  std::vector<std::filesystem::path> all;
  for (const std::uint64_t seed : {100U, 200U, 300U, 400U, 500U})
    all.push_back(series(seed, 0.4 + 0.001 * static_cast<double>(seed)));
  const PooledJson found = pool(all);
  const PooledJson& incise = found.at("rivals").at("incise");
  EXPECT_NEAR(incise.at("difference_mm"), 0.2, 1e-12);
  EXPECT_GT(incise.at("confidence_mm").at(0), 0.0);
  EXPECT_LT(incise.at("confidence_mm").at(0), 0.15);
  EXPECT_GT(incise.at("confidence_mm").at(1), 0.25);
  EXPECT_LT(incise.at("confidence_mm").at(1), 0.4);
}

TEST_F(Pooling, ShowsWhatPhotographsAreWorth) {
  const PooledJson found = pool({series(100, 0.4), series(200, 0.8)});
  const PooledJson& curve = found.at("learning");
  ASSERT_EQ(curve.size(), 3);
  EXPECT_EQ(curve.at(0).at("photographs"), 0);
  EXPECT_NEAR(curve.at(0).at("pair").at("difference_mm"), 0.9 - 1.5, 1e-12);
  EXPECT_EQ(curve.at(1).at("photographs"), 1);
  EXPECT_NEAR(curve.at(1).at("pair").at("difference_mm"), 0.0, 1e-12);
  EXPECT_TRUE(curve.at(2).at("photographs").is_null());
  EXPECT_NEAR(curve.at(2).at("pair").at("difference_mm"), 0.1, 1e-12);
}

TEST_F(Pooling, OfASeriesWithFewerPhotographsTakesAll) {
  const auto with_eight = [](PooledJson& study) {
    for (int i = 0; i < 9; ++i) study["table_2"].push_back({{"role", "calibrate"}, {"mean_abs_error_mm", 1.4}});
    for (PooledJson& specimen : study["tested_specimens"]) {
      for (std::size_t k = 0; k < 2; ++k) {
        PooledJson part = specimen["learning"][k];
        part["photographs"] = 8;
        specimen["learning"].push_back(part);
      }
    }
  };
  const PooledJson found = pool({series(100, 0.4, 0.1, with_eight), series(200, 0.8)});
  const PooledJson& curve = found.at("learning");
  ASSERT_EQ(curve.size(), 4);
  EXPECT_EQ(curve.at(2).at("photographs"), 8);
  EXPECT_EQ(curve.at(2).at("pair").at("compared"), 4);
  EXPECT_NEAR(curve.at(2).at("pair").at("difference_mm"), 0.05, 1e-12) << "0 with eight, 0.1 with all of one";
}

TEST_F(Pooling, ScoresTheAdviceOverAllSeries) {
  const PooledJson found = pool({series(100, 0.4, 0.1), series(200, 1.8, 0.6)});
  const PooledJson& advice = found.at("advice");
  EXPECT_EQ(advice.at("advised"), 2);
  EXPECT_EQ(advice.at("intervals_by"), "specimens") << "too few series to draw anew";
  EXPECT_EQ(advice.at("specimens").at(1).at("specimen"), "200/S3");
  EXPECT_EQ(advice.at("worse"), 1);
  EXPECT_EQ(advice.at("auc").at("area"), 1.0);
  EXPECT_EQ(advice.at("close_margin").at("cuts"), 4);
  EXPECT_EQ(advice.at("intervals").at(0).at("held"), 2) << "80 % as planned";
  EXPECT_EQ(advice.at("intervals").at(1).at("held"), 0) << "95 % as planned";
  EXPECT_TRUE(std::filesystem::exists(folder_ / "pooled/roc.svg"));
}

TEST_F(Pooling, RefusesWhatCannotBeCountedTogether) {
  const std::filesystem::path first = series(100, 0.4), overlapping = series(103, 0.4);
  expect_refused({first, overlapping}, "seeds other than those of");
  EXPECT_THROW(static_cast<void>(pool({first})), InvalidArgument);
  expect_refused({first, folder_ / "missing"}, "no such file");
  expect_refused({first, series(200, 0.4, 0.1, [](PooledJson& study) { study.erase("tested_specimens"); })},
                 "tested_specimens: found no list");
  expect_refused(
      {first,
       series(200, 0.4, 0.1, [](PooledJson& study) { study["tested_specimens"][0]["cuts"][2]["path"] = "another"; })},
      "path another");
  expect_refused({first, series(200, 0.4, 0.1,
                                [](PooledJson& study) {
                                  study["tested_specimens"][0]["cuts"][2]["mean_abs_error_mm"] = nullptr;
                                })},
                 "lacks an error");
  expect_refused(
      {first, series(200, 0.4, 0.1, [](PooledJson& study) { study["tested_specimens"][0]["cuts"].erase(0); })},
      "no measured cut as planned");
  const auto refuse = [&](const char* why, const std::function<void(PooledJson&)>& change) {
    expect_refused({first, series(200, 0.4, 0.1, change)}, why);
  };
  refuse("S3 twice", [](PooledJson& study) { study["tested_specimens"][1]["specimen"] = "S3"; });
  refuse("two cuts along robust",
         [](PooledJson& study) { study["tested_specimens"][0]["cuts"].push_back(cut("robust", 0.5)); });
  refuse("lacks an error",
         [](PooledJson& study) { study["tested_specimens"][0]["learning"][0]["mean_abs_error_mm"] = nullptr; });
  refuse("of 0 photographs", [](PooledJson& study) { study["tested_specimens"][0]["learning"][0]["photographs"] = 0; });
  refuse("as in", [](PooledJson& study) {
    for (PooledJson& specimen : study["tested_specimens"]) specimen["cuts"].erase(specimen["cuts"].size() - 1);
  });
  refuse("table_2: found no list", [](PooledJson& study) { study["table_2"] = 3; });
  refuse("expected a number in",
         [](PooledJson& study) { study["tested_specimens"][0]["cuts"][0]["mean_abs_error_mm"] = 1e308; });
  const std::filesystem::path other = series(200, 0.4);
  write_json(other / "experiment.json", {{"seed", 200}});
  expect_refused({first, other}, "bench: found 1");
  write_json(other / "experiment.json", {{"seed", 200}, {"bench", 4294967298}});
  expect_refused({first, other}, "1 or 2");
  write_json(other / "experiment.json", {{"seed", "200"}, {"bench", 2}});
  expect_refused({first, other}, "a whole number");
}

}  // namespace
}  // namespace incise
