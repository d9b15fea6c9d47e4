#include "mechanics/bodies.hpp"
#include "mechanics/factor_status.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/solvers.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace incise {
namespace {

using testing::clamped_block;
using testing::elastic_forces;
using testing::norm;
using testing::plane_x;

/// Stiffness of a clamped body at rest and a load at its free end.
struct System {
  TissueModel model;
  BlockMatrix matrix;
  Points right;

  explicit System(TissueModel m)
      : model(std::move(m)), matrix(model.pattern), right(model.mesh.vertices.size(), Vec3::Zero()) {
    TissueState state = rest_state(model);
    elastic_forces(model, state, &matrix);
    for (const VertexId v : select(model.mesh, EndRegion{Vec3::UnitX(), 4.0})) right[v.index()] = Vec3(3, -1, 2);
    hold_constrained(model, matrix, right);
  }
  [[nodiscard]] double residual(const Points& x) const {
    Workers workers(1);
    Points product(x.size());
    multiply(matrix, x, product, workers);
    for (std::size_t v = 0; v < x.size(); ++v) product[v] -= right[v];
    return norm(product);
  }
};

PcgReport solve_pcg(const System& system, Points& x, const PcgSettings& settings, int per_aggregate = 20,
                    int threads = 1, Precision precision = Precision::Double) {
  Workers workers(threads);
  TwoLevelPcg solver(system.model.pattern, system.model.mesh.vertices, per_aggregate, precision);
  solver.update(system.matrix, true, workers);
  x.assign(system.right.size(), Vec3::Ones());
  return solver.solve(system.matrix, system.right, x, settings, workers);
}

Points by_cholesky(const System& system) {
  SparseCholesky cholesky(system.model.pattern);
  EXPECT_TRUE(cholesky.factor(system.matrix));
  Points x(system.right.size());
  cholesky.solve(system.right, x);
  return x;
}

double difference(const Points& a, const Points& b) {
  Points d = a;
  for (std::size_t v = 0; v < d.size(); ++v) d[v] -= b[v];
  return norm(d);
}

TEST(SparseCholesky, SolvesToRounding) {
  const System system(clamped_block({6, 4, 4}, 0.49));
  const Points x = by_cholesky(system);
  EXPECT_LT(system.residual(x), 1e-10 * norm(system.right));
}

TEST(SparseCholesky, SaysWhenTheMatrixIsNotPositiveDefinite) {
  System system(clamped_block({3, 2, 2}));
  SparseCholesky cholesky(system.model.pattern);
  system.matrix.block(system.model.pattern->diagonal[1])[0] = -1.0;
  EXPECT_FALSE(cholesky.factor(system.matrix));
}

TEST(SparseCholesky, TakesNoFailureOfCholmodForAMatrixThatIsNotPositiveDefinite) {
  EXPECT_TRUE(is_positive_definite(0));   // CHOLMOD_OK
  EXPECT_FALSE(is_positive_definite(1));  // CHOLMOD_NOT_POSDEF
  EXPECT_FALSE(is_positive_definite(2));  // CHOLMOD_DSMALL
  // Not installed, out of memory, too large, invalid, GPU problem.
  for (const int failure : {-1, -2, -3, -4, -5})
    EXPECT_THROW(static_cast<void>(is_positive_definite(failure)), InvalidArgument) << "status " << failure;
}

TEST(SparseCholesky, RefusesToSolveWithoutAFactor) {
  const System system(clamped_block({3, 2, 2}));
  const SparseCholesky cholesky(system.model.pattern);
  Points x(system.right.size());
  EXPECT_THROW(cholesky.solve(system.right, x), InvalidArgument);
}

TEST(TwoLevelPcg, FindsTheSolutionOfCholesky) {
  const System system(clamped_block({6, 4, 4}, 0.49));
  const Points direct = by_cholesky(system);
  Points iterated;
  const PcgSettings settings{.relative_tolerance = 1e-11};
  const PcgReport report = solve_pcg(system, iterated, settings);
  EXPECT_TRUE(report.converged);
  EXPECT_LT(difference(iterated, direct), 1e-8 * norm(direct));
}

TEST(TwoLevelPcg, StopsAtTheResidualThatWasAskedFor) {
  const System system(clamped_block({6, 4, 4}));
  for (const double tolerance : {1e-1, 1e-3, 1e-6}) {
    Points x;
    const PcgReport report = solve_pcg(system, x, {.relative_tolerance = tolerance});
    EXPECT_TRUE(report.converged);
    EXPECT_LE(report.residual_mn, tolerance * norm(system.right));
    EXPECT_NEAR(system.residual(x), report.residual_mn, 1e-9 * norm(system.right));
  }
}

TEST(TwoLevelPcg, MeasuresAgainstTheReferenceOrItsFloor) {
  const System system(clamped_block({6, 4, 4}));
  Points x;
  PcgSettings settings{.relative_tolerance = 0.1, .reference_mn = 1e-3};
  EXPECT_LE(solve_pcg(system, x, settings).residual_mn, 1e-4);
  settings.floor_mn = 1e6;
  EXPECT_EQ(solve_pcg(system, x, settings).iterations, 0);
  EXPECT_EQ(norm(x), 0.0);
}

TEST(TwoLevelPcg, SaysWhenItRanOutOfIterations) {
  const System system(clamped_block({6, 4, 4}));
  Points x;
  const PcgReport report = solve_pcg(system, x, {.relative_tolerance = 1e-10, .max_iterations = 3});
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 3);
}

