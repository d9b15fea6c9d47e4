#include "laboratory/experiment_rivals.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace incise::laboratory {
namespace {

using RivalJson = nlohmann::ordered_json;
using ::testing::HasSubstr;

/// A cut with this mean error. @param error_mm  absent: its ring stayed open.
TrialCut cut_with(std::optional<double> error_mm) {
  TrialCut cut{.is_made = true};
  if (error_mm) cut.measured = MeasuredCut{{}, {{"abs_error_mm", {{"mean", *error_mm}}}}};
  return cut;
}

Trial test_specimen(double planned_mm, double corrected_mm,
                    const std::vector<std::pair<RivalPath, std::optional<double>>>& rivals) {
  Trial trial{.name = "S", .role = TrialRole::Test};
  trial.planned = cut_with(planned_mm);
  trial.corrected = cut_with(corrected_mm);
  for (const auto& [path, error_mm] : rivals) trial.rivals.push_back({path, cut_with(error_mm)});
  return trial;
}

std::vector<Trial> three_specimens() {
  return {test_specimen(1.8, 0.5, {{RivalPath::Constant, 0.6}, {RivalPath::Profile, 0.3}, {RivalPath::Hybrid, 0.2}}),
          test_specimen(1.6, 0.4, {{RivalPath::Constant, 0.5}, {RivalPath::Profile, 0.4}, {RivalPath::Hybrid, 0.3}}),
          test_specimen(1.7, 0.6, {{RivalPath::Constant, 1.9}, {RivalPath::Profile, 0.2}, {RivalPath::Hybrid, 0.2}})};
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
  std::vector<Trial> trials = three_specimens();
  trials[0].rivals[1].cut = cut_with(std::nullopt);
  trials[1].corrected = {};  // refused
  const PathComparison paths = compare_paths(trials);
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
  std::vector<Trial> trials = three_specimens();
  // By its own mean the constant offset would win: it closed on the easiest specimen alone, and lost to the profile
  // there.
  trials[0].rivals[0].cut = cut_with(std::nullopt);
  trials[2].rivals[0].cut = cut_with(std::nullopt);
  trials[1].rivals[0].cut = cut_with(0.25);
  trials[1].rivals[1].cut = cut_with(0.20);
  trials[0].rivals[1].cut = cut_with(0.9);
  EXPECT_EQ(*compare_paths(trials).best_without_simulation, "profile");
  // Where every rival is worse than the planned path, that is what has to be beaten.
  for (Trial& trial : trials) trial.rivals[0].cut = trial.rivals[1].cut = cut_with(2.5);
  EXPECT_EQ(*compare_paths(trials).best_without_simulation, "as_planned");
}

TEST(ComparePaths, ClaimNothingWithoutARival) {
  std::vector<Trial> trials = three_specimens();
  for (Trial& trial : trials) trial.rivals.clear();
  trials.push_back({.name = "outside", .role = TrialRole::Outside});
  const PathComparison paths = compare_paths(trials);
  EXPECT_FALSE(paths.best_without_simulation);
  EXPECT_EQ(claim_of(paths, "incise"), "");
  const RivalJson json = paths_json(paths);
  EXPECT_EQ(json.size(), 2U);
  EXPECT_TRUE(json.at("incise").at("difference_mm").is_null());
  EXPECT_EQ(json.at("as_planned").at("pairs"), 3);
}

}  // namespace
}  // namespace incise::laboratory
