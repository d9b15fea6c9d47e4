#include "registration/clouds.hpp"
#include "registration/observability.hpp"
#include "registration/rival_reason.hpp"
#include "support/monitors.hpp"

#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/registration/register_clouds.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>

namespace incise {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing::hill;
using testing::moved_cloud;

Monitor silent;

class RegisterClouds : public ::testing::Test {
 protected:
  Registration run(const PointCloud& source, const PointCloud& target, RegistrationSettings settings = {}) {
    return register_clouds(source, target, settings, workers_, silent);
  }
  Random random_{11};
  Workers workers_{2};
  Similarity upside_down_{0.97, rotation_of(units::kPi* Vec3(0.6, 0.0, 0.8)), {150.0, -80.0, 400.0}};
};

TEST_F(RegisterClouds, FindsAHalfTurnWithPartOfTheTargetMissingAndOutliers) {
  const PointCloud source = hill(2000, random_);
  PointCloud target = hill(2500, random_, 0.2);
  target = crop(target, Box3(Vec3(-12.0, -30.0, -50.0), Vec3(40.0, 30.0, 50.0)));
  for (int i = 0; i < 300; ++i) {
    target.points.emplace_back(random_.uniform(-15.0, 35.0), random_.uniform(-22.0, 22.0), random_.uniform(-5.0, 25.0));
    target.normals.emplace_back(Vec3::UnitZ());
  }
  const Registration found = run(source, moved_cloud(upside_down_, target));
  EXPECT_EQ(found.outcome, RegistrationOutcome::Converged) << (found.reasons.empty() ? "" : found.reasons.front());
  EXPECT_LT(rms_difference_mm(found.T_target_source, upside_down_, source.points), 0.4);
  EXPECT_LT(angle_between_deg(found.T_target_source.rotation, upside_down_.rotation), 0.5);
  EXPECT_GT(found.inlier_fraction, 0.5);
  EXPECT_GT(found.certificate.sharpness[0], RegistrationSettings{}.least_sharpness);
}

TEST_F(RegisterClouds, NeedsNoNormals) {
  PointCloud source = hill(2000, random_);
  PointCloud target = moved_cloud(upside_down_, hill(2000, random_, 0.1));
  source.normals.clear();
  target.normals.clear();
  const Registration found = run(source, target);
  EXPECT_EQ(found.outcome, RegistrationOutcome::Converged) << (found.reasons.empty() ? "" : found.reasons.front());
  EXPECT_LT(rms_difference_mm(found.T_target_source, upside_down_, source.points), 0.4);
}

TEST_F(RegisterClouds, NeitherUnitsNorOriginMatter) {
  const PointCloud source = hill(1000, random_);
  const PointCloud target = moved_cloud(upside_down_, hill(1000, random_, 0.1));
  const Similarity to_metres{0.001, Mat3::Identity(), {0.3, -2.0, 1.0}};
  const Registration in_mm = run(source, target);
  const Registration in_m = run(moved_cloud(to_metres, source), moved_cloud(to_metres, target));
  EXPECT_EQ(in_mm.outcome, in_m.outcome);
  const Similarity back = inverse(to_metres) * in_m.T_target_source * to_metres;
  EXPECT_LT(rms_difference_mm(back, in_mm.T_target_source, source.points), 0.02);
  EXPECT_NEAR(in_m.rmse_mm * 1000.0, in_mm.rmse_mm, 0.01);
}

TEST_F(RegisterClouds, AnyNumberOfThreadsGivesTheSameBits) {
  const PointCloud source = hill(800, random_);
  const PointCloud target = moved_cloud(upside_down_, hill(800, random_, 0.1));
  Workers one(1);
  const Registration a = register_clouds(source, target, {}, one, silent);
  const Registration b = run(source, target);
  EXPECT_EQ(matrix_of(a.T_target_source), matrix_of(b.T_target_source));
  EXPECT_EQ(a.rmse_mm, b.rmse_mm);
  EXPECT_EQ(a.certificate.sd_mm, b.certificate.sd_mm);
}

TEST_F(RegisterClouds, TheOrderOfPointsDoesNotMatter) {
  const PointCloud source = hill(1000, random_);
  const PointCloud target = moved_cloud(upside_down_, hill(1000, random_, 0.1));
  std::vector<std::size_t> backwards(target.points.size());
  for (std::size_t i = 0; i < backwards.size(); ++i) backwards[i] = backwards.size() - 1 - i;
  const Registration a = run(source, target);
  const Registration b = run(source, subset(target, backwards));
  EXPECT_LT(rms_difference_mm(a.T_target_source, b.T_target_source, source.points), 0.02);
}

TEST_F(RegisterClouds, IdenticalCloudsGiveTheIdentity) {
  const PointCloud source = hill(1500, random_);
  const Registration found = run(source, source);
  EXPECT_EQ(found.outcome, RegistrationOutcome::Converged) << (found.reasons.empty() ? "" : found.reasons.front());
  EXPECT_LT(rms_difference_mm(found.T_target_source, {}, source.points), 0.01);
  EXPECT_NEAR(found.T_target_source.scale, 1.0, 1e-3);
}

TEST_F(RegisterClouds, APlaneIsIllDetermined) {
  for (const double noise : {0.0, 0.2}) {
    PointCloud source;
    PointCloud target;
    for (PointCloud* cloud : {&source, &target}) {
      for (int i = 0; i < 1500; ++i) {
        cloud->points.emplace_back(random_.uniform(-30.0, 30.0), random_.uniform(-20.0, 20.0),
                                   noise * random_.normal());
        cloud->normals.emplace_back(Vec3::UnitZ());
      }
    }
    const Registration found = run(source, moved_cloud(upside_down_, target));
    EXPECT_NE(found.outcome, RegistrationOutcome::Converged) << "noise " << noise;
    EXPECT_THAT(found.reasons, Contains(HasSubstr("hardly changes the residual"))) << "noise " << noise;
  }
}

TEST_F(RegisterClouds, ASphericalCapIsIllDetermined) {
  PointCloud source;
  PointCloud target;
  for (PointCloud* cloud : {&source, &target}) {
    while (cloud->points.size() < 1500) {
      const Vec3 n = Vec3(random_.normal(), random_.normal(), random_.normal()).normalized();
      if (n.z() < 0.4) continue;
      cloud->points.emplace_back(30.0 * n + 0.1 * random_.normal() * n);
      cloud->normals.push_back(n);
    }
  }
  const Registration found = run(source, moved_cloud(upside_down_, target));
  EXPECT_NE(found.outcome, RegistrationOutcome::Converged);
  EXPECT_THAT(found.reasons, Contains(HasSubstr("hardly changes the residual")));
}

PointCloud mirrored(PointCloud cloud) {
  for (Vec3& p : cloud.points) p.x() = -p.x();
  for (Vec3& n : cloud.normals) n.x() = -n.x();
  return cloud;
}

/// A hill with a knoll straight behind its top: even in x, and in no other direction.
double symmetric_height(double x, double y) {
  return 14.0 * std::exp(-(x * x / 500.0 + y * y / 220.0)) +
         5.0 * std::exp(-(x * x / 60.0 + (y - 9.0) * (y - 9.0) / 25.0));
}

TEST_F(RegisterClouds, AMirrorImageIsNeverAReflectionAndIsFlagged) {
  const PointCloud source = hill(2000, random_);
  const Registration found = run(source, mirrored(hill(2000, random_, 0.1)));
  EXPECT_NEAR(found.T_target_source.rotation.determinant(), 1.0, 1e-9);
  EXPECT_EQ(found.outcome, RegistrationOutcome::Mirrored);
  EXPECT_THAT(found.reasons, Contains(HasSubstr("mirror image fits the target better")));
  EXPECT_GT(found.mirror_score, 1.2 * found.score);
  EXPECT_LT(found.mirror_rmse_mm, 0.3);
  EXPECT_GT(found.shape_rmse_mm, 3.0 * found.mirror_rmse_mm);
}

TEST_F(RegisterClouds, AMirrorImageIsOneWhereTheWrongShapeDoesNotComeToRestToo) {
  const PointCloud source = hill(2000, random_);
  RegistrationSettings hasty{.max_iterations = 5};
  const Registration found = run(source, mirrored(hill(2000, random_, 0.1)), hasty);
  EXPECT_THAT(found.reasons, Contains(HasSubstr("still moving")));
  EXPECT_EQ(found.outcome, RegistrationOutcome::Mirrored);
}

TEST_F(RegisterClouds, AMirrorImageIsKnownFromAStartNearTheWrongPoseToo) {
  // Nearly symmetric: the wrong pose lies close by, and no search is made.
  PointCloud source, target;
  for (PointCloud* cloud : {&source, &target}) {
    *cloud = hill(2500, random_);
    for (Vec3& p : cloud->points) p.z() -= 0.6 * (p.z() - symmetric_height(p.x(), p.y()));
    cloud->normals.clear();
    *cloud = with_normals(std::move(*cloud), -Vec3::UnitZ(), 12, workers_);
  }
  RegistrationSettings near{.start = Similarity{}};
  const Registration proper = run(source, target, near);
  EXPECT_EQ(proper.outcome, RegistrationOutcome::Converged) << (proper.reasons.empty() ? "" : proper.reasons.front());
  EXPECT_TRUE(proper.is_handedness_determined);
  EXPECT_EQ(run(source, mirrored(target), near).outcome, RegistrationOutcome::Mirrored);
}

TEST_F(RegisterClouds, AShapeThatIsItsOwnMirrorImageIsAcceptedAndToldOf) {
  PointCloud source, target;
  for (PointCloud* cloud : {&source, &target}) {
    *cloud = hill(2500, random_);
    for (Vec3& p : cloud->points) p.z() = symmetric_height(p.x(), p.y());
    for (Vec3& p : cloud->points) p += 0.1 * Vec3(random_.normal(), random_.normal(), random_.normal());
    cloud->normals.clear();
    *cloud = with_normals(std::move(*cloud), -Vec3::UnitZ(), 12, workers_);
  }
  for (const PointCloud& shape : {target, mirrored(target)}) {
    const Registration found = run(source, moved_cloud(upside_down_, shape));
    EXPECT_EQ(found.outcome, RegistrationOutcome::Converged) << (found.reasons.empty() ? "" : found.reasons.front());
    EXPECT_LT(rms_difference_mm(found.T_target_source, upside_down_, source.points), 0.4);
    EXPECT_FALSE(found.is_handedness_determined);
    EXPECT_THAT(found.reasons, Contains(HasSubstr("mirror image fits about as well")));
  }
}

TEST_F(RegisterClouds, TwoPartsOfASymmetricShapeAreNoMirrorImages) {
  // They share a strip about the plane of symmetry. The left part's mirror image lies on all of the right part, and a
  // growth in the strip weighs less there.
  constexpr double kHalfStripMm = 7.0;
  PointCloud source, target;
  for (PointCloud* cloud : {&source, &target}) {
    *cloud = hill(5000, random_);
    for (Vec3& p : cloud->points) p.z() = symmetric_height(p.x(), p.y());
    if (cloud == &target)
      for (Vec3& p : cloud->points) p.z() += 1.2 * std::exp(-(p.x() * p.x() + std::pow(p.y() + 8.0, 2)) / 4.0);
    for (Vec3& p : cloud->points) p += 0.1 * Vec3(random_.normal(), random_.normal(), random_.normal());
    cloud->normals.clear();
    *cloud = with_normals(std::move(*cloud), -Vec3::UnitZ(), 12, workers_);
  }
  source = crop(source, Box3(Vec3(-50.0, -50.0, -50.0), Vec3(kHalfStripMm, 50.0, 50.0)));
  target = crop(target, Box3(Vec3(-kHalfStripMm, -50.0, -50.0), Vec3(50.0, 50.0, 50.0)));
  RegistrationSettings near{.start = Similarity{}};
  const Registration found = run(source, target, near);
  EXPECT_LT(rms_difference_mm(found.T_target_source, Similarity{}, source.points), 0.4);
  EXPECT_LT(found.score, 0.95 * found.mirror_score) << "what used to be taken for a mirror image";
  EXPECT_GT(found.shape_rmse_mm, found.mirror_rmse_mm / 0.95) << "likewise";
  EXPECT_NE(found.outcome, RegistrationOutcome::Mirrored);
  EXPECT_FALSE(found.is_handedness_determined);
}

TEST_F(RegisterClouds, TellsWhenTheScaleIsUnlikely) {
  const PointCloud source = hill(1500, random_);
  const Similarity truth{1.08, rotation_of({0.1, 0.2, 0.3}), {1.0, 2.0, 3.0}};
  const Registration found = run(source, moved_cloud(truth, hill(1500, random_, 0.1)));
  EXPECT_NEAR(found.T_target_source.scale, 1.08, 0.005);
  EXPECT_TRUE(found.is_scale_suspicious);
  EXPECT_THAT(found.reasons, Contains(HasSubstr("outside 0.95 to 1.05")));
  RegistrationSettings narrow{.scale = {0.97, 1.03}};
  const Registration held = run(source, moved_cloud(truth, hill(1500, random_, 0.1)), narrow);
  EXPECT_TRUE(held.scale_at_limit);
  EXPECT_NE(held.outcome, RegistrationOutcome::Converged);
}

TEST_F(RegisterClouds, AScaleAtTheEndOfItsRangeIsNoSuccess) {
  const PointCloud source = hill(1500, random_);
  const Similarity truth{1.0, rotation_of({0.1, 0.2, 0.3}), {1.0, 2.0, 3.0}};
  RegistrationSettings above;
  above.scale = {1.01, 1.2};  // a residual of a hundredth alone would pass
  above.start = Similarity{1.01, truth.rotation, truth.translation_mm};
  for (const double settling_mm : {0.0, 1.0}) {
    above.settling_mm = settling_mm;
    const Registration found = run(source, moved_cloud(truth, hill(1500, random_, 0.1)), above);
    EXPECT_NEAR(found.T_target_source.scale, 1.01, 1e-9);
    EXPECT_EQ(found.outcome, RegistrationOutcome::ScaleAtLimit) << to_string(found.outcome);
    EXPECT_THAT(found.reasons, Contains(HasSubstr("is at the end of its range, 1.01")));
  }
}

TEST_F(RegisterClouds, FewPointsAndLinesAreDegenerate) {
  const PointCloud good = hill(500, random_);
  const Registration single = run(good, {{Vec3::Ones()}, {}});
  EXPECT_EQ(single.outcome, RegistrationOutcome::Degenerate);
  EXPECT_THAT(single.reasons, Contains(HasSubstr("has 1 points")));
  PointCloud line;
  for (int i = 0; i < 100; ++i) line.points.emplace_back(i, i, i);
  EXPECT_EQ(run(line, good).outcome, RegistrationOutcome::Degenerate);
}

/// A grid on waves along x, every other row lifted and the next lowered. Its normals hardly show shifts, least those
/// along x, although the waves make these plain.
PointCloud waves(double lift_mm) {
  const auto sign = [](int i) { return i % 2 == 0 ? 1.0 : -1.0; };
  PointCloud cloud;
  for (int i = 0; i < 16; ++i) {
    for (int j = 0; j < 16; ++j) {
      cloud.points.emplace_back(i, j, 0.5 * std::cos(0.25 * units::kPi * (i - 7.5)) + lift_mm * sign(j));
      cloud.normals.push_back(Vec3(1e-4 * sign(i + j / 2), 1e-3 * sign(i + j), 1.0).normalized());
    }
  }
  return cloud;
}

TEST(PoseObservability, NamesTheMotionWhoseStandardDeviationItGives) {
  constexpr double kLiftMm = 0.05;
  Workers workers(1);
  const SampledSurface source(waves(kLiftMm), workers), target(waves(0.0), workers);
  const PoseObservability found = pose_observability(source, target, Similarity{}, 1.0, false, workers);
  // Motions 0 to 2 by the normals: a shift along x, a turn about z, a shift along y. The first two are measured.
  ASSERT_NEAR(found.visible[2], 1e-6, 1e-8);
  ASSERT_GT(std::min(found.sharpness[0], found.sharpness[1]), 1e-3);
  EXPECT_THAT(found.weakest, ::testing::ContainsRegex("^a shift along \\(-?0\\.00, -?1\\.00, -?0\\.00\\)$"));
  const double independent = 16.0 * 16.0 / 4.0;
  const double expected_mm = kLiftMm / std::sqrt(independent * found.visible[2]);
  EXPECT_NEAR(found.weakest_sd_mm, expected_mm, 1e-4 * expected_mm);
}

TEST(RivalReason, DividesByNoScoreOfZero) {
  EXPECT_EQ(rival_reason(0.5, 0.625),
            "another pose fits about as well: its score is 80 % of the score of the pose found");
  EXPECT_EQ(rival_reason(0.5, 0.0), "another pose fits better: its score is 0.500, that of the pose found is 0");
}

TEST_F(RegisterClouds, RefusesEmptyCloudsAndNumbersThatAreNone) {
  const PointCloud good = hill(100, random_);
  EXPECT_THROW(static_cast<void>(run({}, good)), InvalidArgument);
  PointCloud bad = good;
  bad.points[7].y() = std::nan("");
  EXPECT_THROW(static_cast<void>(run(bad, good)), InvalidArgument);
  RegistrationSettings settings{.rotations = 1};
  EXPECT_THROW(static_cast<void>(run(good, good, settings)), InvalidArgument);
}

TEST_F(RegisterClouds, StopsWhenAsked) {
  testing::StopAfter impatient;
  const PointCloud good = hill(200, random_);
  EXPECT_EQ(register_clouds(good, good, {}, workers_, impatient).outcome, RegistrationOutcome::Cancelled);
}

/// A dip of 1 mm beside the middle, seen by a camera with noise.
PointCloud dipped_hill(std::size_t count, Random& random) {
  PointCloud cloud = testing::hill(count, random);
  for (Vec3& p : cloud.points) p.z() -= std::exp(-((p.x() - 6.0) * (p.x() - 6.0) + p.y() * p.y()) / 200.0);
  for (Vec3& p : cloud.points) p += 0.1 * Vec3(random.normal(), random.normal(), random.normal());
  cloud.normals.clear();
  return cloud;
}

/// The hill of another specimen: waves as long as a tongue's bumps on it, other ones for each seed.
PointCloud hill_with_bumps(std::size_t count, std::uint64_t seed, double height_mm, Random& random) {
  PointCloud cloud = hill(count, random);
  Random shape(seed);
  for (int k = 0; k < 4; ++k) {
    const double number = 2.0 * units::kPi / shape.uniform(18.0, 35.0);
    const double angle = shape.uniform(0.0, 2.0 * units::kPi);
    const double phase = shape.uniform(0.0, 2.0 * units::kPi);
    const Vec3 along = number * Vec3(std::cos(angle), std::sin(angle), 0.0);
    for (Vec3& p : cloud.points) p.z() += height_mm * std::cos(along.dot(p) + phase);
  }
  for (Vec3& p : cloud.points) p += 0.2 * Vec3(random.normal(), random.normal(), random.normal());
  return cloud;
}

TEST(OtherShape, IsNoSuccessAndTheSameShapeWithItsNoiseIsOne) {
  Random random(31);
  Workers workers(2);
  RegistrationSettings settings{.start = Similarity{}};
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const PointCloud source = hill(2500, random);
    for (const double height_mm : {0.0, 0.4}) {
      PointCloud target = hill_with_bumps(4000, seed, height_mm, random);
      target = with_normals(crop(target, Box3(Vec3(-40, -30, -50), Vec3(20, 30, 50))), -Vec3::UnitZ(), 16, workers);
      const Registration found = register_clouds(source, target, settings, workers, silent);
      SCOPED_TRACE(::testing::Message() << "seed " << seed << ", " << height_mm << " mm: " << found.shape_residual_mm
                                        << " mm, rmse " << found.rmse_mm << ", " << to_string(found.outcome));
      EXPECT_EQ(found.outcome == RegistrationOutcome::Converged, height_mm == 0.0);
      if (height_mm == 0.0) continue;
      EXPECT_THAT(found.reasons, Contains(HasSubstr("another shape")));
    }
  }
}

