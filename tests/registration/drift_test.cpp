#include "registration/clouds.hpp"
#include "registration/matching.hpp"
#include "support/data_dir.hpp"

#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/registration/drift.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>

namespace incise {
namespace {

using testing::read_rows;
Monitor silent;
// Two random samples of one surface 1.3 mm apart: the drift holds point to point, not surface to surface.
constexpr double kPullOfSinglePoints = 0.8;

Points scaled(Points points, double factor) {
  for (Vec3& p : points) p *= factor;
  return points;
}

class Fixtures : public ::testing::Test {
 protected:
  void SetUp() override {
    INCISE_NEEDS_DATA_DIR();
    gadomski_ = *testing::data_dir() / "registration" / "gadomski_cpd";
    pycpd_ = *testing::data_dir() / "registration" / "pycpd";
  }
  std::filesystem::path gadomski_;
  std::filesystem::path pycpd_;
  Workers workers_{1};
};

/// σ² after one step of the drift from the identity, on all pairs, with σ² = 1.
double variance_after_a_step(const Points& source, const Points& target, const DriftSettings& settings) {
  Workers workers{1};
  const WeightedPoints y{source, std::vector<double>(source.size(), 1.0), 0.0};
  const WeightedPoints x{target, std::vector<double>(target.size(), 1.0), 0.0};
  return best_transform(match(y, x, {}, 1.0, settings, workers), settings).variance;
}

// Known answers: README.md of the shared data, section 3.
TEST_F(Fixtures, OneStepOnTheFishGivesThePublishedVariance) {
  const Points fish = read_rows(gadomski_ / "fish.csv");
  const Points distorted = read_rows(gadomski_ / "fish_distorted.csv");
  DriftSettings settings{.scale = ScaleRange::fixed(), .outlier_weight = 0.1, .dimensions = 2};
  EXPECT_NEAR(variance_after_a_step(distorted, fish, settings), 0.52384, 5e-5);
  settings.scale = ScaleRange::free();
  EXPECT_NEAR(variance_after_a_step(distorted, fish, settings), 0.4072, 5e-4);
}

TEST_F(Fixtures, AFishTurnedBy20DegreesComesBack) {
  const Points fish = scaled(read_rows(gadomski_ / "fish.csv"), 10.0);
  const Mat3 turn = rotation_of({0.0, 0.0, units::rad_from_deg(20.0)});
  DriftSettings settings{.dimensions = 2};
  const CoherentPointDrift drift = rigid_drift(moved({1.0, turn}, fish), fish, {}, settings, workers_, silent);
  EXPECT_EQ(drift.outcome, DriftOutcome::Converged);
  EXPECT_LT((drift.T_target_source.rotation - turn.transpose()).norm(), 1e-4);
}

TEST_F(Fixtures, AFishTenTimesTheSizeHasScaleTen) {
  const Points fish = read_rows(gadomski_ / "fish.csv");
  DriftSettings settings{.dimensions = 2};
  const CoherentPointDrift drift = rigid_drift(fish, scaled(fish, 10.0), {}, settings, workers_, silent);
  EXPECT_NEAR(drift.T_target_source.scale, 10.0, 1e-3);
}

TEST_F(Fixtures, TheBunnyIsShiftedByOneOnEveryAxis) {
  const CoherentPointDrift drift = rigid_drift(read_rows(pycpd_ / "bunny_source.txt"),
                                               read_rows(pycpd_ / "bunny_target.txt"), {}, {}, workers_, silent);
  EXPECT_EQ(drift.outcome, DriftOutcome::Converged);
  EXPECT_NEAR(drift.T_target_source.scale, 1.0, 1e-6);
  EXPECT_LT((drift.T_target_source.rotation - Mat3::Identity()).norm(), 1e-6);
  EXPECT_LT((drift.T_target_source.translation_mm - Vec3(-1.0, -1.0, -1.0)).norm(), 1e-6);
}

class HillDrift : public ::testing::Test {
 protected:
  Random random_{3};
  Workers workers_{2};
  Points source_ = testing::hill(1500, random_).points;
  Similarity truth_{1.05, rotation_of({0.2, -0.1, 0.3}), {10.0, -4.0, 6.0}};
  Points target_ = moved(truth_, testing::hill(1500, random_, 0.2).points);
};

TEST_F(HillDrift, ClustersTruncationAndAccelerationLeaveTheFixedPointAlone) {
  DriftSettings plain{.max_iterations = 3000, .tolerance = 1e-5, .coarse_to_fine = false};
  const CoherentPointDrift all = rigid_drift(source_, target_, {}, plain, workers_, silent);
  const CoherentPointDrift fast = rigid_drift(source_, target_, {}, {}, workers_, silent);
  ASSERT_EQ(all.outcome, DriftOutcome::Converged);
  ASSERT_EQ(fast.outcome, DriftOutcome::Converged);
  EXPECT_LT(rms_difference_mm(all.T_target_source, fast.T_target_source, source_), 0.01);
  EXPECT_LT(angle_between_deg(all.T_target_source.rotation, fast.T_target_source.rotation), 0.02);
  EXPECT_LT(rms_difference_mm(fast.T_target_source, truth_, source_), kPullOfSinglePoints);
}

TEST_F(HillDrift, NeitherUnitsNorOriginMatter) {
  const CoherentPointDrift drift = rigid_drift(source_, target_, {}, {}, workers_, silent);
  const Similarity to_metres{0.001, Mat3::Identity(), {500.0, -200.0, 1e3}};
  const CoherentPointDrift other = rigid_drift(moved(to_metres, source_), moved(to_metres, target_),
                                               {1.0, Mat3::Identity(), Vec3::Zero()}, {}, workers_, silent);
  EXPECT_EQ(other.outcome, DriftOutcome::Converged);
  // 1 m of offset in 1e-5 m of noise leaves eleven digits.
  const Similarity back = inverse(to_metres) * other.T_target_source * to_metres;
  EXPECT_LT(rms_difference_mm(back, drift.T_target_source, source_), 0.02);
}

TEST_F(HillDrift, AnyNumberOfThreadsGivesTheSameBits) {
  Workers one(1);
  const CoherentPointDrift a = rigid_drift(source_, target_, {}, {}, one, silent);
  const CoherentPointDrift b = rigid_drift(source_, target_, {}, {}, workers_, silent);
  EXPECT_EQ(matrix_of(a.T_target_source), matrix_of(b.T_target_source));
  EXPECT_EQ(a.iterations, b.iterations);
}

TEST_F(HillDrift, ABoundedScaleStaysInItsRange) {
  DriftSettings settings{.scale = {0.98, 1.02}};
  EXPECT_DOUBLE_EQ(rigid_drift(source_, target_, {}, settings, workers_, silent).T_target_source.scale, 1.02);
  settings.scale = ScaleRange::fixed(1.05);
  const CoherentPointDrift fixed = rigid_drift(source_, target_, {1.05}, settings, workers_, silent);
  EXPECT_DOUBLE_EQ(fixed.T_target_source.scale, 1.05);
  EXPECT_LT(rms_difference_mm(fixed.T_target_source, truth_, source_), kPullOfSinglePoints);
}

TEST_F(HillDrift, RunningOutOfStepsIsTold) {
  DriftSettings settings{.max_iterations = 3};
  const CoherentPointDrift drift = rigid_drift(source_, target_, {}, settings, workers_, silent);
  EXPECT_EQ(drift.outcome, DriftOutcome::IterationLimit);
  EXPECT_EQ(drift.iterations, 3);
}

TEST_F(HillDrift, AMirrorImageIsAnsweredByARotation) {
  Points mirrored = source_;
  for (Vec3& p : mirrored) p.x() = -p.x();
  const CoherentPointDrift drift = rigid_drift(source_, mirrored, {}, {}, workers_, silent);
  EXPECT_NEAR(drift.T_target_source.rotation.determinant(), 1.0, 1e-9);
  EXPECT_GT(drift.sigma_mm, 0.5);
}

TEST(RigidDrift, PointsOnALineAreDegenerate) {
  Points line;
  for (int i = 0; i < 50; ++i) line.emplace_back(i, 2.0 * i, -i);
  Workers workers(1);
  EXPECT_EQ(rigid_drift(line, line, {}, {}, workers, silent).outcome, DriftOutcome::Degenerate);
  EXPECT_EQ(rigid_drift(Points{Vec3::Ones()}, Points{Vec3::Ones()}, {}, {}, workers, silent).outcome,
            DriftOutcome::Degenerate);
}

TEST(RigidDrift, RefusesEmptyCloudsAndNumbersThatAreNone) {
  Workers workers(1);
  const Points good{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()};
  EXPECT_THROW(static_cast<void>(rigid_drift({}, good, {}, {}, workers, silent)), InvalidArgument);
  const Points bad{Vec3::Zero(), Vec3(0.0, std::nan(""), 0.0), Vec3::UnitY()};
  EXPECT_THROW(static_cast<void>(rigid_drift(good, bad, {}, {}, workers, silent)), InvalidArgument);
  DriftSettings settings{.outlier_weight = 1.0};
  EXPECT_THROW(static_cast<void>(rigid_drift(good, good, {}, settings, workers, silent)), InvalidArgument);
}

}  // namespace
}  // namespace incise
