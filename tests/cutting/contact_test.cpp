#include "contact.hpp"

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

/// Distances of random tets from random cores of one tool, held against those of dense samples of the tet from the core.
void expect_sampled_distances(const Tool& tool) {
  Random random(7);
  const auto draw = [&random] { return Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
  constexpr int kSamples = 24;
  int meetings = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const std::array<Vec3, 4> tet{draw(), draw(), draw(), draw()};
    const Vec3 axis = draw().normalized();
    const ToolCore core(tool, {1.5 * draw(), axis, heading_across(draw(), axis)});
    double sampled = 1e9;
    for (int i = 0; i <= kSamples; ++i) {
      for (int j = 0; i + j <= kSamples; ++j) {
        for (int k = 0; i + j + k <= kSamples; ++k) {
          const Vec3 p = (i * tet[0] + j * tet[1] + k * tet[2] + (kSamples - i - j - k) * tet[3]) / kSamples;
          sampled = std::min(sampled, distance_to_core(p, core));
        }
      }
    }
    const double exact = distance_to_core(tet, core);
    meetings += exact == 0.0 ? 1 : 0;
    EXPECT_LE(exact, sampled + 1e-12);
    EXPECT_GE(exact, sampled - 3.5 / kSamples) << "samples are at most a grid cell's diagonal from the nearest point";
    if (exact == 0.0) {
      EXPECT_LE(sampled, 3.5 / kSamples);
    }
  }
  EXPECT_LT(meetings, 60);
}

TEST(DistanceToCore, OfANeedleAgreesWithDenseSampling) { expect_sampled_distances(Needle{.diameter_mm = 0.1, .length_mm = 1.2}); }
TEST(DistanceToCore, OfABladeAgreesWithDenseSampling) {
  expect_sampled_distances(Blade{.thickness_mm = 0.1, .width_mm = 0.8, .length_mm = 1.2});
}
TEST(DistanceToCore, OfABallAgreesWithDenseSampling) { expect_sampled_distances(Ball{.diameter_mm = 0.1}); }

TEST(DistanceToCore, OfAPointFromABladeAgreesWithDenseSampling) {
  const Blade blade{.thickness_mm = 0.1, .width_mm = 2.0, .length_mm = 3.0};
  const ToolPose pose{{0.5, 0, 0}, -Vec3::UnitZ(), Vec3::UnitX()};  // over x in [-0.5, 1.5], z in [0, 3], at y = 0
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const Vec3 p(random.uniform(-3, 4), random.uniform(-2, 2), random.uniform(-2, 5));
    double sampled = 1e9;
    for (int i = 0; i <= 40; ++i) {
      for (int j = 0; j <= 60; ++j) sampled = std::min(sampled, (p - Vec3(-0.5 + 0.05 * i, 0.0, 0.05 * j)).norm());
    }
    EXPECT_LE(distance_to_core(p, ToolCore(blade, pose)), sampled + 1e-12);
    EXPECT_GE(distance_to_core(p, ToolCore(blade, pose)), sampled - 0.036);
  }
}

TEST(DistanceToCore, IsZeroWhereATetsEdgeGoesThroughABladeWiderThanTheTet) {
  const ToolPose pose{{0, 0, -2}, -Vec3::UnitZ(), Vec3(1, 1, 0).normalized()};
  const std::array<Vec3, 4> tet{Vec3(0.2, 0, 0), Vec3(0, 0.2, 0), Vec3(0.3, 0.1, 0.1), Vec3(0.4, 0.1, -0.2)};
  EXPECT_EQ(distance_to_core(tet, ToolCore(Blade{.width_mm = 8.0}, pose)), 0.0);
}

/// The interval of a distance that is looked at `moments` + 1 times.
ContactInterval interval_of(const std::function<double(double)>& distance, double limit_mm, int moments = 4) {
  std::vector<double> distances;
  for (int m = 0; m <= moments; ++m) distances.push_back(distance(static_cast<double>(m) / moments));
  return contact_interval(distances, distance, limit_mm);
}

