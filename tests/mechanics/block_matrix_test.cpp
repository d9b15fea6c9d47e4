#include "mechanics/bodies.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/block_matrix.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

using testing::clamped_block;
using testing::dense;

BlockMatrix random_matrix(const TissueModel& model) {
  BlockMatrix matrix(model.pattern);
  Random random(3);
  for (double& value : matrix.values) value = random.uniform(-1.0, 1.0);
  return matrix;
}

TEST(BlockPattern, HoldsEachPairOfVerticesThatShareATet) {
  const TissueModel model = clamped_block();
  const BlockPattern& pattern = *model.pattern;
  for (std::size_t t = 0; t < model.mesh.tets.size(); ++t) {
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) {
        const std::int32_t slot = model.tet_slots[t][4 * a + b];
        const std::size_t row = model.mesh.tets[t][a].index();
        ASSERT_GE(slot, pattern.row_start[row]);
        ASSERT_LT(slot, pattern.row_start[row + 1]);
        ASSERT_EQ(pattern.column[static_cast<std::size_t>(slot)], model.mesh.tets[t][b].value);
      }
    }
  }
}

TEST(BlockPattern, ColumnsAscendAndTheDiagonalIsFound) {
  const TissueModel model = clamped_block();
  const BlockPattern& pattern = *model.pattern;
  for (std::size_t row = 0; row < pattern.rows(); ++row) {
    EXPECT_EQ(pattern.column[static_cast<std::size_t>(pattern.diagonal[row])], static_cast<std::int32_t>(row));
    for (auto slot = pattern.row_start[row] + 1; slot < pattern.row_start[row + 1]; ++slot) {
      EXPECT_LT(pattern.column[static_cast<std::size_t>(slot) - 1], pattern.column[static_cast<std::size_t>(slot)]);
    }
  }
}

TEST(Multiply, AgreesWithTheDenseProduct) {
  const TissueModel model = clamped_block();
  const BlockMatrix matrix = random_matrix(model);
  Points x = model.mesh.vertices;
  Points y(x.size());
  Workers workers(1);
  multiply(matrix, x, y, workers);
  const Eigen::Map<const Eigen::VectorXd> flat_x(x[0].data(), static_cast<Eigen::Index>(3 * x.size()));
  const Eigen::Map<const Eigen::VectorXd> flat_y(y[0].data(), static_cast<Eigen::Index>(3 * y.size()));
  EXPECT_LT((dense(matrix) * flat_x - flat_y).norm(), 1e-13 * flat_y.norm());
}

TEST(Multiply, GivesTheSameBitsAtAnyThreadCount) {
  const TissueModel model = clamped_block({14, 12, 10});
  const BlockMatrix matrix = random_matrix(model);
  const Points x = model.mesh.vertices;
  Points one(x.size());
  Points four(x.size());
  Workers alone(1);
  Workers team(4);
  multiply(matrix, x, one, alone);
  multiply(matrix, x, four, team);
  EXPECT_EQ(one, four);
}

TEST(Multiply, RefusesAVectorOfAnotherLength) {
  const TissueModel model = clamped_block();
  Points x(3);
  Points y(model.mesh.vertices.size());
  Workers workers(1);
  EXPECT_THROW(multiply(BlockMatrix(model.pattern), x, y, workers), InvalidArgument);
}

}  // namespace
}  // namespace incise
