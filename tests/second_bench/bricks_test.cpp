#include "second_bench/holder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

namespace incise::second_bench {
namespace {

constexpr float kC1 = 2.0F, kC2 = 0.6F, kLambda = 30.0F;

BrickGrid grid_of(int nx, int ny, int nz, double size_mm = 2.0) {
  BrickGrid grid;
  const std::array<int, 3> counts{nx, ny, nz};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (int n = 0; n <= counts[axis]; ++n) grid.planes_mm[axis].push_back(size_mm * n);
  return grid;
}

BrickTissue block(int nx, int ny, int nz) {
  BrickGrid grid = grid_of(nx, ny, nz);
  const std::size_t count = grid.brick_count();
  BrickMaterial material{.c1_kpa = kC1, .c2_kpa = kC2, .lambda_kpa = kLambda};
  return make_tissue(std::move(grid), std::vector<BrickMaterial>(count, material),
                     std::vector<Voxels>(count, ~Voxels{0}));
}

void map(BrickTissue& tissue, const Mat3& f) {
  for (std::size_t n = 1; n < tissue.position.size(); ++n) {
    auto& p = tissue.position[n];
    const Vec3 q = f * Vec3(p[0], p[1], p[2]);
    for (std::size_t a = 0; a < 3; ++a) p[a] = static_cast<float>(q[static_cast<Eigen::Index>(a)]);
  }
}

double most_force(const BrickTissue& tissue, const std::function<bool(const Vec3&)>& counts, const BrickTissue& rest) {
  double most = 0.0;
  for (std::size_t n = 1; n < tissue.position.size(); ++n) {
    const auto& p = rest.position[n];
    if (!counts(Vec3(p[0], p[1], p[2]))) continue;
    for (std::size_t a = 0; a < 3; ++a) most = std::max(most, std::abs(static_cast<double>(tissue.force[n][a])));
  }
  return most;
}

TEST(Voxels, HangTogetherByFacesAlone) {
  const Voxels corner = Voxels{1} | Voxels{1} << (1 + 4);  // they share an edge
  EXPECT_EQ(first_connected(corner), Voxels{1});
  EXPECT_EQ(first_connected(~Voxels{0}), ~Voxels{0});
  const Voxels row = 0xF;  // along x
  EXPECT_EQ(first_connected(row | Voxels{0xF} << 32), row);
  EXPECT_TRUE(touch(row, row, 0));
  EXPECT_FALSE(touch(row, row, 1));
  EXPECT_TRUE(touch(Voxels{0xF} << 48, row, 2));
  // A row ends at its face: the next row's first voxel is no neighbour of its last.
  EXPECT_EQ(first_connected(Voxels{1} << 3 | Voxels{1} << 4), Voxels{1} << 3);
}

// Patch test: a uniform deformation puts no force on nodes inside, and a turn puts none anywhere.
TEST(Bricks, AUniformDeformationIsInEquilibriumAndATurnIsFree) {
  const BrickTissue rest = block(4, 3, 3);
  BrickTissue tissue = rest;
  Mat3 f;
  f << 1.3, 0.1, 0.0, -0.05, 0.9, 0.1, 0.0, 0.05, 0.95;
  map(tissue, f);
  set_tissue_forces(tissue, 0.0F, 0.0F);
  const auto is_inside = [](const Vec3& p) {
    return p.x() > 0.1 && p.x() < 7.9 && p.y() > 0.1 && p.y() < 5.9 && p.z() > 0.1 && p.z() < 5.9;
  };
  const auto all = [](const Vec3&) { return true; };
  EXPECT_LT(most_force(tissue, is_inside, rest), 1e-4 * most_force(tissue, all, rest));

  BrickTissue turned = rest;
  map(turned, Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, 0.5).normalized()).toRotationMatrix());
  set_tissue_forces(turned, 0.0F, 0.0F);
  EXPECT_LT(most_force(turned, all, rest), 1e-4 * most_force(tissue, all, rest));
}

/// Nominal stress of uniaxial stretch of c1 (I1 - 3) + c2 (I1 - 3)² + lambda/2 (J - 1)² - 2 c1 (J - 1), sides free.
double uniaxial_kpa(double stretch) {
  double side = 1.0;
  for (int n = 0; n < 200; ++n) {  // bisection on the side's stress would do; this converges as well
    const double j = stretch * side * side;
    const double shape = 2.0 * kC1 + 4.0 * kC2 * (stretch * stretch + 2.0 * side * side - 3.0);
    const double stress = shape * side + (kLambda * (j - 1.0) - 2.0 * kC1) * stretch * side;
    side -= stress / (8.0 * (kLambda + 2.0 * kC1));
  }
  const double j = stretch * side * side;
  const double shape = 2.0 * kC1 + 4.0 * kC2 * (stretch * stretch + 2.0 * side * side - 3.0);
  return shape * stretch + (kLambda * (j - 1.0) - 2.0 * kC1) * side * side;
}

