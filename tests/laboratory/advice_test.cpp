#include "laboratory/experiment_advice.hpp"
#include "laboratory/outside_range.hpp"
#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/io/json_file.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace incise::laboratory {
namespace {

using ::incise::testing::TemporaryFolder;
using AdviceJson = nlohmann::ordered_json;

/// Specimens by hand: what was advised, and what the bench knows of both cuts.
class ByHand {
 public:
  /// @param planned_mm, corrected_mm  true mean errors; absent: the ring stayed open.
  Trial& add(TrialRole role, std::optional<double> p_worse, std::optional<double> planned_mm,
             std::optional<double> corrected_mm) {
    Trial trial{.name = "S" + std::to_string(trials.size() + 1), .role = role};
    trial.assessment = {{"advice", "compensate"},  {"p_worse", p_worse ? AdviceJson(*p_worse) : AdviceJson()},
                        {"p_worse_if_alike", 0.1}, {"p_worse_if_unlike", 0.2},
                        {"p_unlike", 0.3},         {"p_close_margin", {{"intended", 0.9}, {"corrected", 0.1}}}};
    trials.push_back(trial);
    cut(trials.back(), trials.back().planned, "planned", planned_mm);
    cut(trials.back(), trials.back().corrected, "corrected", corrected_mm);
    return trials.back();
  }
  void cut(const Trial& trial, TrialCut& made, const std::string& name, std::optional<double> error_mm) {
    made.is_made = true;
    AdviceJson truth{{"note", "by hand"}, {"target_mm", target_mm}};
    if (error_mm) truth.update({{"mean_abs_error_mm", *error_mm}, {"signed_errors_mm", {-*error_mm, -*error_mm}}});
    std::filesystem::create_directories(folder / (trial.name + "_" + name));
    std::ofstream(folder / (trial.name + "_" + name) / "cut_truth.json") << truth;
  }
  [[nodiscard]] AdviceJson advice() const { return hold_advice_against_truth(trials, folder.path()); }

