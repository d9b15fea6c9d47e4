#include <incise/workflow/assess.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

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