TEST(TwoLevelPcg, NeedsFewerIterationsWithMoreAggregates) {
  const System system(clamped_block({24, 8, 6}));
  const PcgSettings settings{.relative_tolerance = 1e-6};
  Points x;
  const int without = solve_pcg(system, x, settings, 1000000).iterations;
  const int with = solve_pcg(system, x, settings, 60).iterations;
  EXPECT_LT(with, 0.7 * without) << "one aggregate: " << without;
}

/// 1485 vertices: 186 aggregates of 8 vertices have a dense coarse inverse, 213 of 7 a cycle over three levels.
TEST(TwoLevelPcg, IsNearlyAsGoodWithThreeLevelsAsWithADenseInverse) {
  const System system(clamped_block({14, 10, 8}, 0.49));
  const PcgSettings settings{.relative_tolerance = 1e-4};
  Points x;
  const int dense = solve_pcg(system, x, settings, 8).iterations;
  const int cycle = solve_pcg(system, x, settings, 7).iterations;
  EXPECT_LE(cycle, 1.3 * dense) << "dense: " << dense;  // found: 112 and 93
}

TEST(TwoLevelPcg, FindsTheSolutionOfCholeskyWithThreeLevels) {
  const System system(clamped_block({14, 10, 8}));
  const Points direct = by_cholesky(system);
  const PcgSettings settings{.relative_tolerance = 1e-10};
  for (const int per_aggregate : {1, 3}) {  // single vertices cannot turn; 1485 and 495 aggregates
    Points iterated;
    EXPECT_TRUE(solve_pcg(system, iterated, settings, per_aggregate).converged) << per_aggregate;
    EXPECT_LT(difference(iterated, direct), 1e-7 * norm(direct)) << per_aggregate;
  }
}

TEST(TwoLevelPcg, WithThreeLevelsGivesTheSameBitsAtAnyThreadCount) {
  const System system(clamped_block({14, 10, 8}));
  const PcgSettings settings{.relative_tolerance = 1e-4};
  Points one;
  Points three;
  const int iterations = solve_pcg(system, one, settings, 5, 1).iterations;
  EXPECT_EQ(solve_pcg(system, three, settings, 5, 3).iterations, iterations);
  EXPECT_EQ(three, one);
}

