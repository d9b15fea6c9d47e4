#include <incise/core/expect.hpp>
#include <incise/second_bench/specimen.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

namespace incise::second_bench {
namespace {

TEST(SecondSpecimen, EveryParameterSaysSpreadSourceAndReadingAndIsListedOnce) {
  std::set<std::string_view> names;
  for (const Parameter& parameter : parameters()) {
    EXPECT_TRUE(names.insert(parameter.name).second) << parameter.name;
    EXPECT_FALSE(parameter.meaning.empty() || parameter.source.empty() || parameter.shows_in.empty()) << parameter.name;
    EXPECT_LT(parameter.low, parameter.high) << parameter.name;
  }
  // Every number of a specimen is in the list: seeds aside, the struct holds nothing but doubles.
  EXPECT_EQ(sizeof(Specimen), 2 * sizeof(std::uint64_t) + names.size() * sizeof(double));
}

/// Of what decides how specimens are drawn and prescribed: names, kinds of spread, numbers, factors; not of words.
std::uint64_t fingerprint_of_spreads() {
  std::string text;
  const Specimen still;
  for (const Parameter& p : parameters()) {
    text += fmt::format("{} {} {} {} {} {} {} {}\n", p.name, to_string(p.drawn_as), p.a, p.b, p.low, p.high,
                        p.factor ? to_string(*p.factor) : "always", still.*p.member);
  }
  for (const double speed : {2.0, 7.0, 12.0}) {
    Specimen asked;
    asked.speed_mm_s = speed;
    text += fmt::format("{}\n", prescribed_power_w(asked));
  }
  return stream_of(0, text);
}

// The laboratory was accepted as it is, before any planner but the paper's was run on it, and is not touched again:
// whoever changes a spread makes every figure measured on it void (docs/models/second_bench.md, Frozen).
TEST(SecondSpecimen, SpreadsAreThoseThatWereFrozen) {
  EXPECT_EQ(fingerprint_of_spreads(), 7319302856234789267ULL);
}

TEST(SecondSpecimen, DrawsKeepToTheirLimitsAndDefaultsAreValid) {
  EXPECT_THAT(problems_of(Specimen{}), testing::IsEmpty());
  for (std::uint64_t seed = 0; seed < 200; ++seed)
    EXPECT_THAT(problems_of(draw_specimen(seed, seed, all_factors())), testing::IsEmpty()) << seed;
}

TEST(SecondSpecimen, WhatIsHeldStillStaysAtItsDefaultAndMovesNothingElse) {
  const Specimen all = draw_specimen(7, 3, all_factors());
  const Specimen none = draw_specimen(7, 3, {});
  for (std::size_t n = 0; n < kFactorNames.size(); ++n) {
    const auto factor = static_cast<Factor>(n);
    Factors others = all_factors();
    others.erase(factor);
    const Specimen without = draw_specimen(7, 3, others);
    std::size_t held = 0;
    for (const Parameter& parameter : parameters()) {
      const bool is_of_it = parameter.factor == factor;
      if (is_of_it) ++held;
      EXPECT_EQ(without.*parameter.member, is_of_it ? Specimen{}.*parameter.member : all.*parameter.member)
          << parameter.name;
      if (parameter.factor) {
        EXPECT_EQ(none.*parameter.member, Specimen{}.*parameter.member) << parameter.name;
      }
    }
    EXPECT_GT(held, 0U) << to_string(factor);
  }
}

TEST(SecondSpecimen, SpecimensOfASeriesShareTheHandEyeErrorAndNothingElse) {
  const Specimen a = draw_specimen(1, 9, all_factors()), b = draw_specimen(2, 9, all_factors());
  for (const Parameter& parameter : parameters()) {
    const bool is_shared = parameter.factor == Factor::HandEye;
    EXPECT_EQ(a.*parameter.member == b.*parameter.member, is_shared) << parameter.name;
  }
  EXPECT_NE(a.hand_eye_x_mm, draw_specimen(1, 10, all_factors()).hand_eye_x_mm);
}

// The paper's cut gets the paper's power.
TEST(SecondSpecimen, PowerIsPrescribedByDepthAndSpeed) {
  Specimen specimen;
  EXPECT_DOUBLE_EQ(prescribed_power_w(specimen), 35.0);
  specimen.speed_mm_s = 12.0;
  specimen.depth_mm = 8.0;
  EXPECT_NEAR(prescribed_power_w(specimen), 15.0 + 20.0 * 96.0 / 35.0, 1e-12);
  specimen.speed_mm_s = 1.0;
  specimen.depth_mm = 2.0;
  EXPECT_DOUBLE_EQ(prescribed_power_w(specimen), 20.0);
}

}  // namespace
}  // namespace incise::second_bench