TEST(ContactInterval, ATetReachedHalfWayIsInContactForTheRest) {
  const ContactInterval interval = interval_of([](double t) { return 1.0 - t; }, 0.5);
  EXPECT_NEAR(interval.fraction, 0.5, 1e-12);
  EXPECT_NEAR(interval.first, 0.5, 1e-12);
  EXPECT_TRUE(interval.at_end);
}

TEST(ContactInterval, APassingTetIsInContactBetweenEntryAndExit) {
  const ContactInterval interval = interval_of([](double t) { return 0.5 + 2.0 * std::abs(t - 0.5); }, 1.0);
  EXPECT_NEAR(interval.first, 0.25, 1e-12);
  EXPECT_NEAR(interval.fraction, 0.5, 1e-12);
  EXPECT_FALSE(interval.at_end);
}

TEST(ContactInterval, ATetTouchedAllTheTimeIsInContactForTheWholeStep) {
  EXPECT_EQ(interval_of([](double t) { return t; }, 1.0).fraction, 1.0);
}

TEST(ContactInterval, ATetOutOfReachIsNeverInContact) {
  EXPECT_EQ(interval_of([](double t) { return 2.0 - t; }, 0.9).fraction, 0.0);
}

TEST(ContactInterval, OfACurvedPassageIsThatOfTheCurveAtAnyDivisionOfTheStep) {
  // A point that passes 0.6 mm from another on a way of 4 mm is within 1 mm of it for 1.6 mm.
  const auto distance = [](double t) { return std::hypot(0.6, 4.0 * (t - 0.45)); };
  for (const int moments : {2, 4, 7, 16}) {
    const ContactInterval interval = interval_of(distance, 1.0, moments);
    EXPECT_NEAR(interval.fraction, 0.4, 1e-6) << moments << " intervals";
    EXPECT_NEAR(interval.first, 0.25, 1e-6) << moments << " intervals";
  }
}

TEST(ContactInterval, AContactThatBeginsAndEndsBetweenTwoMomentsIsFound) {
  const auto distance = [](double t) { return std::hypot(0.99, 4.0 * (t - 0.62)); };
  EXPECT_NEAR(interval_of(distance, 1.0).fraction, 2.0 * std::sqrt(1.0 - 0.99 * 0.99) / 4.0, 1e-5);
}

/// The tool goes through a block whose vertices move meanwhile; near it are those that looking at every tet finds.
TEST(NearTets, AreThoseThatLookingAtEveryTetFinds) {
  const TissueModel model = make_tissue_model(make_block({20, 10, 8}, {20, 10, 8}), Material{},
                                              {FixedConstraint{SphereRegion{Vec3::Zero(), 1.0}}});
  const Tool needle = Needle{};
  Workers workers(2);
  NearTets near;
  Points now = model.mesh.vertices;
  std::vector<std::uint8_t> is_wanted(model.mesh.tets.size(), 1);
  constexpr double kLimitMm = 1.1, kMovedMm = 0.3;
  for (int step = 0; step < 60; ++step) {
    const Points before = now;
    for (std::size_t v = 0; v < now.size(); ++v)  // to and fro, farther and farther
      now[v] += kMovedMm * Vec3(step % 8 < 6 ? 1.0 : -1.0, 0.0, 0.0);
    near.moved(kMovedMm);
    is_wanted[static_cast<std::size_t>(97 * step)] = 0;
    const ToolCore core(needle, {Vec3(1.0 + 0.3 * step, 5.2, 4.0), -Vec3::UnitZ()});
    NearTets anew;
    const std::vector<TetId> expected =
        anew.candidates(model, is_wanted, before, now, std::span(&core, 1), kLimitMm, workers);
    EXPECT_EQ(near.candidates(model, is_wanted, before, now, std::span(&core, 1), kLimitMm, workers), expected) << step;
    EXPECT_TRUE(step != 5 || expected.size() > 20U);
  }
}

}  // namespace
}  // namespace incise