TEST(TwoLevelPcg, CopesWithAggregatesThatAreHeldAltogetherOrInPart) {
  const Region half = BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(7.6, 13, 10))};
  const Region edge = BoxRegion{Box3(Vec3(7.6, -1, -1), Vec3(21, 0.1, 10))};
  const System system(make_tissue_model(make_block(Vec3(20, 12, 9), {8, 4, 3}), {},
                                        {FixedConstraint{half}, FixedConstraint{edge, {false, true, false}}}));
  const PcgSettings settings{.relative_tolerance = 1e-10};
  for (const int per_aggregate : {1, 3, 10, 40}) {
    Points x;
    EXPECT_TRUE(solve_pcg(system, x, settings, per_aggregate).converged) << per_aggregate;
    EXPECT_LT(system.residual(x), 1e-9 * norm(system.right)) << per_aggregate;
  }
}

TEST(TwoLevelPcg, StaysRightWhileItsCoarsePartIsStale) {
  System system(clamped_block({8, 5, 5}));
  Workers workers(1);
  TwoLevelPcg solver(system.model.pattern, system.model.mesh.vertices, 20);
  solver.update(system.matrix, true, workers);
  // A quarter of the tets are carved, among them all around some vertices.
  TissueState state = rest_state(system.model);
  for (std::size_t t = 0; t < state.is_live.size(); ++t) {
    const Vec3& p = vertex(system.model.mesh.vertices, system.model.mesh.tets[t][0]);
    if (p[0] > 6.0 && p[0] < 12.0 && p[2] > 3.0) state.is_live[t] = 0;
  }
  System carved = system;
  std::fill(carved.matrix.values.begin(), carved.matrix.values.end(), 0.0);
  elastic_forces(carved.model, state, &carved.matrix);
  hold_constrained(carved.model, carved.matrix, carved.right);
  solver.update(carved.matrix, false, workers);
  const PcgSettings settings{.relative_tolerance = 1e-8};
  Points x(carved.right.size());
  EXPECT_TRUE(solver.solve(carved.matrix, carved.right, x, settings, workers).converged);
  EXPECT_LT(carved.residual(x), 1e-7 * norm(carved.right));
}

TEST(TwoLevelPcg, GivesTheSameBitsAtAnyThreadCount) {
  const System system(clamped_block({14, 10, 8}));
  const PcgSettings settings{.relative_tolerance = 1e-4};
  Points one;
  const PcgReport report = solve_pcg(system, one, settings, 40, 1);
  for (const int threads : {2, 4}) {
    Points many;
    EXPECT_EQ(solve_pcg(system, many, settings, 40, threads).iterations, report.iterations);
    EXPECT_EQ(many, one) << threads << " threads";
  }
}

PcgReport solve_in_single_precision(const System& system, Points& x, double tolerance, int threads,
                                    int per_aggregate = 20) {
  return solve_pcg(system, x, {.relative_tolerance = tolerance}, per_aggregate, threads, Precision::Single);
}

TEST(TwoLevelPcg, InSinglePrecisionFindsTheSolutionOfCholesky) {
  const System system(clamped_block({8, 5, 4}, 0.49));
  const Points exact = by_cholesky(system);
  Points x;
  const PcgReport report = solve_in_single_precision(system, x, 1e-4, 1);
  EXPECT_TRUE(report.converged);
  // The matrix is rounded to 2e-5 of its diagonal, but rows still sum to what they summed to: the bar bends as it did.
  // Were they not put right, it would bend by a tenth less.
  EXPECT_LT(difference(x, exact), 5e-3 * norm(exact));
}

