#include "kerf.hpp"
#include "support/directions.hpp"

#include <incise/core/error.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace incise {
namespace {

constexpr double kRadiusMm = 9.0;
const Vec3 kMiddle(16.0, 16.0, 8.0);

ToolPath ring(double depth_mm, double turn = 1.0) {
  ToolPath path;
  for (int i = 0; i < 32; ++i) {
    const double angle = turn * 2.0 * M_PI * i / 32.0;
    const Vec3 outward(std::cos(angle), std::sin(angle), 0.0);
    path.waypoints.push_back({kMiddle + kRadiusMm * outward, kDown, depth_mm, 7.0});
    path.tumor_edge.points.push_back(kMiddle + (kRadiusMm - 5.0) * outward);
  }
  return path;
}

ToolPath line() {
  ToolPath path{.is_closed = false};
  for (int i = 0; i < 8; ++i) path.waypoints.push_back({Vec3(8.0 + 2.0 * i, 16.0, 8.0), kDown, 4.0, 7.0});
  return path;
}

IncisionSettings coarse_settings() {
  IncisionSettings settings{.tool = Needle{.diameter_mm = 1.6}};
  settings.cut.reach_mm = 0.4;
  settings.cut.advance_per_step_mm = 0.8;
  settings.cut.dullness = 2.0;
  settings.cut.bond_stiffness_kpa_mm2 = 0.0;
  return settings;
}

const TissueModel& block() {
  static const TissueModel model =
      make_tissue_model(make_block({32, 32, 8}, {24, 24, 6}), Material{},
                        {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(33, 33, 0.1))}}});
  return model;
}

/// A ring of 4 mm depth in tissue that nothing drags, cut once for all tests.
const IncisionResult& frozen_ring() {
  static const IncisionResult result = [] {
    Workers workers(1);
    Monitor silent;
    return simulate_incision(block(), rest_state(block()), ring(4.0), coarse_settings(), workers, silent);
  }();
  return result;
}

TEST(KerfMeasures, TheKerfsSurfaceEnclosesTheRemovedTets) {
  const KerfBody& body = frozen_ring().kerf.body;
  ASSERT_GT(frozen_ring().record.removals.size(), 100U);
  EXPECT_NEAR(body.volume_mm3, frozen_ring().record.removed_volume_mm3(), 1e-9 * body.volume_mm3)
      << "nothing is stretched here";
  EXPECT_EQ(body.boundary.open_edges, 0U);
  EXPECT_EQ(body.live_skin.open_edges, 0U);
  EXPECT_EQ(body.boundary.triangles, body.surface.triangles.size());
}

TEST(KerfMeasures, TheVolumeIsThatOfTheConfigurationInWhichTheKerfIsMeasured) {
  Points doubled = block().mesh.vertices;
  for (Vec3& p : doubled) p.x() *= 2.0;
  std::vector<std::uint8_t> is_live(block().mesh.tets.size(), 1);
  is_live[100] = is_live[101] = 0;
  EXPECT_NEAR(kerf_body(block().mesh, doubled, is_live).volume_mm3,
              2.0 * (block().volumes_mm3[100] + block().volumes_mm3[101]), 1e-9);
}

TEST(KerfMeasures, TissueThatHangsByAnEdgeIsCountedOnItsSkin) {
  const TissueModel model =
      make_tissue_model(make_block({2, 2, 1}, {2, 2, 1}), Material{}, {FixedConstraint{EndRegion{Vec3::UnitX(), 0.1}}});
  std::vector<std::uint8_t> is_live(model.mesh.tets.size(), 0);
  for (std::size_t t = 0; t < is_live.size(); ++t) {
    Vec3 middle = Vec3::Zero();
    for (const VertexId v : model.mesh.tets[t]) middle += 0.25 * vertex(model.mesh.vertices, v);
    is_live[t] = (middle.x() < 1.0) == (middle.y() < 1.0) ? 1 : 0;
  }
  EXPECT_EQ(kerf_body(model.mesh, model.mesh.vertices, is_live).live_skin.nonmanifold_edges, 1U);
}

