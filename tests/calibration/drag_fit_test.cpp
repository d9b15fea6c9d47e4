#include "calibration/sectors.hpp"

#include <incise/calibration/drag_fit.hpp>
#include <incise/calibration/identifiability.hpp>
#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/core/random.hpp>
#include <incise/core/units.hpp>

#include <gmock/gmock.h>

#include <cmath>

namespace incise {
namespace {

using testing::angle_of;
using testing::kSectors;

/// A tissue by formula: a mean and two waves that grow with the drag length; a stiffer one is dragged less.
/// @param stiffness_wave  how much of the effect of stiffness differs in shape from that of the drag length
std::vector<double> formula(double drag_mm, double ln_factor, double phase, double stiffness_wave) {
  std::vector<double> profile;
  for (std::size_t i = 0; i < kSectors; ++i) {
    const double a = angle_of(i);
    const double drag = drag_mm * (-0.4 + 0.5 * std::cos(a + phase) + 0.2 * std::sin(2.0 * a));
    profile.push_back(drag * (1.0 - 0.2 * ln_factor) + ln_factor * stiffness_wave * std::cos(3.0 * a));
  }
  return profile;
}

DragResponse response_of(double phase, double stiffness_wave, double second_factor = 2.0) {
  std::vector<SimulatedProfile> profiles;
  for (const double drag : {0.5, 1.5, 2.5, 3.5})
    profiles.push_back({drag, 1.0, formula(drag, 0.0, phase, stiffness_wave)});
  for (const double drag : {0.5, 2.5}) {
    profiles.push_back({drag, second_factor, formula(drag, std::log(second_factor), phase, stiffness_wave)});
  }
  return DragResponse(std::move(profiles));
}

/// Residuals of a sector whose correlation with the one k sectors on is rho^k (the seam of the ring is neglected).
std::vector<double> correlated(Random& random, double sd, double rho) {
  std::vector<double> noise(kSectors);
  double now = random.normal();
  for (double& value : noise) {
    value = sd * now;
    now = rho * now + std::sqrt(1.0 - rho * rho) * random.normal();
  }
  return noise;
}

struct Truth {
  double drag_mm, ln_factor, bias_mm;
};

std::vector<FitSpecimen> photographed(const Truth& truth, Random& random, double sd, double stiffness_wave = 1.0) {
  std::vector<FitSpecimen> specimens;
  for (const double phase : {0.0, 1.1}) {
    std::vector<double> seen = formula(truth.drag_mm, truth.ln_factor, phase, stiffness_wave);
    const std::vector<double> noise = correlated(random, sd, 0.6);
    const double own_bias = 0.1 * random.normal();
    for (std::size_t i = 0; i < kSectors; ++i) seen[i] += truth.bias_mm + own_bias + noise[i];
    specimens.push_back({phase == 0.0 ? "a" : "b", seen, response_of(phase, stiffness_wave), 0.0});
  }
  return specimens;
}

TEST(FitDrag, RecoversDragLengthStiffnessAndBiasFromTwoNoisySpecimens) {
  Random random(7);
  const Truth truth{1.9, 0.3, -0.25};
  const DragFit fit = fit_drag(photographed(truth, random, 0.25));
  EXPECT_NEAR(fit.drag_length_mm.mean, truth.drag_mm, 0.2);
  EXPECT_NEAR(fit.ln_stiffness.mean, truth.ln_factor, 0.2);
  EXPECT_NEAR(fit.bias_mm.mean, truth.bias_mm, 0.25);
  EXPECT_NEAR(fit.residual.sd_mm, 0.25, 0.1);
  EXPECT_GT(fit.residual.correlation_deg, 9.0);  // rho = 0.6 a sector of 10 degrees: 1/e after 20 degrees
  EXPECT_LT(fit.residual.correlation_deg, 45.0);
  EXPECT_LT(fit.residual.n_effective, 25.0);
  EXPECT_GT(fit.residual.n_effective, 4.0);
}

TEST(FitDrag, ItsIntervalsHoldTheTruthAsOftenAsTheySay) {
  Random random(11);
  const int draws = 60;
  std::array<int, 3> held{};
  for (int i = 0; i < draws; ++i) {
    // The truth is drawn from what the fit believes beforehand; else no coverage is promised.
    const Truth truth{random.uniform(0.5, 3.5), 0.5 * random.normal(), 0.5 * random.normal()};
    const DragFit fit = fit_drag(photographed(truth, random, 0.3));
    const auto holds = [](const ParameterEstimate& p, double value) { return p.low <= value && value <= p.high; };
    held[0] += holds(fit.drag_length_mm, truth.drag_mm);
    held[1] += holds(fit.ln_stiffness, truth.ln_factor);
    held[2] += holds(fit.bias_mm, truth.bias_mm);
  }
  // 90 % of 60 are 54; three standard deviations of that count are 7.
  for (const int count : held) EXPECT_GE(count, 47);
}

/// The response with the grain of a mesh: every simulated sector is off by itself.
DragResponse grainy_response(double phase, Random& random, double grain_mm) {
  std::vector<SimulatedProfile> profiles;
  for (const double drag : {0.5, 1.5, 2.5, 3.5}) profiles.push_back({drag, 1.0, formula(drag, 0.0, phase, 1.0)});
  for (const double drag : {0.5, 2.5}) profiles.push_back({drag, 2.0, formula(drag, std::log(2.0), phase, 1.0)});
  for (SimulatedProfile& profile : profiles) {
    for (double& e : profile.signed_error_mm) e += grain_mm * random.normal();
  }
  return DragResponse(std::move(profiles));
}

TEST(FitDrag, TakesTheMeshsGrainForNoiseOfItsOwn) {
  // Far more grain than anything else: without its variance 24 of these 60 intervals hold the truth, with it 43. That
  // is still fewer than 90 %: the grain in the slope by stiffness is not counted.
  Random random(23);
  const int draws = 60;
  int held = 0;
  for (int i = 0; i < draws; ++i) {
    const Truth truth{random.uniform(0.5, 3.5), 0.0, 0.0};
    std::vector<FitSpecimen> specimens = photographed(truth, random, 0.1);
    for (std::size_t s = 0; s < 2; ++s) specimens[s].response = grainy_response(s == 0 ? 0.0 : 1.1, random, 0.5);
    EXPECT_NEAR(specimens[0].response.grain_mm(), 0.5, 0.2);  // of 32 numbers
    const ParameterEstimate drag = fit_drag(specimens).drag_length_mm;
    held += drag.low <= truth.drag_mm && truth.drag_mm <= drag.high;
  }
  EXPECT_GE(held, 36);
}

TEST(FitDrag, CountsNeighbouringSectorsForLessThanIndependentOnes) {
  // The same size of residual, once correlated over 20 degrees and once not at all: only the second pins the mean down.
  Random random(3);
  std::vector<FitSpecimen> rough = photographed({2.0, 0.0, 0.0}, random, 0.0);
  std::vector<FitSpecimen> smooth = rough;
  for (std::size_t s = 0; s < 2; ++s) {
    const std::vector<double> independent = correlated(random, 0.4, 0.0);
    const std::vector<double> slow = correlated(random, 0.4, 0.9);
    for (std::size_t i = 0; i < kSectors; ++i) {
      rough[s].signed_error_mm[i] += independent[i];
      smooth[s].signed_error_mm[i] += slow[i];
    }
  }
  EXPECT_GT(fit_drag(rough).residual.n_effective, 2.0 * fit_drag(smooth).residual.n_effective);
}

TEST(FitDrag, SamplesHaveTheMomentsOfThePosterior) {
  Random random(5);
  const DragFit fit = fit_drag(photographed({1.9, 0.3, -0.25}, random, 0.3));
  ASSERT_EQ(fit.samples.size(), 64U);
  double weight = 0.0, drag = 0.0, bias = 0.0;
  for (const PosteriorSample& sample : fit.samples) {
    weight += sample.weight;
    drag += sample.weight * sample.drag_length_mm;
    bias += sample.weight * sample.bias_mm;
  }
  EXPECT_NEAR(weight, 1.0, 1e-12);
  EXPECT_NEAR(drag, fit.drag_length_mm.mean, 0.15 * fit.drag_length_mm.sd);
  EXPECT_NEAR(bias, fit.bias_mm.mean, 0.3 * fit.bias_mm.sd);
}

TEST(FitDrag, KeepsToTheDragLengthsThatAllSpecimensWereCutWith) {
  Random random(5);
  std::vector<FitSpecimen> specimens = photographed({1.9, 0.0, 0.0}, random, 0.2);
  specimens[1].response =
      DragResponse({{1.0, 1.0, formula(1.0, 0.0, 1.1, 1.0)}, {2.0, 1.0, formula(2.0, 0.0, 1.1, 1.0)}});
  const DragFit fit = fit_drag(specimens);
  EXPECT_EQ(fit.drag_length_mm.grid.front(), 1.0);
  EXPECT_EQ(fit.drag_length_mm.grid.back(), 2.0);
  EXPECT_FALSE(fit.knows_stiffness);
  specimens[1].response =
      DragResponse({{4.0, 1.0, formula(4.0, 0.0, 1.1, 1.0)}, {5.0, 1.0, formula(5.0, 0.0, 1.1, 1.0)}});
  EXPECT_THROW(static_cast<void>(fit_drag(specimens)), InvalidArgument);
}

TEST(Identifiability, FlipsWithWhatTheDataCanTell) {
  Random random(9);
  // Stiffness with a shape of its own is identified; one that only scales the drag is tied to the drag length.
  const Identifiability told = identifiability(fit_drag(photographed({2.0, 0.2, 0.0}, random, 0.2, 1.0)));
  EXPECT_EQ(told.parameters[0].told, Identified::Apart);
  EXPECT_EQ(told.parameters[1].told, Identified::Apart);
  const Identifiability tied = identifiability(fit_drag(photographed({2.0, 0.2, 0.0}, random, 0.2, 0.0)));
  EXPECT_NE(tied.parameters[1].told, Identified::Apart);
  EXPECT_EQ(tied.parameters[1].tied_to, "drag_length");
  EXPECT_GT(tied.parameters[1].correlation, 0.7);
  EXPECT_THAT(tied.sentences[1], ::testing::HasSubstr("with the drag length"));
  EXPECT_THAT(tied.sentences[1], ::testing::Not(::testing::HasSubstr("is identified by the data")));
}

TEST(Identifiability, SaysWhenTheIntervalEndsWhereTheSimulationsEnd) {
  Random random(9);
  const Identifiability beyond = identifiability(fit_drag(photographed({4.5, 0.0, 0.0}, random, 0.2)));
  EXPECT_TRUE(beyond.parameters[0].is_at_limit);
  EXPECT_THAT(beyond.sentences[0], ::testing::HasSubstr("may lie beyond"));
  EXPECT_FALSE(identifiability(fit_drag(photographed({2.0, 0.0, 0.0}, random, 0.2))).parameters[0].is_at_limit);
}

TEST(FitDrag, RefusesSettingsAndProfilesThatDoNotFit) {
  Random random(1);
  std::vector<FitSpecimen> specimens = photographed({2.0, 0.0, 0.0}, random, 0.2);
  DragFitSettings settings{.bias_sd_mm = 0.0};
  EXPECT_THAT(sentences(problems_of(settings)), ::testing::ElementsAre(::testing::HasSubstr("bias_sd_mm")));
  EXPECT_THROW(static_cast<void>(fit_drag(specimens, settings)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(fit_drag({})), InvalidArgument);
  specimens[0].signed_error_mm.pop_back();
  EXPECT_THROW(static_cast<void>(fit_drag(specimens)), InvalidArgument);
}

}  // namespace
}  // namespace incise