// A bar whose ends may slip sideways takes up the closed form's force.
TEST(Relaxer, ABarIsPulledAsTheClosedFormSays) {
  for (const double stretch : {1.1, 1.5}) {
    BrickTissue tissue = block(2, 2, 5);
    std::vector<std::size_t> top;
    for (std::size_t n = 1; n < tissue.position.size(); ++n) {
      auto& p = tissue.position[n];
      if (p[2] > 9.9F) top.push_back(n);
      p[2] *= static_cast<float>(stretch);
    }
    Relaxer relaxer;
    double force = 0.0;
    for (int n = 0; n < 1500; ++n) {
      if (n % 20 == 0) bound_masses(tissue, 0.0F);
      set_tissue_forces(tissue, 0.0F, 0.0F);
      force = 0.0;
      for (std::size_t m = 1; m < tissue.position.size(); ++m) {
        const bool is_top = std::find(top.begin(), top.end(), m) != top.end();
        if (is_top) force -= static_cast<double>(tissue.force[m][2]);
        if (is_top || tissue.position[m][2] < 0.1F) tissue.force[m][2] = 0.0F;  // held along the bar
      }
      relaxer.iterate(tissue, 0.0);
    }
    EXPECT_NEAR(force / 16.0, uniaxial_kpa(stretch), 2e-3 * uniaxial_kpa(stretch)) << stretch;
  }
}

// A slit through the whole block, one voxel wide: the two sides have no node in common, and what hangs on nothing goes.
TEST(Bricks, ASlitPartsThemExactly) {
  BrickTissue tissue = block(3, 2, 2);
  const std::size_t nodes = tissue.position.size();
  Voxels plane = 0;  // the second layer of voxels along x
  for (int bit = 0; bit < kVoxels; ++bit)
    if (bit % 4 == 1) plane |= Voxels{1} << bit;
  std::vector<std::pair<int, Voxels>> gone;
  for (int piece = 0; piece < static_cast<int>(tissue.piece_count()); ++piece)
    if (tissue.grid.place_of(tissue.brick_of[static_cast<std::size_t>(piece)])[0] == 1) gone.emplace_back(piece, plane);
  ASSERT_EQ(gone.size(), 4U);
  remove_voxels(tissue, gone);
  EXPECT_EQ(tissue.piece_count(), 16U);                // four bricks became eight pieces
  EXPECT_EQ(tissue.position.size(), nodes + 2U * 9U);  // and each of their eighteen corners two nodes
  std::set<std::int32_t> left, right;
  int volume = 0;
  for (int piece = 0; piece < 16; ++piece) {
    const auto p = static_cast<std::size_t>(piece);
    volume += std::popcount(tissue.voxels_of[p]);
    const bool is_left = tissue.grid.place_of(tissue.brick_of[p])[0] == 0 ||
                         (tissue.grid.place_of(tissue.brick_of[p])[0] == 1 && (tissue.voxels_of[p] & 1) != 0);
    for (int c = 0; c < 8; ++c) (is_left ? left : right).insert(tissue.node(piece, c));
  }
  EXPECT_EQ(volume, 12 * 64 - 4 * 16);
  for (const std::int32_t node : left) EXPECT_FALSE(right.contains(node)) << node;
  // Nothing moved, so nothing is strained.
  set_tissue_forces(tissue, 0.0F, 0.0F);
  for (const auto& f : tissue.force) EXPECT_NEAR(f[0], 0.0F, 1e-3F);
  for (std::size_t n = 1; n < tissue.position.size(); ++n)
    if (tissue.position[n][0] < 0.1F) tissue.is_held[n] = 1;
  EXPECT_EQ(remove_loose(tissue), 4U * 64U + 4U * 32U);
}

// Stress of shape change that relaxes: after a sudden stretch it is 1 + ratio times that at rest, and what is more of
// it goes as exp(-t / time), whatever the steps.
TEST(Bricks, StressRelaxesExponentially) {
  const float ratio = 1.5F, time_s = 8.0F;
  BrickTissue tissue = block(1, 1, 1);
  Mat3 f = Mat3::Identity();
  f(0, 0) = 1.2;
  map(tissue, f);
  const auto pull = [&](float gain) {
    set_tissue_forces(tissue, gain, 0.0F);
    double sum = 0.0;
    for (std::size_t n = 1; n < tissue.position.size(); ++n)
      if (tissue.position[n][0] > 1.0F) sum -= static_cast<double>(tissue.force[n][0]);
    return sum;
  };
  const double relaxed = pull(0.0F);
  set_viscous_since(tissue, ratio, time_s, 0.0F);
  const double sudden = pull(0.0F);
  EXPECT_GT(sudden, 1.2 * relaxed);
  for (const float step_s : {0.5F, 3.5F, 4.0F}) {
    const float gain = begin_step(tissue, ratio, time_s, step_s);
    end_step(tissue, gain);
  }
  EXPECT_NEAR(pull(0.0F) - relaxed, (sudden - relaxed) * std::exp(-1.0), 1e-3 * sudden);
  set_viscous_since(tissue, ratio, time_s, 8.0F);
  EXPECT_NEAR(pull(0.0F) - relaxed, (sudden - relaxed) * std::exp(-1.0), 1e-3 * sudden);
}

TEST(Bricks, AShrunkenPieceIsAtRestWhereItIsSmaller) {
  BrickTissue tissue = block(1, 1, 1);
  shrink(tissue, 0, 0.8F);
  map(tissue, 0.8 * Mat3::Identity());
  set_tissue_forces(tissue, 0.0F, 0.0F);
  for (const auto& force : tissue.force)
    for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(force[a], 0.0F, 1e-4F);
}

}  // namespace
}  // namespace incise::second_bench
