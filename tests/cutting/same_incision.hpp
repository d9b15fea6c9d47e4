#pragma once

#include <incise/cutting/incision.hpp>

#include <gtest/gtest.h>

namespace incise::testing {

/// Expects two contours to be there with the same points, or neither.
inline void expect_same_contour(const std::optional<Contour>& expected, const std::optional<Contour>& found) {
  ASSERT_EQ(expected.has_value(), found.has_value());
  if (expected.has_value()) {
    EXPECT_EQ(expected->points, found->points);
  }
}

/// Expects two incisions to be the same to the last bit, in everything but the time that they took.
inline void expect_same(const IncisionResult& expected, const IncisionResult& found, const std::string& which) {
  SCOPED_TRACE(which);
  EXPECT_EQ(expected.outcome, found.outcome);
  EXPECT_EQ(expected.final_state.tissue.positions, found.final_state.tissue.positions);
  EXPECT_EQ(expected.final_state.tissue.is_live, found.final_state.tissue.is_live);
  EXPECT_EQ(expected.final_state.time_s, found.final_state.time_s);
  ASSERT_EQ(expected.record.removals.size(), found.record.removals.size());
  for (std::size_t i = 0; i < expected.record.removals.size(); ++i) {
    const Removal& a = expected.record.removals[i];
    const Removal& b = found.record.removals[i];
    const bool is_same = a.tet == b.tet && a.step == b.step && a.time_s == b.time_s && a.cause == b.cause &&
                         a.centroid_mm == b.centroid_mm && a.rest_volume_mm3 == b.rest_volume_mm3;
    ASSERT_TRUE(is_same) << "removal " << i;
  }
  ASSERT_EQ(expected.steps.size(), found.steps.size());
  for (std::size_t i = 0; i < expected.steps.size(); ++i) {
    const CutStepLog& a = expected.steps[i];
    const CutStepLog& b = found.steps[i];
    const bool is_same = a.time_s == b.time_s && a.iterations == b.iterations && a.converged == b.converged &&
                         a.tets_in_contact == b.tets_in_contact && a.removed == b.removed &&
                         a.held_back_vertices == b.held_back_vertices && a.tool_force_mn == b.tool_force_mn;
    ASSERT_TRUE(is_same) << "step " << i;
  }
  ASSERT_EQ(expected.frames.size(), found.frames.size());
  for (std::size_t i = 0; i < expected.frames.size(); ++i) {
    EXPECT_EQ(expected.frames[i].time_s, found.frames[i].time_s) << "frame " << i;
    EXPECT_EQ(expected.frames[i].positions, found.frames[i].positions) << "frame " << i;
    EXPECT_EQ(expected.frames[i].step, found.frames[i].step) << "frame " << i;
  }
  EXPECT_EQ(expected.solver_iterations, found.solver_iterations);
  EXPECT_EQ(expected.held_back_vertices, found.held_back_vertices);
  EXPECT_EQ(expected.peak_tool_force_mn, found.peak_tool_force_mn);
  expect_same_contour(expected.centerline, found.centerline);
  expect_same_contour(expected.inner_edge, found.inner_edge);
}

}  // namespace incise::testing