  TemporaryFolder folder;
  std::vector<Trial> trials;
  double target_mm = 4.5;  ///< of the cuts that are added next
};

TEST(HoldAdviceAgainstTruth, TakesItsLabelsFromTheTruthAndAnUnstatedProbabilityForOneHalf) {
  ByHand hand;
  hand.add(TrialRole::Calibrate, 0.9, 1.0, 0.1);
  hand.add(TrialRole::Test, 0.1, 1.0, 0.4);
  hand.add(TrialRole::Test, 0.6, 1.0, 0.4);                       // feared in vain
  hand.add(TrialRole::Outside, 0.7, 1.0, 1.2);                    // worse
  hand.add(TrialRole::Outside, std::nullopt, 1.0, 1.1);           // worse, not stated: below the 0.6, above the 0.1
  hand.add(TrialRole::Outside, 0.3, 0.8, std::nullopt);           // opened: worse
  hand.add(TrialRole::Outside, 0.2, std::nullopt, 0.8);           // closed by the correction: better
  hand.add(TrialRole::Outside, 0.9, std::nullopt, std::nullopt);  // tells nothing
  const AdviceJson advice = hand.advice();
  EXPECT_EQ(advice.at("advised"), 7);
  EXPECT_EQ(advice.at("worse"), 3);
  EXPECT_EQ(advice.at("auc").at("worse"), 3);
  EXPECT_EQ(advice.at("auc").at("not_worse"), 3);
  // Pairs won: 0.7 over all three, 0.5 over 0.1 and 0.2, 0.3 over 0.1 and 0.2.
  EXPECT_DOUBLE_EQ(advice.at("auc").at("area"), 7.0 / 9.0);
  EXPECT_DOUBLE_EQ(advice.at("auc_outside_alone").at("area"), 1.0);
  EXPECT_DOUBLE_EQ(advice.at("auc_of").at("p_unlike").at("area"), 0.5) << "the same of all";
  EXPECT_TRUE(advice.at("auc_without_pull").is_null());
  EXPECT_TRUE(advice.at("specimens").at(6).at("is_worse").is_null());
}

TEST(HoldAdviceAgainstTruth, AsksWhatWasCutWithoutThePullOfItsOwnCuts) {
  ByHand hand;
  for (const double p : {0.1, 0.4}) {
    Trial& trial = hand.add(TrialRole::Test, 0.5, 1.0, 0.4);
    trial.assessment_without_pull = {{"advice", "compensate"}, {"p_worse", p}};
    hand.cut(trial, trial.withheld, "withheld", p > 0.2 ? 1.3 : 0.5);
  }
  const AdviceJson advice = hand.advice();
  EXPECT_TRUE(advice.at("auc").is_null()) << "nobody was worse";
  EXPECT_DOUBLE_EQ(advice.at("auc_without_pull").at("area"), 1.0);
  EXPECT_EQ(advice.at("specimens").at(1).at("is_worse_without_pull"), true);
}

TEST(HoldAdviceAgainstTruth, CountsCloseMarginsOfClosedRings) {
  ByHand hand;
  hand.add(TrialRole::Test, 0.1, 2.5, 0.4);           // 4.5 - 2.5 mm is below 2.2 mm
  hand.add(TrialRole::Test, 0.1, 2.0, std::nullopt);  // 2.5 mm is not
  hand.target_mm = 2.6;
  hand.add(TrialRole::Test, 0.1, 0.5, std::nullopt);  // its surgeon asked for less: 2.1 mm is
  const AdviceJson margin = hand.advice().at("close_margin");
  EXPECT_EQ(margin.at("cuts"), 4);
  EXPECT_NEAR(margin.at("brier_score"), (0.1 * 0.1 + 0.9 * 0.9 + 0.1 * 0.1 + 0.1 * 0.1) / 4.0, 1e-12);
}

TEST(HoldAdviceAgainstTruth, CountsHowOftenIntervalsHoldWhatPhotographsShow) {
  ByHand hand;
  const auto photographed = [](TrialCut& cut, double mean_mm) {
    cut.measured = MeasuredCut{"", {{"abs_error_mm", {{"mean", mean_mm}}}}};
  };
  for (const double corrected_mm : {0.3, 0.5, 0.9}) {
    Trial& trial = hand.add(TrialRole::Test, 0.1, 1.5, 0.4);
    photographed(trial.planned, 1.4);
    photographed(trial.corrected, corrected_mm);
    trial.assessment["intended"] = {{"abs_error_80_mm", {1.0, 1.6}}, {"abs_error_95_mm", {0.8, 1.8}}};
    trial.assessment["corrected"] = {{"abs_error_80_mm", {0.4, 0.8}}, {"abs_error_95_mm", {0.2, 0.95}}};
    trial.assessment["expected_gain_mm"] = {{"middle_80", {1.0, 1.2}}, {"middle_95", nullptr}};
  }
  hand.add(TrialRole::Test, 0.1, 1.5, 0.4);  // not measured, not foretold
  std::map<std::pair<std::string, double>, std::pair<int, int>> found;
  const AdviceJson advice = hand.advice();
  for (const AdviceJson& one : advice.at("intervals"))
    found[{one.at("of"), one.at("level")}] = {one.at("held"), one.at("cuts")};
  EXPECT_EQ((found[{"planned", 0.80}]), std::pair(3, 3));
  EXPECT_EQ((found[{"corrected", 0.80}]), std::pair(1, 3));
  EXPECT_EQ((found[{"corrected", 0.95}]), std::pair(3, 3));
  EXPECT_EQ((found[{"gain", 0.80}]), std::pair(1, 3)) << "1.1, 0.9 and 0.5 mm";
  EXPECT_FALSE(found.contains({"gain", 0.95})) << "it was not foretold";
}

TEST(HoldAdviceAgainstTruth, LeavesOutWhatWasNotCutTwiceOrNotAdvisedOn) {
  ByHand hand;
  EXPECT_TRUE(hand.advice().is_null());
  hand.add(TrialRole::Test, 0.1, 1.0, 0.4);
  Trial& refused = hand.add(TrialRole::Outside, 0.1, 1.0, 0.4);
  refused.corrected.is_made = false;  // its file is of an earlier run
  refused.corrected.ended_at = "export";
  hand.add(TrialRole::Outside, 0.1, 1.0, 0.4).assessment = nullptr;
  const AdviceJson advice = hand.advice();
  EXPECT_EQ(advice.at("advised"), 1);
  ASSERT_EQ(advice.at("skipped").size(), 2);
  EXPECT_EQ(advice.at("skipped").at(0).at("ended_at"), AdviceJson({"export"}));
}

TEST(HoldAdviceAgainstTruth, RefusesATruthThatIsCutOff) {
  ByHand hand;
  const Trial& trial = hand.add(TrialRole::Test, 0.1, 1.0, 0.4);
  std::ofstream(hand.folder / (trial.name + "_planned") / "cut_truth.json") << "{\"mean_abs";
  EXPECT_THROW(static_cast<void>(hand.advice()), DataError);
}

TEST(TableTwo, ARegistrationThatWasRefusedHasNoResidual) {
  Trial trial{.ended_at = "register"};
  EXPECT_TRUE(table_2_json({trial}).at(0).at("registration_rmse_mm").is_null());
  trial.registration_rmse_mm = 0.4;
  EXPECT_EQ(table_2_json({trial}).at(0).at("registration_rmse_mm"), 0.4);
}

TEST(OutsideSpecimen, EachKindIsWhatItsNameSays) {
  const std::vector<std::string> names{"stiff", "oedematous", "scarred", "oedematous", "soft"};
  const std::map<std::string, std::pair<double, double>> kpa{
      {"stiff", {25.0, 60.0}}, {"oedematous", {3.0, 3.7}}, {"scarred", {28.0, 38.0}}, {"soft", {4.5, 7.0}}};
  for (std::uint64_t i = 0; i < 100; ++i) {
    const OutsideKind kind = outside_specimen(1000 + i, i);
    ASSERT_EQ(kind.name, names[i % 5]);
    const std::map<std::string, double> given(kind.given.begin(), kind.given.end());
    EXPECT_GE(given.at("youngs_modulus_kpa"), kpa.at(kind.name).first);
    EXPECT_LE(given.at("youngs_modulus_kpa"), kpa.at(kind.name).second);
    const bool is_hardly_dragged = kind.name == "oedematous" || kind.name == "scarred";
    ASSERT_EQ(given.size(), is_hardly_dragged ? 6 : 1) << kind.name;
    if (!is_hardly_dragged) continue;
    EXPECT_LE(given.at("adhesion_kpa_s_mm2"), 3.0);
    EXPECT_GE(given.at("tumor_depth_mm"), 6.0);
    EXPECT_EQ(given.at("toughness_j_m2") >= 850.0, kind.name == "scarred");
  }
  EXPECT_NE(outside_specimen(1, 0).given, outside_specimen(2, 0).given) << "drawn from the seed";
  EXPECT_EQ(outside_specimen(1, 0).given, outside_specimen(1, 5).given);
}

}  // namespace
}  // namespace incise::laboratory