TEST(Settling, ADipIsNotTakenForAShiftWhereSettlingIsLookedFor) {
  Random random(21);
  Workers workers(2);
  const PointCloud source = testing::hill(2500, random);
  PointCloud target = with_normals(dipped_hill(4000, random), -Vec3::UnitZ(), 16, workers);
  RegistrationSettings settings{.scale = ScaleRange::fixed(), .start = Similarity{}};
  const Registration rigid = register_clouds(source, target, settings, workers, silent);
  settings.settling_mm = 1.0;
  const Registration settled = register_clouds(source, target, settings, workers, silent);
  ASSERT_EQ(settled.outcome, RegistrationOutcome::Converged);
  EXPECT_EQ(rigid.settled_max_mm, 0.0);
  EXPECT_NEAR(settled.settled_max_mm, 1.0, 0.4);
  const auto shift = [](const Registration& r) { return r.T_target_source(Vec3(0.0, 0.0, 10.0)).head<2>().norm(); };
  EXPECT_LT(shift(settled), 0.5 * shift(rigid)) << shift(settled) << " and " << shift(rigid) << " mm";
  EXPECT_GT(settled.certificate.sd_mm, rigid.certificate.sd_mm) << "what settling leaves open is told";
  EXPECT_THAT(rigid.reasons, Contains(HasSubstr("differ smoothly by")))
      << "nor is it silent where it is not looked for";
}

