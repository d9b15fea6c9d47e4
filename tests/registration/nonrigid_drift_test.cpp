#include "registration/clouds.hpp"
#include "support/data_dir.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/neighbours.hpp>
#include <incise/registration/nonrigid_drift.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

Monitor silent;

TEST(NonrigidDrift, BendsTheDistortedFishOntoTheFish) {
  INCISE_NEEDS_DATA_DIR();
  const std::filesystem::path folder = *testing::data_dir() / "registration" / "gadomski_cpd";
  const Points fish = testing::read_rows(folder / "fish.csv");
  const Points distorted = testing::read_rows(folder / "fish_distorted.csv");
  Workers workers(1);
  NonrigidSettings settings{.dimensions = 2};
  const NonrigidDrift drift = nonrigid_drift(distorted, fish, settings, workers, silent);
  EXPECT_EQ(drift.outcome, DriftOutcome::Converged);
  const NeighbourSearch search(fish);
  double worst = 0.0;
  double size = 0.0;
  for (const Vec3& p : fish) size = std::max(size, p.norm());
  for (const Vec3& p : drift.moved_mm) worst = std::max(worst, std::sqrt(search.nearest(p).squared_mm2));
  EXPECT_LT(worst, 0.1 * size);
}

TEST(NonrigidDrift, TakesAwayASmoothSettlingAndLittleElse) {
  Random random(5);
  Workers workers(2);
  const Points source = testing::hill(1200, random).points;
  const auto dip = [](const Vec3& p) { return 1.5 * std::exp(-p.head<2>().squaredNorm() / 300.0); };
  Points target;
  for (const Vec3& p : testing::hill(1500, random).points) target.emplace_back(p - dip(p) * Vec3::UnitZ());
  NonrigidSettings settings{.first_sigma = 0.1};
  const NonrigidDrift drift = nonrigid_drift(source, target, settings, workers, silent);
  EXPECT_EQ(drift.outcome, DriftOutcome::Converged);
  double before = 0.0;
  double after = 0.0;
  for (std::size_t i = 0; i < source.size(); ++i) {
    // Above the settled surface: sliding within it shows nothing.
    const Vec3& p = drift.moved_mm[i];
    before += std::pow(dip(source[i]), 2);
    after += std::pow(p.z() - (testing::hill_height(p.x(), p.y()) - dip(p)), 2);
  }
  EXPECT_LT(std::sqrt(after), 0.4 * std::sqrt(before));
  EXPECT_LT(drift.largest_move_mm, 3.0);
  EXPECT_LT(drift.rank, 100);
}

TEST(NonrigidDrift, CloudsThatLieOnEachOtherStay) {
  Random random(6);
  Workers workers(1);
  const Points source = testing::hill(500, random).points;
  NonrigidSettings settings{.first_sigma = 0.05};
  EXPECT_LT(nonrigid_drift(source, source, settings, workers, silent).largest_move_mm, 0.01);
}

TEST(NonrigidDrift, RefusesSettingsOutOfRange) {
  Workers workers(1);
  const Points points{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()};
  NonrigidSettings settings{.stiffness = 0.0};
  EXPECT_THROW(static_cast<void>(nonrigid_drift(points, points, settings, workers, silent)), InvalidArgument);
}

}  // namespace
}  // namespace incise
