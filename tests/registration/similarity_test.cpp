#include <incise/core/units.hpp>
#include <incise/registration/similarity.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

const Similarity kA{1.3, rotation_of({0.3, -0.8, 0.5}), {4.0, -2.0, 7.0}};
const Similarity kB{0.7, rotation_of({-1.0, 0.2, 2.0}), {-1.0, 9.0, 3.0}};
const Vec3 kPoint(2.0, -5.0, 11.0);

TEST(Similarity, ProductAppliesTheRightFactorFirst) {
  EXPECT_LT(((kA * kB)(kPoint)-kA(kB(kPoint))).norm(), 1e-12);
}

TEST(Similarity, InverseTakesPointsBack) {
  EXPECT_LT((inverse(kA)(kA(kPoint)) - kPoint).norm(), 1e-12);
}

TEST(Similarity, MatrixHoldsScaleTimesRotation) {
  const Eigen::Vector4d image = matrix_of(kA) * kPoint.homogeneous();
  EXPECT_LT((image.head<3>() - kA(kPoint)).norm(), 1e-12);
  EXPECT_DOUBLE_EQ(image[3], 1.0);
}

TEST(Similarity, AngleBetweenRotationsIsExactForSmallAndLargeTurns) {
  for (const double degrees : {1e-6, 0.5, 90.0, 179.0}) {
    const Mat3 turned = rotation_of(units::rad_from_deg(degrees) * Vec3(1.0, 2.0, -2.0) / 3.0) * kA.rotation;
    EXPECT_NEAR(angle_between_deg(turned, kA.rotation), degrees, 1e-9 * std::max(1.0, degrees * 1e3));
  }
}

TEST(Similarity, RotationVectorIsUndoneByRotationOf) {
  const Vec3 v(0.4, -1.1, 0.9);
  EXPECT_LT((rotation_vector(rotation_of(v)) - v).norm(), 1e-12);
}

}  // namespace
}  // namespace incise