TEST(Settling, IsNotSuspectedWhereNothingHasSettled) {
  Workers workers(2);
  RegistrationSettings settings{.scale = ScaleRange::fixed(), .start = Similarity{}};
  for (const int seed : {1, 2, 3, 4}) {
    Random random(seed);
    const PointCloud source = testing::hill(2500, random);
    PointCloud seen = testing::hill(4000, random);
    for (Vec3& p : seen.points) p += 0.1 * Vec3(random.normal(), random.normal(), random.normal());
    seen.normals.clear();
    const PointCloud target = with_normals(seen, -Vec3::UnitZ(), 16, workers);
    const Registration found = register_clouds(source, target, settings, workers, silent);
    ASSERT_EQ(found.outcome, RegistrationOutcome::Converged);
    EXPECT_THAT(found.reasons, ::testing::Each(::testing::Not(HasSubstr("differ smoothly by")))) << seed;
  }
}

TEST(Settling, WhatItLeavesOpenIsInTheWeakestMotionToo) {
  Random random(21);
  Workers workers(2);
  const PointCloud source = testing::hill(2500, random);
  const PointCloud target = with_normals(dipped_hill(4000, random), -Vec3::UnitZ(), 16, workers);
  RegistrationSettings settings{.scale = ScaleRange::fixed(), .start = Similarity{}};
  double before_mm = 0.0;
  for (const double settling_mm : {1.0, 3.0, 8.0}) {
    settings.settling_mm = settling_mm;
    const Registration found = register_clouds(source, target, settings, workers, silent);
    const PoseObservability& c = found.certificate;
    EXPECT_GT(c.weakest_sd_mm, before_mm) << settling_mm;
    EXPECT_LE(c.weakest_sd_mm, c.sd_mm) << settling_mm;
    EXPECT_GE(std::sqrt(6.0) * c.weakest_sd_mm, c.sd_mm) << settling_mm;  // the largest of six
    // Beyond some settling the pose is not known to a fiftieth of the tissue, and that is the outcome.
    EXPECT_EQ(found.outcome == RegistrationOutcome::Converged, settling_mm < 2.0) << to_string(found.outcome);
    before_mm = c.weakest_sd_mm;
  }
}

