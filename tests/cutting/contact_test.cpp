#include <incise/core/random.hpp>
#include <incise/cutting/carving.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace incise {
namespace {

const std::array<Vec3, 4> kUnitTet{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};

TEST(DistanceToSegment, IsZeroWhereTheSegmentPassesThroughTheTet) {
  EXPECT_EQ(distance_to_segment(kUnitTet, {0.2, 0.2, -1}, {0.2, 0.2, 1}), 0.0);
}

TEST(DistanceToSegment, IsZeroForASegmentWhollyInsideTheTet) {
  EXPECT_EQ(distance_to_segment(kUnitTet, {0.2, 0.2, 0.2}, {0.25, 0.2, 0.2}), 0.0);
}

TEST(DistanceToSegment, ToAFaceIsTheHeightAboveIt) {
  EXPECT_NEAR(distance_to_segment(kUnitTet, {0.2, 0.2, -3}, {0.2, 0.2, -0.5}), 0.5, 1e-15);
}

TEST(DistanceToSegment, ToAnEdgeIsTakenBetweenTheLines) {
  EXPECT_NEAR(distance_to_segment(kUnitTet, {0.5, -1, -1}, {0.5, -1, 1}), 1.0, 1e-15);
}

TEST(DistanceToSegment, ToACornerIsTakenFromTheSegmentsEnd) {
  EXPECT_NEAR(distance_to_segment(kUnitTet, {-3, -4, 0}, {-6, -8, 0}), 5.0, 1e-15);
}

TEST(DistanceToSegment, DoesNotDependOnTheOrderOfTheCorners) {
  std::array<Vec3, 4> inverted = kUnitTet;
  std::swap(inverted[0], inverted[1]);
  EXPECT_EQ(distance_to_segment(inverted, {0.2, 0.2, -1}, {0.2, 0.2, 1}), 0.0);
  EXPECT_NEAR(distance_to_segment(inverted, {0.2, 0.2, -3}, {0.2, 0.2, -0.5}), 0.5, 1e-15);
}

TEST(DistanceToSegment, OfAFlatTetIsThatOfItsFaces) {
  const std::array<Vec3, 4> flat{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0)};
  EXPECT_NEAR(distance_to_segment(flat, {0.3, 0.4, 0.25}, {0.3, 0.4, 2.0}), 0.25, 1e-15);
}

TEST(DistanceToSegment, AgreesWithDenseSamplingOnRandomTets) {
  Random random(7);
  const auto draw = [&random] { return Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
  constexpr int kSamples = 24;
  for (int trial = 0; trial < 60; ++trial) {
    const std::array<Vec3, 4> tet{draw(), draw(), draw(), draw()};
    const Vec3 a = 1.5 * draw();
    const Vec3 b = 1.5 * draw();
    double sampled = 1e9;
    for (int i = 0; i <= kSamples; ++i) {
      for (int j = 0; i + j <= kSamples; ++j) {
        for (int k = 0; i + j + k <= kSamples; ++k) {
          const Vec3 p = (i * tet[0] + j * tet[1] + k * tet[2] + (kSamples - i - j - k) * tet[3]) / kSamples;
          const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
          sampled = std::min(sampled, (p - a - t * (b - a)).norm());
        }
      }
    }
    const double exact = distance_to_segment(tet, a, b);
    EXPECT_LE(exact, sampled + 1e-12);
    EXPECT_GE(exact, sampled - 3.5 / kSamples) << "samples are at most a grid cell's diagonal from the nearest point";
  }
}

TEST(ContactInterval, ATetReachedHalfWayIsInContactForTheRest) {
  const ContactInterval interval = contact_interval(std::vector<double>{1.0, 0.5, 0.0}, 0.5);
  EXPECT_DOUBLE_EQ(interval.fraction, 0.5);
  EXPECT_DOUBLE_EQ(interval.first, 0.5);
}

TEST(ContactInterval, APassingTetIsInContactBetweenEntryAndExit) {
  const ContactInterval interval = contact_interval(std::vector<double>{1.5, 0.5, 1.5}, 1.0);
  EXPECT_DOUBLE_EQ(interval.first, 0.25);
  EXPECT_DOUBLE_EQ(interval.fraction, 0.5);
}

TEST(ContactInterval, ATetOutOfReachIsNeverInContact) {
  EXPECT_EQ(contact_interval(std::vector<double>{2.0, 1.2, 1.1}, 1.0).fraction, 0.0);
}

TEST(ContactInterval, DoesNotDependOnHowTheStepIsDivided) {
  // Distances that change evenly from 2 to 0: contact within 0.7 lasts 35 % of the step however often it is looked at.
  for (const int moments : {1, 2, 4, 7, 16}) {
    std::vector<double> distances;
    for (int m = 0; m <= moments; ++m) distances.push_back(2.0 * (1.0 - static_cast<double>(m) / moments));
    EXPECT_NEAR(contact_interval(distances, 0.7).fraction, 0.35, 1e-12) << moments << " intervals";
  }
}

}  // namespace
}  // namespace incise
