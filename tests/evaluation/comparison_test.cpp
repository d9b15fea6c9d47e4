#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/evaluation/comparison.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace incise {
namespace {

/// Errors that alternate about a mean, so that the mean, and that of the absolute values, are exact.
MeasuredSpecimen specimen(const char* name, double mean, double swing, std::size_t pairs = 100) {
  MeasuredSpecimen result{.name = name, .signed_error_mm = {}};
  for (std::size_t i = 0; i < pairs; ++i) {
    result.signed_error_mm.push_back(mean + swing);
    result.signed_error_mm.push_back(mean - swing);
  }
  return result;
}

const std::vector<MeasuredSpecimen> kBefore{specimen("s1", 1.57, 0.5), specimen("s2", 1.91, 0.5)};
const std::vector<MeasuredSpecimen> kAfter{specimen("s3", 1.37, 0.5), specimen("s4", 1.57, 0.5)};

TEST(Compare, FindsThePapersGapBetweenPointsAndSpecimens) {
  const Comparison found = compare(kBefore, kAfter);
  EXPECT_NEAR(found.points.before.mean, 1.74, 1e-12);
  EXPECT_NEAR(found.points.after.mean, 1.47, 1e-12);
  EXPECT_LT(*found.points.student.p, 0.001);
  EXPECT_NEAR(*found.specimens.main().p, 0.33, 5e-3);
  EXPECT_NEAR(*found.specimens.main().df, 1.618, 1e-3);
  EXPECT_EQ(found.points.student.df, 798.0);
}

TEST(Compare, SaysHowManySpecimensWouldShowTheEffect) {
  const Comparison found = compare(kBefore, kAfter);
  ASSERT_TRUE(found.specimens.effect && found.specimens.fewest);
  EXPECT_NEAR(found.specimens.effect->hedges_g, -1.3689 / std::sqrt(std::acos(-1.0)), 1e-3);
  EXPECT_LT(found.specimens.effect->confidence.low, 0.0);
  EXPECT_GT(found.specimens.effect->confidence.high, 0.0);
  EXPECT_EQ(found.specimens.fewest, fewest_specimens(found.specimens.effect->hedges_g, TestDesign::Unpaired));
}

TEST(Compare, TakesPairsAsPairs) {
  const Comparison found = compare(kBefore, kAfter, {.is_paired = true});
  ASSERT_TRUE(found.specimens.paired.has_value());
  EXPECT_EQ(found.specimens.main().df, 1.0);
  EXPECT_NEAR(*found.specimens.main().t, -0.27 / 0.07, 1e-9);  // differences −0.20 and −0.34
  EXPECT_FALSE(compare(kBefore, kAfter).specimens.paired.has_value());
}

TEST(Compare, TellsAbsoluteFromSignedErrors) {
  const std::vector<MeasuredSpecimen> inside{specimen("a", -1.0, 0.25), specimen("b", -1.2, 0.25)};
  const std::vector<MeasuredSpecimen> outside{specimen("c", 1.0, 0.25), specimen("d", 1.2, 0.25)};
  EXPECT_NEAR(compare(inside, outside).points.student.difference, 0.0, 1e-12);
  EXPECT_NEAR(compare(inside, outside, {.measure = ErrorMeasure::Signed}).points.student.difference, 2.2, 1e-12);
}

TEST(Compare, OfOneSpecimenEachTestsPointsAndSaysThatSpecimensAreTooFew) {
  const Comparison found = compare(std::span(kBefore).first(1), std::span(kAfter).first(1));
  EXPECT_EQ(found.points.student.verdict, TestVerdict::Tested);
  EXPECT_EQ(found.specimens.main().verdict, TestVerdict::TooFew);
  EXPECT_FALSE(found.specimens.effect || found.specimens.fewest || found.specimens.main().p);
}

TEST(Compare, OfIdenticalSpecimensHasNoSpreadToTestBy) {
  const std::vector<MeasuredSpecimen> same{specimen("a", 1.0, 0.0), specimen("b", 1.0, 0.0)};
  const Comparison found = compare(same, same);
  EXPECT_EQ(found.points.student.verdict, TestVerdict::NoSpread);
  EXPECT_EQ(found.points.bootstrap.verdict, TestVerdict::NoSpread);
  EXPECT_EQ(found.specimens.main().verdict, TestVerdict::NoSpread);
  EXPECT_FALSE(found.specimens.main().p || found.specimens.fewest);
}

TEST(Compare, RefusesWhatCannotBeCompared) {
  EXPECT_THROW(static_cast<void>(compare({}, kAfter)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(compare(kBefore, std::span(kAfter).first(1), {.is_paired = true})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(compare(kBefore, kAfter, {.alpha = 0.0})), InvalidArgument);
  const std::vector<MeasuredSpecimen> few{{.name = "few", .signed_error_mm = {1.0, 2.0}}};
  EXPECT_THROW(static_cast<void>(compare(few, kAfter)), InvalidArgument);
}

}  // namespace
}  // namespace incise