TEST(TwoLevelPcg, InSinglePrecisionRefusesAMatrixWhoseNumbersProveItIndefinite) {
  System system(clamped_block({6, 4, 4}));
  const BlockPattern& pattern = *system.model.pattern;
  Workers workers(1);
  TwoLevelPcg solver(system.model.pattern, system.model.mesh.vertices, 20, Precision::Single);
  solver.update(system.matrix, true, workers);
  // Two neighbours that push each other apart far harder than either is held.
  const std::size_t row = pattern.rows() - 1;
  const std::int32_t slot = pattern.row_start[row];
  const auto column = static_cast<std::size_t>(pattern.column[static_cast<std::size_t>(slot)]);
  ASSERT_NE(column, row);
  const auto begin = pattern.column.begin() + pattern.row_start[column];
  const auto end = pattern.column.begin() + pattern.row_start[column + 1];
  const auto mirror =
      static_cast<std::int32_t>(std::lower_bound(begin, end, static_cast<std::int32_t>(row)) - pattern.column.begin());
  for (const std::int32_t at : {slot, mirror})
    system.matrix.block(at)[0] += 1e3 * system.matrix.block(pattern.diagonal[row])[0];
  solver.update(system.matrix, false, workers);
  Points x(system.right.size(), Vec3::Ones());
  const PcgReport report = solver.solve(system.matrix, system.right, x, {}, workers);
  EXPECT_TRUE(report.is_indefinite);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(norm(x), 0.0);
  // An update that leaves those rows as they are does not make the matrix definite.
  solver.update(system.matrix, false, workers, std::vector<std::uint8_t>(pattern.rows(), 0));
  const PcgReport again = solver.solve(system.matrix, system.right, x, {}, workers);
  EXPECT_TRUE(again.is_indefinite);
  EXPECT_EQ(again.iterations, 0);
}

TEST(TwoLevelPcg, InSinglePrecisionTakesAsManyIterationsAsInDouble) {
  const System system(clamped_block({8, 5, 4}, 0.49));
  const PcgSettings settings{.relative_tolerance = 1e-2};
  Points x;
  Points y;
  const int in_double = solve_pcg(system, x, settings).iterations;
  const int in_single = solve_in_single_precision(system, y, 1e-2, 1).iterations;
  EXPECT_NEAR(in_single, in_double, 2);
}

TEST(TwoLevelPcg, InSinglePrecisionTakesAsManyIterationsAsInDoubleWithThreeLevels) {
  const System system(clamped_block({14, 10, 8}, 0.49));
  const PcgSettings settings{.relative_tolerance = 1e-2};
  Points x;
  Points y;
  const int in_double = solve_pcg(system, x, settings, 5).iterations;
  const int in_single = solve_in_single_precision(system, y, 1e-2, 1, 5).iterations;
  EXPECT_NEAR(in_single, in_double, 2);
}

TEST(TwoLevelPcg, TakesTheRowsThatChanged) {
  System system(clamped_block({6, 4, 4}));
  Workers workers(1);
  const PcgSettings settings{.relative_tolerance = 1e-4};
  for (const Precision precision : {Precision::Double, Precision::Single}) {
    TwoLevelPcg solver(system.model.pattern, system.model.mesh.vertices, 20, precision);
    solver.update(system.matrix, true, workers);
    System changed = system;
    std::vector<std::uint8_t> rows(system.right.size(), 0);
    for (std::size_t v = 40; v < rows.size(); v += 7) {  // stiffer along each axis
      rows[v] = 1;
      for (const int i : {0, 4, 8}) changed.matrix.block(system.model.pattern->diagonal[v])[i] *= 2.0;
    }
    Points of_rows(rows.size());
    Points of_all(rows.size());
    solver.update(changed.matrix, false, workers, rows);
    solver.solve(changed.matrix, changed.right, of_rows, settings, workers);
    solver.update(changed.matrix, false, workers);
    solver.solve(changed.matrix, changed.right, of_all, settings, workers);
    EXPECT_EQ(of_rows, of_all);
  }
}

TEST(TwoLevelPcg, InSinglePrecisionGivesTheSameBitsAtAnyThreadCount) {
  const System system(clamped_block({12, 8, 8}, 0.45));
  Points one;
  Points three;
  const PcgReport a = solve_in_single_precision(system, one, 1e-3, 1);
  const PcgReport b = solve_in_single_precision(system, three, 1e-3, 3);
  EXPECT_EQ(a.iterations, b.iterations);
  EXPECT_EQ(one, three);
}