TEST(KerfMeasures, EachLayerOfAnUndraggedRingHasItsMidLineOnThePath) {
  const std::vector<KerfLayer>& layers = frozen_ring().kerf.layers;
  ASSERT_EQ(layers.size(), 4U);
  for (const KerfLayer& layer : layers) {
    if (layer.depth_mm > 4.0) continue;
    ASSERT_TRUE(layer.centerline) << layer.depth_mm;
    EXPECT_TRUE(*layer.is_closed);
    double radius = 0.0;
    for (const Vec3& p : layer.centerline->points) {
      radius +=
          std::hypot(p.x() - kMiddle.x(), p.y() - kMiddle.y()) / static_cast<double>(layer.centerline->points.size());
      EXPECT_NEAR(p.z(), 8.0 - layer.depth_mm, 1e-6);
    }
    EXPECT_NEAR(radius, kRadiusMm, 0.15) << layer.depth_mm;  // an eighth of the cells' edge
  }
}

TEST(KerfMeasures, ALayerBelowThePlannedDepthIsNotLookedFor) {
  const KerfLayer& deepest = frozen_ring().kerf.layers.back();
  EXPECT_EQ(deepest.depth_mm, 5.0);
  EXPECT_FALSE(deepest.is_within_plan);
  EXPECT_FALSE(deepest.centerline);
  EXPECT_FALSE(deepest.is_closed);
}

TEST(KerfMeasures, TheDepthReachedIsTheToolsTipAndItsReach) {
  const DepthReached& depth = frozen_ring().kerf.depth;
  EXPECT_NEAR(depth.planned_mm, 4.0, 1e-12);
  EXPECT_GT(depth.depth_mm.min, 4.0);
  EXPECT_LT(depth.depth_mm.mean, 4.0 + 1.2 + 1.4) << "tip, reach of 1.2 mm, and at most one cell";
}

TEST(KerfMeasures, InTissueThatDoesNotMoveBothConfigurationsAreTheSame) {
  const IncisionResult& result = frozen_ring();
  ASSERT_TRUE(result.kerf.final_centerline && result.kerf.inner_edge_reference);
  for (std::size_t i = 0; i < result.centerline->points.size(); ++i) {
    EXPECT_LT((result.kerf.final_centerline->points[i] - result.centerline->points[i]).norm(), 1e-9);
  }
  for (std::size_t i = 0; i < result.inner_edge->points.size(); ++i) {
    EXPECT_LT((result.kerf.inner_edge_reference->points[i] - result.inner_edge->points[i]).norm(), 1e-9);
  }
}

TEST(KerfMeasures, AMidLineMovesWithTheTissueOnBothItsSides) {
  const IncisionResult& result = frozen_ring();
  Points parted = block().mesh.vertices;  // the plug is lifted by 1 mm, the tissue outside stays
  for (Vec3& p : parted) {
    if (std::hypot(p.x() - kMiddle.x(), p.y() - kMiddle.y()) < kRadiusMm) p.z() += 1.0;
  }
  const auto moved = carried_with_live(
      *result.centerline, 4.0, kDown, skin_of(block().mesh, block().mesh.vertices),
      displacement_of_live(block().mesh, result.final_state.tissue.is_live, block().mesh.vertices, parted));
  ASSERT_TRUE(moved);
  for (const Vec3& p : moved->points)
    EXPECT_NEAR(p.z(), 8.5, 0.3) << "tets at the kerf's rough wall extrapolate a little";
}

TEST(KerfMeasures, UndraggedTissueHasNeitherLagNorDrift) {
  const auto& drag = frozen_ring().kerf.drag;
  ASSERT_TRUE(drag);
  EXPECT_LT(std::max(std::abs(drag->lag.min), drag->lag.max), 1e-6);
  EXPECT_LT(std::max(std::abs(drag->drift.min), drag->drift.max), 1e-6);
}

