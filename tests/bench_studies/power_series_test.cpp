#include "support/counted_entries.hpp"
#include "support/monitors.hpp"

#include <incise/bench_studies/power_series.hpp>
#include <incise/core/error.hpp>

#include <gmock/gmock.h>

namespace incise {
namespace {

using ::testing::ElementsAre;

/// Meshes and steps of a bench that is quick and coarse: numbers of its own, the same order.
PowerRequest coarse() {
  PowerRequest request;
  request.powers_w = {35.0, 25.0};
  request.resolution = {.fine_mm = 3.5, .coarse_mm = 8.0, .way_mm = 1.0};
  request.limits = {.bulge_limit_mm = 20.0, .damage_limit_mm = 1.5};
  return request;
}

PowerSubject drawn(std::uint64_t seed) {
  return {std::to_string(seed), draw_specimen(seed)};
}

TEST(RunPowerSeries, MorePowerBulgesLessAndBurnsFartherAndFinishedCutsAreNotMadeAgain) {
  Monitor silent;
  Workers two(2);
  Cache store;
  PowerRequest request = coarse();
  const PowerSeries series = run_power_series({drawn(2)}, request, store, two, silent);
  ASSERT_EQ(series.cuts.size(), 2U);
  EXPECT_EQ(series.cuts[0].power_w, 35.0);
  EXPECT_EQ(series.cuts[1].specimen, "2");
  EXPECT_LT(series.cuts[0].bulge_mm.value(), series.cuts[1].bulge_mm.value());
  EXPECT_GT(series.cuts[0].thermal_width_mm.value(), series.cuts[1].thermal_width_mm.value());
  EXPECT_EQ(series.made, 2U);
  EXPECT_TRUE(series.choice.chosen_w);
  EXPECT_TRUE(series.speed_cuts.empty());

  // Once more with speeds, on one thread: only the cut at the new speed is made, the others are those of before.
  Workers one(1);
  request.speeds_mm_s = {request.speed_mm_s, 3.0};
  const PowerSeries again = run_power_series({drawn(2)}, request, store, one, silent);
  EXPECT_EQ(again.made, 1U);
  ASSERT_EQ(again.speed_cuts.size(), 2U);
  EXPECT_EQ(again.cuts[0].bulge_mm, series.cuts[0].bulge_mm);
  EXPECT_EQ(again.speed_cuts[0].power_w, series.choice.chosen_w);
  EXPECT_EQ(again.speed_cuts[1].speed_mm_s, 3.0);
  EXPECT_LT(again.speed_cuts[1].bulge_mm.value(), again.speed_cuts[0].bulge_mm.value());

  // One thread gives the bits of two.
  Cache empty;
  request.speeds_mm_s.clear();
  request.powers_w = {35.0};
  EXPECT_EQ(run_power_series({drawn(2)}, request, empty, one, silent).cuts[0].bulge_mm, series.cuts[0].bulge_mm);
}

TEST(RunPowerSeries, StoppedOnRequestItHasKeptWhatWasFinished) {
  testing::StopAfter impatient(150);  // a cut of these has more than 80 steps, two of them more than 160
  Workers one(1);
  testing::Entries kept;
  Cache store(std::make_unique<testing::CountedEntries>(kept));
  EXPECT_THROW((void)run_power_series({drawn(2)}, coarse(), store, one, impatient), Cancelled);
  EXPECT_EQ(kept.bytes.size(), 1U);
}

TEST(PowerCutKey, IsThatOfTheSpecimenPowerSpeedAndMeshNotOfItsName) {
  const auto key = [](const Specimen& specimen, double power_w, double speed_mm_s, const BenchResolution& resolution) {
    return power_cut_key(specimen, resolution, power_w, speed_mm_s).digest();
  };
  const Specimen specimen = draw_specimen(2);
  Specimen softer = specimen;
  softer.youngs_modulus_kpa += 0.1;
  const std::string own = key(specimen, 35.0, 7.0, {});
  EXPECT_EQ(own, key(draw_specimen(2), 35.0, 7.0, {}));
  EXPECT_NE(own, key(softer, 35.0, 7.0, {}));
  EXPECT_NE(own, key(specimen, 30.0, 7.0, {}));
  EXPECT_NE(own, key(specimen, 35.0, 5.0, {}));
  EXPECT_NE(own, key(specimen, 35.0, 7.0, {.fine_mm = 2.0}));
}

TEST(RunPowerSeries, ARingThatStaysOpenIsARowAndNoPowerFits) {
  Monitor silent;
  Workers one(1);
  Cache store;
  PowerSubject tough = drawn(2);
  tough.specimen.toughness_j_m2 = 3000.0;
  PowerRequest request = coarse();
  request.powers_w = {35.0};
  const PowerSeries series = run_power_series({tough}, request, store, one, silent);
  EXPECT_FALSE(series.choice.chosen_w);
  EXPECT_EQ(series.cuts[0].outcome, Outcome::OpenLoop);
  EXPECT_TRUE(series.cuts[0].bulge_mm);
  EXPECT_FALSE(series.cuts[0].mean_abs_error_mm);
  EXPECT_THAT(series.choice.powers[0].reasons, ElementsAre("2: the ring stays open"));
}

TEST(RunPowerSeries, ASpecimenThatIsNoneIsRefused) {
  Monitor silent;
  Workers one(1);
  testing::Entries kept;
  Cache store(std::make_unique<testing::CountedEntries>(kept));
  PowerSubject subject = drawn(2);
  subject.specimen.tumor_position = 0.9;
  EXPECT_THROW((void)run_power_series({subject}, coarse(), store, one, silent), CaseError);
  EXPECT_TRUE(kept.bytes.empty());
}

TEST(ValidatePowerRequest, NamesEveryField) {
  EXPECT_TRUE(validate(PowerRequest{}).empty());
  PowerRequest request{.powers_w = {35.0, 35.0}, .speed_mm_s = 0.0};
  request.limits.bulge_limit_mm = -1.0;
  request.resolution.coarse_mm = 1.0;
  EXPECT_THAT(sentences(validate(request)),
              ElementsAre("speed_mm_s: found 0, expected a number above 0",
                          "bulge_limit_mm: found -1, expected a number above 0",
                          "power_w: found 35 twice, expected every value once",
                          "resolution.coarse_mm: found 1, expected at least fine_mm = 1.1"));
  request = {};
  request.powers_w.clear();
  EXPECT_THAT(sentences(validate(request)), ElementsAre("power_w: found none, expected at least one power"));
}

TEST(RunPowerSeries, RefusesWhatIsNotValidAndSpecimensOfOneName) {
  Monitor silent;
  Workers one(1);
  Cache store;
  EXPECT_THROW((void)run_power_series({}, coarse(), store, one, silent), InvalidArgument);
  EXPECT_THROW((void)run_power_series({drawn(1), drawn(1)}, coarse(), store, one, silent), InvalidArgument);
  PowerRequest none = coarse();
  none.powers_w.clear();
  EXPECT_THROW((void)run_power_series({drawn(1)}, none, store, one, silent), InvalidArgument);
}

}  // namespace
}  // namespace incise
