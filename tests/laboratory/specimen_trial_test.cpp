#include "laboratory/specimen_trial.hpp"

#include "support/temporary_folder.hpp"

#include <incise/core/monitor.hpp>
#include <incise/core/workers.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

namespace incise::laboratory {
namespace {

/// Has no specimen: what is written before one is needed is looked at.
class NoLaboratory : public Laboratory {
 public:
  StepAnswer take_readings(const std::filesystem::path&) override { return {}; }
  StepAnswer cut(const std::filesystem::path&, double, const std::filesystem::path&, const std::string&) override {
    return {};
  }
};

/// The text of a case of a specimen whose planner cuts by a rule.
std::string case_text(CutRule rule, const std::optional<ChosenTool>& tool) {
  const testing::TemporaryFolder folder;
  Workers workers(1);
  Monitor silent;
  ExperimentSteps steps(folder.path() / "S1", workers, silent);
  NoLaboratory laboratory;
  const SpecimenTrial trial({.name = "S1", .rule = rule}, steps, laboratory);
  std::ifstream stream(trial.write_variant("case.yaml", {tool, 12.0, {}}));
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(SpecimenTrial, ACaseNamesTheRuleOfThePlannersCuts) {
  const ChosenTool tool{.speed_mm_s = 13.0, .dullness = 4.0};
  using ::testing::HasSubstr;
  EXPECT_THAT(case_text(CutRule::Lattice, {}), HasSubstr("\ncut: {rule: lattice}\n"));
  EXPECT_THAT(case_text(CutRule::Lattice, tool), HasSubstr("\ncut: {rule: lattice, speed_mm_s: 13, dullness: 4}\n"));
  EXPECT_THAT(case_text(CutRule::Tets, tool), HasSubstr("\ncut: {speed_mm_s: 13, dullness: 4}\n"));
  EXPECT_THAT(case_text(CutRule::Tets, {}), ::testing::Not(HasSubstr("cut:")));
}

TEST(SpecimenTrial, ACaseSaysWhatItsMethodReads) {
  const testing::TemporaryFolder folder;
  Workers workers(1);
  Monitor silent;
  ExperimentSteps steps(folder.path() / "S1", workers, silent);
  NoLaboratory laboratory;
  const SpecimenTrial trial({.name = "S1"}, steps, laboratory);
  const auto text = [&trial](const CompensationChoice& choice) {
    std::ifstream stream(trial.write_variant("case.yaml", {{}, 12.0, choice}));
    return std::string{std::istreambuf_iterator<char>(stream), {}};
  };
  using ::testing::HasSubstr;
  EXPECT_THAT(text(calibrated_choice({.bias_mm = 0.25})),
              HasSubstr("\ncompensation: {observable: inner_edge, bias_mm: 0.25}\n"));
  EXPECT_THAT(text({.observable = ContourKind::InnerEdge, .simulated_share = 0.75, .residual_mm = {0.5}}),
              HasSubstr("{observable: inner_edge, bias_mm: 0, simulated_share: 0.75, residual_mm: [0.5]}\n"));
  EXPECT_THAT(text({.method = CompensationMethod::Paper}), HasSubstr("\ncompensation: {method: paper}\n"));
  EXPECT_THAT(text({.method = CompensationMethod::Profile, .photographed_mm = {-1.5, 0.25}}),
              HasSubstr("\ncompensation: {method: profile, photographed_mm: [-1.5, 0.25]}\n"));
}

}  // namespace
}  // namespace incise::laboratory