/// What tet 500 tells when it goes at a time, displaced by u.
TissueDrag drag_of_one(const ToolPath& path, double time_s, const Vec3& u, RemovalCause cause = RemovalCause::Dwell) {
  Vec3 place = u;
  for (const VertexId v : block().mesh.tets[500]) place += 0.25 * vertex(block().mesh.vertices, v);
  CutState state;
  state.record.removals.push_back({TetId(500), 7, time_s, cause, place, block().volumes_mm3[500]});
  return tissue_drag(block(), nullptr, block().mesh.vertices, path, coarse_settings(), state).value_or(TissueDrag{});
}

TEST(TissueDrag, OfAnOpenCutIsAheadAndToTheLeft) {
  const double speed = coarse_settings().cut.speed_mm_s;
  const TissueDrag drag =
      drag_of_one(line(), (4.0 + 5.0) / speed, Vec3(0.3, -0.2, 0.1));  // 4 mm of plunge, 5 mm of way
  ASSERT_EQ(drag.lag_mm.size(), 1U);
  EXPECT_NEAR(drag.lag_mm[0], 0.3, 1e-12);
  EXPECT_NEAR(drag.drift_mm[0], -0.2, 1e-12);
  EXPECT_NEAR(drag.arclength_mm[0], 5.0, 1e-9);
}

TEST(TissueDrag, OfARingIsPositiveOutwardsWhicheverWayItRuns) {
  for (const double turn : {1.0, -1.0}) {
    const double quarter = 32.0 * 2.0 * kRadiusMm * std::sin(M_PI / 32.0) / 4.0;
    const TissueDrag drag =
        drag_of_one(ring(4.0, turn), (4.0 + quarter) / coarse_settings().cut.speed_mm_s, Vec3(0.0, turn * 0.4, 0.0));
    ASSERT_EQ(drag.drift_mm.size(), 1U);
    EXPECT_NEAR(drag.drift_mm[0], 0.4, 1e-3) << turn;
    EXPECT_NEAR(drag.lag_mm[0], 0.0, 1e-3) << turn;
  }
}

TEST(TissueDrag, WhilePlungingIsMeasuredAlongTheWayAhead) {
  const TissueDrag drag = drag_of_one(line(), 0.1, Vec3(0.3, 0.0, 0.0));
  ASSERT_EQ(drag.lag_mm.size(), 1U);
  EXPECT_NEAR(drag.lag_mm[0], 0.3, 1e-12);
  EXPECT_EQ(drag.arclength_mm[0], 0.0);
}

TEST(TissueDrag, LeavesLooseFragmentsOut) {
  EXPECT_TRUE(drag_of_one(line(), 0.5, Vec3::Zero(), RemovalCause::LooseFragment).lag_mm.empty());
}

/// A box as a closed surface.
TriMesh box(const Vec3& low, const Vec3& high) {
  TriMesh surface = boundary_surface(make_block(high - low, {4, 4, 4}));
  for (Vec3& p : surface.vertices) p += low;
  return surface;
}

/// The deep margin of a box-shaped kerf to a tumour of 4 x 4 x 2 mm whose deepest point lies at z = 6.
std::optional<DeepMargin> margin_of(const Vec3& low, const Vec3& high) {
  IncisionSettings settings{.tumor_surface = box(Vec3(0, 0, 6), Vec3(4, 4, 8))};
  KerfBody body{.surface = box(low, high)};
  DepthReached depth;
  depth.profile.course.points = {Vec3(0, 0, 8), Vec3(1, 0, 8)};
  depth.profile.depth_mm = {1.5, 3.0};
  return deep_margin(body, depth, settings);
}

