#include <incise/core/error.hpp>
#include <incise/evaluation/t_tests.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace incise {
namespace {

/// Extra hours of sleep with two drugs, the same ten patients [Student1908]; the figures below are those that R's
/// t.test prints for its copy of the data, `sleep`.
const std::vector<double> kFirstDrug{0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0};
const std::vector<double> kSecondDrug{1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};

TEST(TwoTailedP, IsThatOfPrintedTables) {
  EXPECT_NEAR(two_tailed_p(2.04, 30.0), 0.0502, 5e-5);
  EXPECT_NEAR(two_tailed_p(12.706, 1.0), 0.05, 5e-6);  // the 97.5 % quantiles of [Student1908]'s distribution
  EXPECT_NEAR(two_tailed_p(4.303, 2.0), 0.05, 2e-5);
  EXPECT_NEAR(two_tailed_p(-2.228, 10.0), 0.05, 2e-5);
  EXPECT_DOUBLE_EQ(two_tailed_p(0.0, 3.0), 1.0);
}

TEST(WelchTTest, OfTheSleepDataIsAsPublished) {
  const TTest test = welch_t_test(moments_of(kFirstDrug), moments_of(kSecondDrug));
  ASSERT_EQ(test.verdict, TestVerdict::Tested);
  EXPECT_NEAR(test.difference, 1.58, 1e-12);
  EXPECT_NEAR(*test.t, 1.8608, 5e-5);
  EXPECT_NEAR(*test.df, 17.776, 5e-4);
  EXPECT_NEAR(*test.p, 0.07939, 5e-6);
  EXPECT_NEAR(test.confidence->low, -0.2054832, 5e-8);
  EXPECT_NEAR(test.confidence->high, 3.3654832, 5e-8);
}

TEST(StudentTTest, OfTheSleepDataIsAsPublished) {
  const TTest test = student_t_test(moments_of(kFirstDrug), moments_of(kSecondDrug));
  EXPECT_NEAR(*test.t, 1.8608, 5e-5);
  EXPECT_EQ(*test.df, 18.0);
  EXPECT_NEAR(*test.p, 0.07919, 5e-6);
}

TEST(PairedTTest, OfTheSleepDataIsAsPublished) {
  const TTest test = paired_t_test(kFirstDrug, kSecondDrug);
  EXPECT_NEAR(*test.t, 4.0621, 5e-5);
  EXPECT_EQ(*test.df, 9.0);
  EXPECT_NEAR(*test.p, 0.002833, 5e-7);
  EXPECT_NEAR(test.confidence->low, 0.7001142, 5e-8);
  EXPECT_NEAR(test.confidence->high, 2.4598858, 5e-8);
}

/// Miles per gallon of 249 American and 79 Japanese cars: the example of [NistHandbook], 1.3.5.3, which gives mean,
/// standard deviation and T; p and Welch's figures are those that Boost's own example prints for the same numbers.
TEST(StudentTTest, OfTheHandbooksCarsIsAsPublished) {
  const SampleMoments american{.n = 249, .mean = 20.14458, .sd = 6.414700};
  const SampleMoments japanese{.n = 79, .mean = 30.48101, .sd = 6.107710};
  const TTest student = student_t_test(japanese, american);
  EXPECT_NEAR(*student.t, -12.62059, 5e-6);
  EXPECT_EQ(*student.df, 326.0);
  EXPECT_NEAR(*student.p / (2.0 * 2.637e-30), 1.0, 1e-3);
  const TTest welch = welch_t_test(japanese, american);
  EXPECT_NEAR(*welch.t, -12.946, 5e-4);
  EXPECT_NEAR(*welch.df, 136.87, 5e-3);
  EXPECT_NEAR(*welch.p / (2.0 * 7.855e-26), 1.0, 1e-3);
}

/// Two and two values: with f = 1 and f = 2 Student's distribution has closed forms, so that all is by hand.
TEST(TTests, OfTwoAndTwoValuesFollowFromClosedForms) {
  const std::vector<double> before{1.0, 3.0}, after{2.0, 6.0};
  const TTest paired = paired_t_test(before, after);  // differences 1, 3: mean 2, standard error 1
  EXPECT_DOUBLE_EQ(*paired.t, 2.0);
  EXPECT_NEAR(*paired.p, 1.0 - 2.0 / std::numbers::pi * std::atan(2.0), 1e-14);
  const TTest student = student_t_test(moments_of(before), moments_of(after));  // variances 2, 8: standard error √5
  EXPECT_NEAR(*student.t, 2.0 / std::sqrt(5.0), 1e-14);
  EXPECT_NEAR(*student.p, 1.0 - *student.t / std::sqrt(2.0 + *student.t * *student.t), 1e-14);
  const TTest welch = welch_t_test(moments_of(before), moments_of(after));
  EXPECT_NEAR(*welch.df, 25.0 / 17.0, 1e-14);  // (1 + 4)² / (1² + 4²)
  EXPECT_DOUBLE_EQ(*welch.t, *student.t);      // equal counts
}

TEST(TTests, ChangeSignAndNothingElseWhenTheSidesChangePlaces) {
  const TTest forth = welch_t_test(moments_of(kFirstDrug), moments_of(kSecondDrug));
  const TTest back = welch_t_test(moments_of(kSecondDrug), moments_of(kFirstDrug));
  EXPECT_EQ(*forth.t, -*back.t);
  EXPECT_EQ(*forth.p, *back.p);
  EXPECT_DOUBLE_EQ(*forth.df, *back.df);
}

TEST(WelchTTest, OfThePapersSpecimensSeesNoDifference) {
  // Table II: mean errors of S1, S2 before and S3, S4 after; then the third tongue of III-B.4 as well.
  const std::vector<double> before{1.57, 1.91};
  const TTest two = welch_t_test(moments_of(before), moments_of(std::vector<double>{1.37, 1.57}));
  EXPECT_NEAR(*two.t, -1.369, 1e-3);
  EXPECT_NEAR(*two.df, 1.618, 1e-3);
  EXPECT_NEAR(*two.p, 0.33, 5e-3);
  const TTest three = welch_t_test(moments_of(before), moments_of(std::vector<double>{1.37, 1.57, 2.11}));
  EXPECT_NEAR(*three.p, 0.85, 5e-3);
}

TEST(FewestForSignificance, TellsWhatThePapersPValueClaims) {
  // 1.73 ± 0.80 against 1.46 ± 1.09 mm with p < 0.001, by contour point.
  const auto n = fewest_for_significance({0, 1.73, 0.80}, {0, 1.46, 1.09}, 0.001);
  ASSERT_TRUE(n.has_value());
  EXPECT_LT(*student_t_test({*n, 1.73, 0.80}, {*n, 1.46, 1.09}).p, 0.001);
  EXPECT_GE(*student_t_test({*n - 1, 1.73, 0.80}, {*n - 1, 1.46, 1.09}).p, 0.001);
  EXPECT_EQ(*n, 275U);
  EXPECT_FALSE(fewest_for_significance({0, 1.0, 1.0}, {0, 1.0, 1.0}, 0.05).has_value());
}

TEST(FewestForSignificance, IsFoundUpToTenMillionValues) {
  // 2 · (1.959964 / 0.00092)² = 9 077 171; for a difference of 0.00087 it is 10 150 505.
  const auto n = fewest_for_significance({0, 0.0, 1.0}, {0, 0.00092, 1.0}, 0.05);
  ASSERT_TRUE(n.has_value());
  EXPECT_NEAR(static_cast<double>(*n), 9'077'171.0, 10.0);
  EXPECT_LT(*student_t_test({*n, 0.0, 1.0}, {*n, 0.00092, 1.0}).p, 0.05);
  EXPECT_GE(*student_t_test({*n - 1, 0.0, 1.0}, {*n - 1, 0.00092, 1.0}).p, 0.05);
  EXPECT_FALSE(fewest_for_significance({0, 0.0, 1.0}, {0, 0.00087, 1.0}, 0.05).has_value());
}

TEST(TTests, OfOneSpecimenEachSayThatTheyAreTooFew) {
  const SampleMoments one{.n = 1, .mean = 1.7, .sd = 0.0};
  for (const TTest& test : {student_t_test(one, one), welch_t_test(one, one)}) {
    EXPECT_EQ(test.verdict, TestVerdict::TooFew);
    EXPECT_FALSE(test.t || test.p || test.df || test.confidence);
  }
  EXPECT_EQ(paired_t_test(std::vector<double>{1.0}, std::vector<double>{2.0}).verdict, TestVerdict::TooFew);
  EXPECT_EQ(to_string(TestVerdict::TooFew), "too_few");
}

TEST(TTests, OfSamplesWithoutSpreadSaySoInsteadOfDividingByNothing) {
  const std::vector<double> same(5, 0.1 + 0.2);  // sums of it are rounded
  const std::vector<double> other(4, 1.0);
  for (const TTest& test : {student_t_test(moments_of(same), moments_of(other)),
                            welch_t_test(moments_of(same), moments_of(other)), paired_t_test(same, same)}) {
    EXPECT_EQ(test.verdict, TestVerdict::NoSpread);
    EXPECT_FALSE(test.t || test.p || test.confidence);
  }
}

TEST(TTests, RefuseWhatIsNoSample) {
  const SampleMoments good{.n = 3, .mean = 0.0, .sd = 1.0};
  EXPECT_THROW(static_cast<void>(student_t_test({0, 0.0, 1.0}, good)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(welch_t_test(good, {3, 0.0, -1.0})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(welch_t_test(good, {3, std::numeric_limits<double>::infinity(), 1.0})),
               InvalidArgument);
  EXPECT_THROW(static_cast<void>(student_t_test(good, good, 1.0)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(paired_t_test(kFirstDrug, std::vector<double>{1.0})), InvalidArgument);
}

}  // namespace
}  // namespace incise
