#include "second_bench/body_state.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/raster.hpp>
#include <incise/second_bench/readings.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace incise::second_bench {
namespace {

constexpr Resolution kCoarse{.brick_mm = 2.6, .coarse_mm = 7.0, .way_mm = 0.6, .relaxations = 12};

Specimen plain(double youngs_modulus_kpa = 12.0) {
  Specimen specimen;
  specimen.seed = 4;
  specimen.tumor_diameter_mm = 14.0;
  specimen.youngs_modulus_kpa = youngs_modulus_kpa;
  return specimen;
}

const Body& plain_body() {
  static const Body body = [] {
    Monitor quiet;
    return make_body(plain(), kCoarse, quiet);
  }();
  return body;
}

/// A ring outside the tumour's edge, straight down, with 8 mm of overlap.
std::vector<TipPose> ring(const Body& body, double speed_mm_s) {
  const Contour edge = tumor_edge_of(*body.state);
  const Vec3 middle = curve_centroid(edge);
  std::vector<TipPose> course;
  double time = 0.0, way = 0.0;
  const auto tip = [&](std::size_t n) {
    const Vec3 p = edge.points[n % edge.points.size()];
    const Vec2 out = (p - middle).head<2>();
    Vec3 q = p;
    q.head<2>() += 5.0 * out.normalized();
    q.z() -= 5.5;
    return q;
  };
  course.push_back({0.0, tip(0) + 6.0 * Vec3::UnitZ(), -Vec3::UnitZ(), true});
  for (std::size_t n = 0; n < edge.points.size() || way < 8.0; ++n) {
    const double step = (tip(n) - course.back().tip_mm).norm();
    time += step / speed_mm_s;
    if (n >= edge.points.size()) way += step;
    course.push_back({time, tip(n), -Vec3::UnitZ(), true});
  }
  return course;
}

const Cut& cut_at(double speed_mm_s, double power_w) {
  static std::map<std::pair<double, double>, Cut> made;
  const auto key = std::pair(speed_mm_s, power_w);
  if (!made.contains(key)) {
    Monitor quiet;
    made[key] = cut_specimen(plain_body(), ring(plain_body(), speed_mm_s), power_w, quiet);
  }
  return made.at(key);
}

double mean_abs(const std::vector<double>& errors) {
  double sum = 0.0;
  for (const double e : errors) sum += std::abs(e) / static_cast<double>(errors.size());
  return sum;
}

TEST(SecondBody, IsHeldStretchedAndPulled) {
  const Body& body = plain_body();
  EXPECT_EQ(body.outcome, Outcome::Success);
  EXPECT_GT(body.stretch_force_n, 0.3);
  const Contour edge = tumor_edge_of(*body.state), rest = tumor_edge_rest_of(*body.state);
  // Pulled 20 mm at the tip: the edge lies some way towards it, and is longer than it was.
  EXPECT_LT(curve_centroid(edge).y(), curve_centroid(rest).y() - 4.0);
  EXPECT_GT(bounding_box(edge.points).sizes().y(), 1.02 * bounding_box(rest.points).sizes().y());
}

TEST(SecondBody, TheGaugeReadsMoreTheSoonerAfterTheStretch) {
  Monitor quiet;
  Specimen soon = plain();
  soon.gauge_s = 2.0;
  const Body body = make_body(soon, kCoarse, quiet);
  EXPECT_GT(body.gauge_force_n, 1.3 * plain_body().gauge_force_n);
  // When the cut begins both have relaxed, to within what is called at rest.
  EXPECT_NEAR(body.stretch_force_n, plain_body().stretch_force_n, 0.01 * plain_body().stretch_force_n);
}

// Every pixel round the tumour shows skin, and neighbours show neighbouring tissue.
TEST(SecondBody, TheSkinHasNoGaps) {
  const SeenTissue seen = seen_from_above(*plain_body().state);
  const Box3 box = bounding_box(seen.tumor_edge.points);
  const RasterGrid grid = grid_around(box.min().head<2>(), box.max().head<2>(), 0.07, 8.0);
  const DepthBuffer view = depth_buffer(grid, seen.vertices, seen.triangles);
  std::size_t gaps = 0;
  double most_step_mm = 0.0;
  for (int j = 0; j < grid.height; ++j)
    for (int i = 0; i < grid.width; ++i) {
      const std::size_t n = grid.offset(i, j);
      if (view.triangles[n] < 0 || seen.is_skin[static_cast<std::size_t>(view.triangles[n])] == 0) ++gaps;
      if (i > 0) most_step_mm = std::max(most_step_mm, std::abs(view.heights_mm[n] - view.heights_mm[n - 1]));
    }
  EXPECT_EQ(gaps, 0U);
  EXPECT_LT(most_step_mm, 0.2);
}

TEST(SecondCut, ClosesErrsInwardAndIsTheSameTwice) {
  const Cut& cut = cut_at(7.0, 35.0);
  const auto errors = true_errors_mm(cut, 4.5);
  ASSERT_TRUE(errors.has_value());
  EXPECT_GT(mean_abs(*errors), 0.4);
  EXPECT_LT(mean_abs(*errors), 3.0);
  Monitor quiet;
  const Cut again = cut_specimen(plain_body(), ring(plain_body(), 7.0), 35.0, quiet);
  EXPECT_EQ(again.after->tissue.position, cut.after->tissue.position);
  EXPECT_EQ(again.after->tissue.voxels_of, cut.after->tissue.voxels_of);
}

// As it was when the laboratory was frozen (docs/models/second_bench.md, Frozen): laws and their constants.
TEST(SecondCut, IsCutByTheLawsThatWereFrozen) {
  struct Kept {
    double speed_mm_s, power_w, error_mm, force_mn;
  };
  for (const Kept& kept :
       {Kept{7.0, 35.0, -0.850, 458.2}, Kept{4.0, 35.0, -0.720, 261.6}, Kept{2.0, 35.0, -0.665, 148.0}}) {
    const Cut& cut = cut_at(kept.speed_mm_s, kept.power_w);
    const auto errors = true_errors_mm(cut, 4.5);
    ASSERT_TRUE(errors.has_value());
    double mean = 0.0;
    for (const double e : *errors) mean += e / static_cast<double>(errors->size());
    EXPECT_NEAR(mean, kept.error_mm, 0.05) << kept.speed_mm_s;
    EXPECT_NEAR(cut.mean_force_mn, kept.force_mn, 0.03 * kept.force_mn) << kept.speed_mm_s;
  }
}

TEST(SecondCut, AFasterToolPushesHarderAndErrsMore) {
  const auto slow = true_errors_mm(cut_at(2.0, 35.0), 4.5), fast = true_errors_mm(cut_at(7.0, 35.0), 4.5);
  ASSERT_TRUE(slow && fast);
  EXPECT_LT(cut_at(2.0, 35.0).mean_force_mn, 0.7 * cut_at(7.0, 35.0).mean_force_mn);
  EXPECT_LT(mean_abs(*slow), mean_abs(*fast));
}

// The order of paper II-B.3: at 25 W tissue piles up, at 30 W less, at 40 W still less; heat parts the more.
TEST(SecondCut, ThePowerSeriesHasThePapersOrder) {
  const Cut &weak = cut_at(7.0, 25.0), &less = cut_at(7.0, 30.0), &more = cut_at(7.0, 40.0);
  EXPECT_GT(weak.mean_force_mn, less.mean_force_mn);
  EXPECT_GT(less.mean_force_mn, cut_at(7.0, 35.0).mean_force_mn);
  EXPECT_GT(cut_at(7.0, 35.0).mean_force_mn, more.mean_force_mn);
  EXPECT_LT(weak.parted_by_heat, less.parted_by_heat);
  EXPECT_LT(less.parted_by_heat, more.parted_by_heat);
  EXPECT_FALSE(inner_edge_of(seen_from_above(*weak.after)).has_value());
}

// As a person draws it: no spikes where a ray would find a crack in the skin.
TEST(SecondCut, TheInnerEdgeIsAnEvenLine) {
  const auto edge = inner_edge_of(seen_from_above(*cut_at(7.0, 35.0).after));
  ASSERT_TRUE(edge.has_value());
  const Vec3 middle = curve_centroid(tumor_edge_of(*cut_at(7.0, 35.0).after));
  for (std::size_t n = 0; n < edge->points.size(); ++n) {
    const auto radius = [&](std::size_t k) {
      return (edge->points[k % edge->points.size()] - middle).head<2>().norm();
    };
    EXPECT_LT(std::abs(radius(n + 4) - radius(n)), 1.0) << n;
  }
}

TEST(SecondCut, StepsFollowTheWayAndADwell) {
  // 6 mm at 7 mm/s, then 2 s of dwelling: ten steps of 0.6 mm and four of half a second.
  const Vec3 tip = tumor_edge_of(*plain_body().state).points.front() - 5.0 * Vec3::UnitZ();
  const std::vector<TipPose> course{{0.0, tip + 6.0 * Vec3::UnitZ(), -Vec3::UnitZ(), true},
                                    {6.0 / 7.0, tip, -Vec3::UnitZ(), true},
                                    {6.0 / 7.0 + 2.0, tip, -Vec3::UnitZ(), true}};
  Monitor quiet;
  EXPECT_EQ(cut_specimen(plain_body(), course, 35.0, quiet).steps, 10 + 4);
  EXPECT_THROW((void)cut_specimen(plain_body(), {course[0], course[0]}, 35.0, quiet), InvalidArgument);
  TipPose at_once = course[1];
  at_once.time_s = course[0].time_s;
  EXPECT_THROW((void)cut_specimen(plain_body(), {course[0], at_once}, 35.0, quiet), InvalidArgument);
  EXPECT_THROW((void)cut_specimen(plain_body(), course, std::nan(""), quiet), InvalidArgument);
}

TEST(SecondCut, HeatShrinksTheRim) {
  Monitor quiet;
  Specimen specimen = plain();
  specimen.shrinking = 0.2;
  const Body body = make_body(specimen, kCoarse, quiet);
  const Cut cut = cut_specimen(body, ring(body, 4.0), 35.0, quiet);
  const auto errors = true_errors_mm(cut, 4.5), without = true_errors_mm(cut_at(4.0, 35.0), 4.5);
  ASSERT_TRUE(errors && without);
  double mean = 0.0, mean_without = 0.0;
  for (const double e : *errors) mean += e / static_cast<double>(errors->size());
  for (const double e : *without) mean_without += e / static_cast<double>(without->size());
  EXPECT_LT(mean, mean_without - 0.02);
}

TEST(SecondReadings, TheArmIsOffAndLate) {
  std::vector<TipPose> asked;
  for (int n = 0; n <= 100; ++n) asked.push_back({0.02 * n, Vec3(0.14 * n, 0.0, 0.0), -Vec3::UnitZ(), true});
  Specimen specimen;
  specimen.wander_mm = 0.0;
  specimen.hand_eye_y_mm = 0.8;
  specimen.lag_s = 0.05;
  const std::vector<TipPose> real = tip_course(asked, specimen, Mat4::Identity());
  // 7 mm/s, 50 ms late.
  EXPECT_NEAR(asked.back().tip_mm.x() - real.back().tip_mm.x(), 0.35, 0.08);
  EXPECT_NEAR(real.back().tip_mm.y(), 0.8, 1e-9);
}

// The picture's camera looks askew and from near: places above the tumour's edge seem farther out.
TEST(SecondReadings, ThePhotographIsInPerspective) {
  Body body = plain_body();
  body.specimen.camera_distance_mm = 200.0;
  const Cut& cut = cut_at(7.0, 35.0);
  const SeenTissue straight = seen_from_above(*cut.after), seen = seen_by_camera(body, cut);
  const Vec3 middle = curve_centroid(straight.tumor_edge);
  for (std::size_t n = 0; n < seen.vertices.size(); n += 97) {
    const Vec3 p = straight.vertices[n] - middle;
    EXPECT_NEAR((seen.vertices[n] - middle).head<2>().norm(), p.head<2>().norm() * 200.0 / (200.0 - p.z()), 1e-6);
  }
}

}  // namespace
}  // namespace incise::second_bench