TEST(DeepMargin, OfAWallBesideTheTumourIsLateral) {
  const auto margin = margin_of(Vec3(7, -2, 4), Vec3(8, 6, 8));
  ASSERT_TRUE(margin);
  EXPECT_NEAR(margin->nearest_mm, 3.0, 1e-12);
  EXPECT_NEAR(*margin->beside_mm, 3.0, 1e-12);
  EXPECT_FALSE(margin->beneath_mm);
}

TEST(DeepMargin, OfAFloorBeneathTheTumourIsDeep) {
  const auto margin = margin_of(Vec3(0, 0, 2), Vec3(4, 4, 4.5));
  ASSERT_TRUE(margin);
  EXPECT_NEAR(*margin->beneath_mm, 1.5, 1e-12);
  EXPECT_FALSE(margin->beside_mm);
}

TEST(DeepMargin, IsNegativeWhereTheKerfEntersTheTumour) {
  const auto margin = margin_of(Vec3(3, 1, 6.5), Vec3(7, 3, 7.5));
  ASSERT_TRUE(margin);
  EXPECT_NEAR(margin->nearest_mm, -1.0, 1e-12) << "its middle lies 1 mm within the side, the floor and the top";
}

TEST(DeepMargin, SaysHowMuchDeeperThanTheTumourTheFloorOfTheKerfLies) {
  const auto margin = margin_of(Vec3(7, -2, 4), Vec3(8, 6, 8));
  EXPECT_NEAR(margin->floor_below_mm.min, -0.5, 1e-12);
  EXPECT_NEAR(margin->floor_below_mm.max, 1.0, 1e-12);
}

TEST(DeepMargin, IsAbsentWithoutATumourSurface) {
  IncisionSettings settings;
  KerfBody body{.surface = box(Vec3::Zero(), Vec3::Ones())};
  EXPECT_FALSE(deep_margin(body, {}, settings));
}

TEST(DeepMargin, RefusesASurfaceThatIsInsideOut) {
  IncisionSettings settings{.tumor_surface = box(Vec3::Zero(), Vec3::Ones())};
  for (Triangle& t : settings.tumor_surface.triangles) std::swap(t[0], t[1]);
  KerfBody body{.surface = box(Vec3::Zero(), Vec3::Ones())};
  EXPECT_THROW(static_cast<void>(deep_margin(body, {}, settings)), InvalidArgument);
}

TEST(ShallowestClosedRing, IsTheFirstLayerThatClosedLiftedToTheSkin) {
  const auto layer = [](double depth_mm, std::optional<bool> is_closed, double width_mm) {
    KerfLayer made{.depth_mm = depth_mm,
                   .is_within_plan = true,
                   .is_closed = is_closed,
                   .gap_mm = {},
                   .gap_place_mm = {},
                   .width_mm = width_mm,
                   .centerline = Contour{}};
    made.centerline->points = {kMiddle + depth_mm * kDown, kMiddle + depth_mm * kDown + Vec3(depth_mm, 0, 0)};
    return made;
  };
  KerfMeasures kerf;
  kerf.layers = {layer(0.5, false, 1.0), layer(1.5, true, 0.8), layer(2.5, true, 0.6)};
  const ClosedRing ring = shallowest_closed_ring(kerf, kDown).value();
  EXPECT_EQ(ring.depth_mm, 1.5);
  EXPECT_EQ(ring.half_width_mm, 0.4);
  EXPECT_LT((ring.midline.points[0] - kMiddle).norm(), 1e-12);
  EXPECT_LT((ring.midline.points[1] - kMiddle - Vec3(1.5, 0, 0)).norm(), 1e-12);

  kerf.layers[1].centerline.reset();
  EXPECT_EQ(shallowest_closed_ring(kerf, kDown).value().depth_mm, 2.5);
  kerf.layers = {layer(0.5, false, 1.0), layer(1.5, std::nullopt, 0.8)};
  EXPECT_FALSE(shallowest_closed_ring(kerf, kDown));
}

}  // namespace
}  // namespace incise