TEST(Settling, AScaleThatIsHeldAtItsLimitHasNoVarianceOfItsOwn) {
  Random random(23);
  Workers workers(2);
  const PointCloud source = testing::hill(1500, random);
  const PointCloud target = with_normals(dipped_hill(2500, random), -Vec3::UnitZ(), 16, workers);
  RegistrationSettings settings{.scale = {1.02, 1.2}, .start = Similarity{1.02}, .settling_mm = 1.0};
  const Registration held = register_clouds(source, target, settings, workers, silent);
  EXPECT_TRUE(held.scale_at_limit);
  EXPECT_EQ(held.certificate.scale_sd, 0.0);
}

TEST(Settling, IsFoundBitForBitOnAnyNumberOfThreads) {
  Random random(22);
  Workers one(1);
  Workers three(3);
  const PointCloud source = testing::hill(800, random);
  const PointCloud target = with_normals(dipped_hill(1500, random), -Vec3::UnitZ(), 16, one);
  RegistrationSettings settings{.start = Similarity{}, .settling_mm = 1.0};
  const Registration a = register_clouds(source, target, settings, one, silent);
  const Registration b = register_clouds(source, target, settings, three, silent);
  EXPECT_EQ(matrix_of(a.T_target_source), matrix_of(b.T_target_source));
  EXPECT_EQ(a.settled_rms_mm, b.settled_rms_mm);
}

TEST(Settling, RefusesALengthBelowZero) {
  RegistrationSettings settings{.settling_mm = -1.0};
  EXPECT_EQ(validate(settings).size(), 1U);
}

}  // namespace
}  // namespace incise
