#include <incise/core/error.hpp>
#include <incise/workflow/assess.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace incise {
namespace {

/// Two standard deviations of 0.2 mm and 0.5 about 1.5 mm and the reference, not correlated.
TissueScenarios cross() {
  TissueScenarios tissues;
  for (const auto& [drag, ln_stiffness] :
       {std::pair{0.0, 0.0}, std::pair{-0.3, 0.0}, std::pair{0.3, 0.0}, std::pair{0.0, -0.8}, std::pair{0.0, 0.8}}) {
    tissues.points.push_back({0.2, 1.5 + drag, std::exp(ln_stiffness), 0.1 + drag});
  }
  tissues.drag_length_sd_mm = 0.2;
  tissues.ln_stiffness_sd = 0.5;
  tissues.bias_sd_mm = 0.35;
  return tissues;
}

TEST(SensitivityOf, IsTheSlopeOfTheSimulatedErrorTimesTheSpread) {
  // At the first waypoint 2 mm per mm of drag length, at the second none; 0.4 mm per unit of ln stiffness, and its
  // negative.
  const TissueScenarios tissues = cross();
  std::vector<std::vector<double>> errors;
  for (const TissueScenario& t : tissues.points) {
    const double drag = t.drag_length_mm - 1.5;
    const double stiffness = std::log(t.stiffness_factor);
    errors.push_back({-1.0 + 2.0 * drag + 0.4 * stiffness + t.bias_mm, 0.3 - 0.4 * stiffness + t.bias_mm});
  }
  const std::vector<ParameterSensitivity> found = sensitivity_of(tissues, errors);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].name, "drag_length_mm");
  EXPECT_NEAR(found[0].change_mm, 0.4 / std::sqrt(2.0), 1e-9)
      << "the bias that goes with a drag length is not simulated";
  EXPECT_NEAR(found[0].mean_change_mm, 0.2, 1e-9);
  EXPECT_NEAR(found[1].change_mm, 0.2, 1e-9);
  EXPECT_NEAR(found[1].mean_change_mm, 0.0, 1e-9);
  EXPECT_EQ(found[2].change_mm, 0.35);
}

TEST(SensitivityOf, IsNotToldWhereARingStayedOpen) {
  std::vector<std::vector<double>> errors(5, {0.0, 0.1});
  errors[3].clear();
  EXPECT_TRUE(sensitivity_of(cross(), errors).empty());
  EXPECT_THROW(static_cast<void>(sensitivity_of(cross(), {})), InvalidArgument);
}

TEST(ByVirtualCalibration, ARealSpecimenIsAtBestCutAsPlanned) {
  Eligibility judged;
  judged.advice = Advice::Compensate;
  judged.reasons = {"the expected gain is 1.20 ± 0.30 mm"};
  judged.p_worse = 0.02;
  const Eligibility found = by_virtual_calibration(judged);
  EXPECT_EQ(found.advice, Advice::CutAsPlanned);
  EXPECT_EQ(found.reasons, std::vector<std::string>{kVirtualCalibration});
  EXPECT_EQ(found.p_worse, 0.02);
  judged.advice = Advice::DoNotUse;
  judged.reasons = {"the registration was refused"};
  EXPECT_EQ(by_virtual_calibration(judged).advice, Advice::DoNotUse);
  EXPECT_EQ(by_virtual_calibration(judged).reasons,
            (std::vector<std::string>{"the registration was refused", kVirtualCalibration}));
}

TEST(StretchMm, IsTheFarthestOfWhatPulls) {
  TissueModel model;
  EXPECT_EQ(stretch_mm(model), 0.0);
  model.constraints = {FixedConstraint{}, DisplacedConstraint{EndRegion{}, Vec3(3.0, 4.0, 0.0)},
                       DisplacedConstraint{EndRegion{}, Vec3(0.0, 0.0, 1.0)}};
  EXPECT_EQ(stretch_mm(model), 5.0);
}

}  // namespace
}  // namespace incise