/// Solves for several right sides one after the other, each but the first from the solution before.
struct Chain {
  std::vector<Points> solutions;
  std::vector<int> iterations;
};
Chain solve_chain(const System& system, const std::vector<Points>& right_sides, bool renews, int threads = 1) {
  Workers workers(threads);
  TwoLevelPcg solver(system.model.pattern, system.model.mesh.vertices, 20, Precision::Single);
  const PcgSettings settings{.relative_tolerance = 1e-2, .starts_from_last = true};
  Chain chain;
  for (const Points& right : right_sides) {
    solver.update(system.matrix, renews, workers);
    Points x(right.size());
    const PcgReport report = solver.solve(system.matrix, right, x, settings, workers);
    EXPECT_TRUE(report.converged);
    chain.solutions.push_back(x);
    chain.iterations.push_back(report.iterations);
  }
  return chain;
}

TEST(TwoLevelPcg, InSinglePrecisionStartsFromTheLastSolution) {
  const System system(clamped_block({12, 8, 8}, 0.45));
  Points thrice = system.right;
  for (Vec3& b : thrice) b *= 3.0;
  Points turned = system.right;  // nearly the same load
  for (Vec3& b : turned) b += Vec3(0.0, 0.1 * b.x(), 0.0);
  const std::vector<Points> loads{system.right, system.right, thrice, turned};
  const Chain kept = solve_chain(system, loads, false);
  const Chain renewed = solve_chain(system, loads, true);
  EXPECT_GT(kept.iterations[0], 5);
  EXPECT_EQ(kept.iterations[1], 0) << "it has been solved";
  EXPECT_EQ(kept.iterations[2], 0) << "the solution is the last one, three times";
  EXPECT_LT(difference(kept.solutions[2], renewed.solutions[2]), 0.05 * norm(renewed.solutions[2]));
  EXPECT_LT(kept.iterations[3], renewed.iterations[3]);
  EXPECT_EQ(kept.solutions[0], renewed.solutions[0]);
  EXPECT_EQ(renewed.solutions[1], renewed.solutions[0]) << "a renewed coarse matrix forgets what was before";
  EXPECT_EQ(renewed.iterations[2], kept.iterations[0]);
  const Chain threaded = solve_chain(system, loads, false, 3);
  EXPECT_EQ(threaded.solutions, kept.solutions);
}

TEST(TwoLevelPcg, InSinglePrecisionALastSolutionOfNoUseDoesNoHarm) {
  const System system(clamped_block({12, 8, 8}, 0.45));
  Points other(system.right.size(), Vec3::Zero());
  for (std::size_t v = 0; v < other.size(); v += 5) other[v] = Vec3(0.0, v % 2 == 0 ? 1.0 : -1.0, 0.5);
  Points right_side = other;
  BlockMatrix matrix = system.matrix;
  hold_constrained(system.model, matrix, right_side);
  const Chain kept = solve_chain(system, {system.right, right_side}, false);
  const Chain renewed = solve_chain(system, {system.right, right_side}, true);
  EXPECT_LE(kept.iterations[1], renewed.iterations[1] + 1);
}

TEST(TwoLevelPcg, RefusesAMatrixWithANegativeDiagonal) {
  System system(clamped_block({3, 2, 2}));
  Workers workers(1);
  TwoLevelPcg solver(system.model.pattern, system.model.mesh.vertices);
  system.matrix.block(system.model.pattern->diagonal[1])[0] = -1.0;
  EXPECT_THROW(solver.update(system.matrix, true, workers), InvalidArgument);
}

TEST(TwoLevelPcg, RefusesToSolveBeforeItsFirstUpdate) {
  const System system(clamped_block({3, 2, 2}));
  Workers workers(1);
  TwoLevelPcg solver(system.model.pattern, system.model.mesh.vertices);
  Points x(system.right.size());
  EXPECT_THROW(solver.solve(system.matrix, system.right, x, {}, workers), InvalidArgument);
}

}  // namespace
}  // namespace incise
