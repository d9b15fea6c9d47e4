#include "laboratory/experiment_rivals.hpp"

#include <incise/core/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace incise::laboratory {
namespace {

using RivalJson = nlohmann::ordered_json;
using ::testing::HasSubstr;

/// A cut with this mean error. @param error_mm  absent: its ring stayed open.
PathCut cut_with(std::string path, std::optional<double> error_mm) {
  return {.path = std::move(path), .end = error_mm ? PathEnd::Measured : PathEnd::Open, .mean_abs_error_mm = error_mm};
}

TestedSpecimen specimen_of(std::vector<PathCut> cuts) {
  return {.name = "S", .unlike = {}, .cuts = std::move(cuts)};
}

PathCut& at(TestedSpecimen& specimen, std::string_view path) {
  return *std::find_if(specimen.cuts.begin(), specimen.cuts.end(), [&](const PathCut& c) { return c.path == path; });
}

TestedSeries three_specimens() {
  const auto specimen = [](double planned_mm, double constant_mm, double profile_mm, double incise_mm,
                           double hybrid_mm) {
    return specimen_of({cut_with("as_planned", planned_mm), cut_with("constant", constant_mm),
                        cut_with("profile", profile_mm), cut_with("incise", incise_mm), cut_with("hybrid", hybrid_mm)});
  };
  return {specimen(1.8, 0.6, 0.3, 0.5, 0.2), specimen(1.6, 0.5, 0.4, 0.4, 0.3), specimen(1.7, 1.9, 0.2, 0.6, 0.2)};
}

TEST(ComparePaths, HoldsEveryPathAgainstTheBestWithoutSimulation) {
  const PathComparison paths = compare_paths(three_specimens());
  ASSERT_TRUE(paths.best_without_simulation);
  EXPECT_EQ(*paths.best_without_simulation, "profile") << "the hybrid is better, but it simulates";
  std::vector<std::string> names;
  for (const PathResult& path : paths.paths) names.push_back(path.name);
  EXPECT_EQ(names, (std::vector<std::string>{"as_planned", "constant", "profile", "incise", "hybrid"}));
  const PathResult& incise = *paths.find("incise");
  EXPECT_TRUE(incise.is_simulated);
  EXPECT_NEAR(*incise.mean_mm, 0.5, 1e-12);
  EXPECT_NEAR(*incise.difference_mm, 0.2, 1e-12) << "0.2, 0.0 and 0.4";
  // Student's interval of three differences of mean 0.2 and sd 0.2: ± 4.3027 · 0.2 / √3.
  EXPECT_NEAR(incise.confidence->low, 0.2 - 0.4968, 1e-3);
  EXPECT_NEAR(incise.confidence->high, 0.2 + 0.4968, 1e-3);
  EXPECT_NEAR(*paths.find("hybrid")->difference_mm, -0.2 / 3.0, 1e-12);
  EXPECT_FALSE(paths.find("profile")->difference_mm) << "it is the best";
  EXPECT_EQ(paths.find("constant")->worse, 1U);
  EXPECT_THAT(claim_of(paths, "incise"), HasSubstr("incise 0.50 mm, profile 0.30 mm (best without simulation) on 3 "
                                                   "specimens: difference +0.20 mm (-0.30 to +0.70)"));
}

TEST(ComparePaths, CountsOpenRingsAsWorseAndComparesClosedPairsAlone) {
  TestedSeries specimens = three_specimens();
  at(specimens[0], "profile") = cut_with("profile", std::nullopt);
  at(specimens[1], "incise") = {.path = "incise"};  // refused
  const PathComparison paths = compare_paths(specimens);
  EXPECT_EQ(*paths.best_without_simulation, "profile");
  EXPECT_EQ(paths.find("profile")->worse, 1U);
  EXPECT_EQ(paths.find("profile")->pairs, 2U);
  EXPECT_EQ(paths.find("incise")->uncut, 1U);
  EXPECT_EQ(paths.find("incise")->compared, 1U);
  EXPECT_NEAR(*paths.find("incise")->compared_mean_mm, 0.6, 1e-12);
  EXPECT_FALSE(paths.find("incise")->confidence) << "one pair has no spread";
  EXPECT_THAT(claim_of(paths, "incise"), HasSubstr("on 1 specimen: difference +0.40 mm; 1 not cut"));
}

TEST(ComparePaths, ChooseTheBestOverTheSpecimensThatAllOfThemClosed) {
  TestedSeries specimens = three_specimens();
  // By its own mean the constant offset would win: it closed on the easiest specimen alone, and lost to the profile
  // there.
  at(specimens[0], "constant") = cut_with("constant", std::nullopt);
  at(specimens[2], "constant") = cut_with("constant", std::nullopt);
  at(specimens[1], "constant") = cut_with("constant", 0.25);
  at(specimens[1], "profile") = cut_with("profile", 0.20);
  at(specimens[0], "profile") = cut_with("profile", 0.9);
  EXPECT_EQ(*compare_paths(specimens).best_without_simulation, "profile");
  // Where every rival is worse than the planned path, that is what has to be beaten.
  for (TestedSpecimen& specimen : specimens)
    for (const char* path : {"constant", "profile"}) at(specimen, path) = cut_with(path, 2.5);
  EXPECT_EQ(*compare_paths(specimens).best_without_simulation, "as_planned");
}

TEST(ComparePaths, ClaimNothingWithoutARival) {
  TestedSeries specimens = three_specimens();
  for (TestedSpecimen& specimen : specimens) specimen.cuts = {at(specimen, "as_planned"), at(specimen, "incise")};
  const PathComparison paths = compare_paths(specimens);
  EXPECT_FALSE(paths.best_without_simulation);
  EXPECT_EQ(claim_of(paths, "incise"), "");
  const RivalJson json = paths_json(paths);
  EXPECT_EQ(json.size(), 2U);
  EXPECT_TRUE(json.at("incise").at("difference_mm").is_null());
  EXPECT_EQ(json.at("as_planned").at("pairs"), 3);
}

TEST(ComparePaths, CountsHarmAndCloseMargins) {
  TestedSeries specimens = three_specimens();
  at(specimens[0], "incise").mean_abs_error_mm = 1.85;  // worse by 0.05 mm
  at(specimens[1], "incise").mean_abs_error_mm = 1.75;  // by 0.15 mm
  at(specimens[0], "incise").least_margin_mm = 2.1;
  at(specimens[1], "incise").least_margin_mm = 2.3;
  const PathComparison paths = compare_paths(specimens);
  EXPECT_EQ(paths.find("incise")->worse, 2U);
  EXPECT_EQ(paths.find("incise")->harmed, 1U);
  EXPECT_EQ(paths.find("incise")->closed, 2U) << "the third one's truth is not known";
  EXPECT_EQ(paths.find("incise")->close_margins, 1U);
}

TEST(ComparePaths, DrawsWholeSeriesAnewWhereThereAreSeveral) {
  const TestedSeries three = three_specimens();
  TestedSeries others = three;
  for (TestedSpecimen& specimen : others) *at(specimen, "incise").mean_abs_error_mm += 0.4;
  const std::vector<TestedSeries> both{three, others};
  const PathComparison paths = compare_paths(both);
  const PathResult& incise = *paths.find("incise");
  EXPECT_EQ(incise.compared, 6U);
  EXPECT_NEAR(*incise.difference_mm, 0.4, 1e-12);
  EXPECT_FALSE(incise.confidence) << "two series tell no interval";
  const std::vector<TestedSeries> six{three, others, three, others, three, others};
  const Interval found = *compare_paths(six).find("incise")->confidence;
  EXPECT_NEAR(0.5 * (found.low + found.high), 0.4, 0.02);
  EXPECT_GT(found.high - found.low, 0.2) << "specimens of a series are alike";
  const std::vector<TestedSeries> few{three, others, {}, {}, {}, {}};
  EXPECT_FALSE(compare_paths(few).find("incise")->confidence) << "nothing to compare in four of them";
}

TEST(ComparePaths, RefusesTheNameOfNoPath) {
  EXPECT_THROW(static_cast<void>(is_path_without_simulation("another")), InvalidArgument);
  EXPECT_TRUE(is_path_without_simulation("photographs"));
  EXPECT_FALSE(is_path_without_simulation("incise"));
}

TEST(CompareTwo, HoldsOnePathAgainstAnotherOnTheSpecimensThatBothClosed) {
  TestedSeries specimens = three_specimens();
  at(specimens[0], "hybrid") = cut_with("hybrid", std::nullopt);
  for (const std::size_t i : {1U, 2U}) {
    at(specimens[i], "incise").least_margin_mm = 2.0;
    at(specimens[i], "hybrid").least_margin_mm = i == 1 ? 2.0 : 3.0;
  }
  const PathPair pair = compare_two(std::span(&specimens, 1), "incise", "hybrid");
  EXPECT_EQ(pair.compared, 2U);
  EXPECT_NEAR(*pair.difference_mm(), -0.25, 1e-12) << "0.3 - 0.4 and 0.2 - 0.6";
  EXPECT_EQ(pair.closed, 2U);
  EXPECT_EQ(pair.close_margins_first, 2U);
  EXPECT_EQ(pair.close_margins_second, 1U);
  EXPECT_FALSE(compare_two(std::span(&specimens, 1), "incise", "robust").difference_mm());
}

TEST(LearningCurve, GoesFromNoPhotographToAllOnTheSpecimensThatBothClosed) {
  TestedSeries specimens;
  for (const double more_mm : {0.0, 0.2}) {
    TestedSpecimen& one =
        specimens.emplace_back(specimen_of({cut_with("as_planned", 1.5), cut_with("incise_uncalibrated", 0.9 + more_mm),
                                            cut_with("photographs", 0.5 + more_mm), cut_with("learned", 0.6)}));
    one.learning = {{2, cut_with("photographs", 0.8 + more_mm)}, {2, cut_with("learned", 0.7)}};
  }
  const std::vector<LearningPoint> curve = learning_curve(std::span(&specimens, 1));
  ASSERT_EQ(curve.size(), 3U);
  EXPECT_EQ(curve[0].photographs, 0U);
  EXPECT_NEAR(*curve[0].pair.difference_mm(), 1.0 - 1.5, 1e-12);
  EXPECT_EQ(curve[1].photographs, 2U);
  EXPECT_NEAR(*curve[1].pair.first_mm, 0.9, 1e-12);
  EXPECT_NEAR(*curve[1].pair.difference_mm(), -0.2, 1e-12);
  EXPECT_FALSE(curve[2].photographs) << "all";
  EXPECT_NEAR(*curve[2].pair.difference_mm(), 0.0, 1e-12);
  EXPECT_EQ(learning_plot(curve, 9.0).series[0].x, (std::vector<double>{0.0, 2.0, 9.0}));
  specimens[1].learning[0].cut = cut_with("photographs", std::nullopt);
  for (const LearningPoint& point : learning_curve(std::span(&specimens, 1)))
    EXPECT_EQ(point.pair.compared, 1U) << "the same specimens at every point";
  specimens[0].learning.clear();
  specimens[1].learning.clear();
  EXPECT_TRUE(learning_curve(std::span(&specimens, 1)).empty()) << "nobody asked";
}

}  // namespace
}  // namespace incise::laboratory
