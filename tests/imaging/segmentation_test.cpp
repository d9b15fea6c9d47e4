#include "support/monitors.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/iso_surface.hpp>
#include <incise/imaging/made_skin.hpp>
#include <incise/imaging/phantom.hpp>
#include <incise/imaging/segmentation.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace incise {
namespace {

using ::testing::HasSubstr;

// A CT whose voxels show, without noise, the mean of `hu` over 4³ points each.
CtVolume scan_of(const VolumeGrid& grid, const std::function<double(const Vec3&)>& hu) {
  constexpr int kSamples = 4;
  CtVolume ct{grid, std::vector<std::int16_t>(grid.voxel_count())};
  for (int k = 0; k < grid.size[2]; ++k)
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i < grid.size[0]; ++i) {
        double sum = 0.0;
        for (int s = 0; s < kSamples * kSamples * kSamples; ++s) {
          const Vec3 part(s % kSamples, s / kSamples % kSamples, s / (kSamples * kSamples));
          sum +=
              hu(grid.world_from_index(Vec3(i, j, k) + (part.array() + 0.5).matrix() / kSamples - Vec3::Constant(0.5)));
        }
        ct.at(i, j, k) = static_cast<std::int16_t>(std::lround(sum / (kSamples * kSamples * kSamples)));
      }
  return ct;
}

VolumeGrid grid_of(int nx, int ny, int nz, const Vec3& spacing = Vec3::Ones()) {
  VolumeGrid grid{.size = {nx, ny, nz}, .spacing_mm = spacing};
  return grid;
}

double ball(const Vec3& p, const Vec3& center, double radius) {
  return (p - center).norm() <= radius ? 1.0 : 0.0;
}

Segmentation run(const CtVolume& ct, const SegmentationSettings& settings = {}) {
  Monitor monitor;
  Workers workers(2);
  return segment(ct, settings, workers, monitor);
}

std::string message_of(const CtVolume& ct, const SegmentationSettings& settings) {
  return testing::refusal_of<CaseError>([&] { return run(ct, settings); });
}

constexpr double kBallVolume = 4.0 / 3.0 * 3.14159265358979 * 1000.0;  // radius 10 mm

CtVolume ball_of_tissue() {
  return scan_of(grid_of(31, 31, 31),
                 [](const Vec3& p) { return ball(p, Vec3(15.2, 14.9, 15.4), 10.0) > 0 ? 50.0 : -1000.0; });
}

TEST(Segmentation, FindsTheVolumeOfABallWithinAPercent) {
  SegmentationSettings settings{.smoothing_mm = 0.0};
  const Segmentation result = run(ball_of_tissue(), settings);
  EXPECT_NEAR(result.occupancy_volume_mm3 / kBallVolume, 1.0, 0.01);
  EXPECT_NEAR(result.volume_mm3 / kBallVolume, 1.0, 0.01);
  EXPECT_EQ(result.components, 1U);
  EXPECT_EQ(result.holes_filled, 0U);
  EXPECT_EQ(result.cut_faces(), 0);
  EXPECT_DOUBLE_EQ(result.tissue_hu.value(), 50.0);
}

LabelVolume labels_of(const CtVolume& ct, std::int16_t least_hu, std::uint8_t label) {
  LabelVolume labels{ct.grid, std::vector<std::uint8_t>(ct.voxels.size())};
  std::ranges::transform(ct.voxels, labels.voxels.begin(),
                         [=](std::int16_t hu) { return hu >= least_hu ? label : std::uint8_t{0}; });
  return labels;
}

TEST(Segmentation, TakesEveryLabelButZeroInPlaceOfThresholds) {
  Monitor monitor;
  Workers workers(2);
  LabelVolume labels = labels_of(ball_of_tissue(), -475, 3);
  labels.at(15, 15, 15) = 7;  // a tumour's label is tissue as well
  const Segmentation result = segment_labels(labels, {}, workers, monitor);
  EXPECT_NEAR(result.occupancy_volume_mm3 / kBallVolume, 1.0, 0.02);
  EXPECT_EQ(
      result.labels.at(result.labels.grid.size[0] / 2, result.labels.grid.size[1] / 2, result.labels.grid.size[2] / 2),
      1);
  EXPECT_FALSE(result.tissue_hu.has_value());
  EXPECT_TRUE(result.verdict.reasons().empty()) << "labels have no HU that could be odd";
}

TEST(Segmentation, TakesAStrokeOfTheBrushAsTissueOrAsNone) {
  const VolumeGrid grid = grid_of(60, 40, 40);
  const Vec3 left(15, 20, 20), right(43, 20, 20);
  const CtVolume ct =
      scan_of(grid, [&](const Vec3& p) { return -1000.0 + 1050.0 * std::max(ball(p, left, 10), ball(p, right, 10)); });
  SegmentationSettings settings{.seeds_mm = {left}};
  const Segmentation one = run(ct, settings);
  EXPECT_NEAR(one.volume_mm3, 4189.0, 80.0);
  settings.edits = {{true, 4.0, {left, right}}};  // a bridge: both balls are one piece
  const Segmentation both = run(ct, settings);
  EXPECT_NEAR(both.volume_mm3, 2 * 4189.0 + 50.0 * 9.5, 250.0);
  EXPECT_EQ(both.components, 1U);
  settings.edits->push_back({false, 6.0, {Vec3(29, 20, 20)}});  // and apart again
  EXPECT_NEAR(run(ct, settings).volume_mm3, one.volume_mm3, 120.0);
  const Vec3 above(15, 20, 52);
  settings.edits = {{false, 30.0, {above}}};  // the upper part of the ball
  const Segmentation lower = run(ct, settings);
  double expected_mm3 = 0.0;
  for (std::size_t v = 0; v < ct.voxels.size(); ++v) {
    const auto [i, j, k] = grid.voxel_at(v);
    const Vec3 p(i, j, k);
    if ((p - left).norm() <= 10.0 && (p - above).norm() > 30.0) expected_mm3 += 1.0;
  }
  EXPECT_NEAR(lower.volume_mm3, expected_mm3, 0.04 * expected_mm3);
  EXPECT_NEAR(lower.occupancy_volume_mm3, expected_mm3, 0.05 * expected_mm3);
}

TEST(Segmentation, RepeatsItsStrokesOnAnotherGrid) {
  const Vec3 middle(20, 20, 20);
  SegmentationSettings settings;
  settings.edits = {{false, 3.0, {Vec3(20, 20, 34), Vec3(20, 20, 27)}}};
  const auto volume = [&](const Vec3& spacing) {
    VolumeGrid grid = grid_of(static_cast<int>(40 / spacing.x()), static_cast<int>(40 / spacing.y()),
                              static_cast<int>(40 / spacing.z()), spacing);
    return run(scan_of(grid, [&](const Vec3& p) { return -1000.0 + 1050.0 * ball(p, middle, 12); }), settings)
        .volume_mm3;
  };
  EXPECT_NEAR(volume(Vec3::Ones()) / volume(Vec3(0.8, 1.0, 0.5)), 1.0, 0.02);
}

TEST(Segmentation, RefusesAStrokeWithoutPointsAndASeedThatIsTakenAway) {
  const CtVolume ct =
      scan_of(grid_of(40, 40, 40), [](const Vec3& p) { return -1000.0 + 1050.0 * ball(p, Vec3(20, 20, 20), 10); });
  SegmentationSettings settings;
  settings.edits = {{true, 2.0, {}}};
  EXPECT_THAT(message_of(ct, settings), HasSubstr("edits[0].path_mm"));
  settings.edits = {{false, 2.0, {Vec3(20, 20, 20)}}};
  settings.seeds_mm = {Vec3(20, 20, 20)};
  EXPECT_THAT(message_of(ct, settings), ::testing::AllOf(HasSubstr("seed_mm[0]"), HasSubstr("edits")));
}

TEST(Segmentation, TakesLabelsNearTheEdgeOfTheirGridAsTheyAre) {
  const Vec3 middle(11, 11, 11);
  LabelVolume labels{grid_of(23, 23, 23), std::vector<std::uint8_t>(23 * 23 * 23, 0)};
  for (std::size_t v = 0; v < labels.voxels.size(); ++v) {
    const auto [i, j, k] = labels.grid.voxel_at(v);
    labels.voxels[v] = (Vec3(i, j, k) - middle).norm() <= 10.0 ? 1 : 0;
  }
  const auto drawn = static_cast<double>(std::ranges::count(labels.voxels, 1));
  Monitor monitor;
  Workers workers(2);
  SegmentationSettings settings{.smoothing_mm = 0.0};
  EXPECT_EQ(segment_labels(labels, settings, workers, monitor).volume_mm3, drawn);
}

TEST(Segmentation, TakesTheLabelsThatAreNamed) {
  LabelVolume labels{grid_of(40, 30, 30), std::vector<std::uint8_t>(40 * 30 * 30, 0)};
  for (std::size_t v = 0; v < labels.voxels.size(); ++v) {
    const auto [i, j, k] = labels.grid.voxel_at(v);
    if (j > 5 && j < 25 && k > 5 && k < 25 && i > 5 && i < 35) labels.voxels[v] = i < 20 ? 3 : 7;
  }
  Monitor monitor;
  Workers workers(2);
  SegmentationSettings settings;
  const double both = segment_labels(labels, settings, workers, monitor).volume_mm3;
  settings.label_values = {7};
  const double one = segment_labels(labels, settings, workers, monitor).volume_mm3;
  EXPECT_NEAR(one, 15.0 / 29.0 * both, 0.02 * both);
  settings.label_values = {4};
  EXPECT_THROW(static_cast<void>(segment_labels(labels, settings, workers, monitor)), CaseError);
  settings.label_values = {256};
  EXPECT_THROW(static_cast<void>(segment_labels(labels, settings, workers, monitor)), CaseError);
}

TEST(Segmentation, ListsEverySettingThatIsWrongForLabels) {
  Monitor monitor;
  Workers workers(1);
  SegmentationSettings settings;
  settings.label_values = {0, 7, 256};
  EXPECT_THAT(testing::refusal_of<CaseError>(
                  [&] { return segment_labels(labels_of(ball_of_tissue(), -475, 1), settings, workers, monitor); }),
              ::testing::AllOf(HasSubstr("label_values[0]"), HasSubstr("label_values[2]")));
}

TEST(Segmentation, TakesLabelsWhoseCentresLieOnTheRegionsBorder) {
  LabelVolume labels{grid_of(12, 12, 12, Vec3::Constant(0.1)), std::vector<std::uint8_t>(12 * 12 * 12, 0)};
  for (std::size_t v = 0; v < labels.voxels.size(); ++v) labels.voxels[v] = labels.grid.voxel_at(v)[0] >= 3 ? 1 : 0;
  SegmentationSettings settings{.roi_box_mm = Box3(Vec3::Constant(-1.0), Vec3(0.3, 2.0, 2.0)), .smoothing_mm = 0.0};
  ASSERT_GT(labels.grid.world_from_index(Vec3(3, 0, 0)).x(), 0.3) << "by rounding";
  Monitor monitor;
  Workers workers(1);
  EXPECT_EQ(segment_labels(labels, settings, workers, monitor).voxels, 144U) << "one layer of 12 x 12";
}

TEST(Segmentation, RefusesARegionOrASeedWithoutALabel) {
  Monitor monitor;
  Workers workers(2);
  const LabelVolume labels = labels_of(ball_of_tissue(), -475, 1);
  const auto refusal = [&](const LabelVolume& of, const SegmentationSettings& settings) {
    return testing::refusal_of<CaseError>([&] { return segment_labels(of, settings, workers, monitor); });
  };
  EXPECT_THAT(refusal(labels_of(ball_of_tissue(), 1000, 1), {}), HasSubstr("0 in every voxel of the region"));
  SegmentationSettings corner{.roi_box_mm = Box3(Vec3(0, 0, 0), Vec3(3, 3, 3))};
  EXPECT_THAT(refusal(labels, corner), HasSubstr("0 in every voxel of the region"));
  SegmentationSettings seed{.seeds_mm = {Vec3(1, 1, 1)}};
  EXPECT_THAT(refusal(labels, seed), HasSubstr("seed_mm[0]: found a point where the label is 0"));
}

TEST(Segmentation, ShrinksABallLessThanHalfAsMuchAsAGaussianWould) {
  SegmentationSettings settings{.smoothing_mm = 0.0};
  const double sharp = run(ball_of_tissue(), settings).occupancy_volume_mm3;
  settings.smoothing_mm = 1.2;
  const double smooth = run(ball_of_tissue(), settings).occupancy_volume_mm3;
  // A Gaussian takes 3 σ²/R² = 4.3 % of the volume; 2 G - G * G the share (2 - √2)/(2 - 1/√2) = 0.45 of it, in the
  // first order of σ/R.
  EXPECT_NEAR(smooth / sharp - 1.0, -0.45 * 3.0 * 1.44 / 100.0, 0.005);
}

TEST(Segmentation, HasTheSameBitsAtAnyThreadCount) {
  SegmentationSettings settings{.opening_radius_mm = 1.5};
  Monitor monitor;
  Workers alone(1), three(3);
  const Segmentation expected = segment(ball_of_tissue(), settings, alone, monitor);
  const Segmentation found = segment(ball_of_tissue(), settings, three, monitor);
  EXPECT_EQ(found.labels.voxels, expected.labels.voxels);
  EXPECT_EQ(found.occupancy.voxels, expected.occupancy.voxels);
  EXPECT_EQ(found.occupancy_volume_mm3, expected.occupancy_volume_mm3);
}

TEST(Segmentation, LeavesAMarginOfAirAllAroundEvenWhereTheRegionCutsThroughTissue) {
  SegmentationSettings settings{.roi_box_mm = Box3(Vec3(0, 0, 0), Vec3(30, 30, 15))};
  const Segmentation result = run(ball_of_tissue(), settings);
  const VolumeGrid& grid = result.labels.grid;
  for (int k = 0; k < grid.size[2]; ++k)
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i < grid.size[0]; ++i) {
        const int to_border = std::min({i, j, k, grid.size[0] - 1 - i, grid.size[1] - 1 - j, grid.size[2] - 1 - k});
        if (to_border >= 3) continue;
        EXPECT_EQ(result.labels.at(i, j, k), 0);
        EXPECT_LT(result.occupancy.at(i, j, k), 0.5F);
      }
  EXPECT_EQ(result.cut_faces(), 1);
  EXPECT_GT(result.cut_voxels[static_cast<std::size_t>(RegionFace::Superior)], 250U);  // a disc of radius 10 mm
  EXPECT_EQ(grid.origin_mm, (grid.world_from_index(Vec3::Zero())));
}

TEST(MadeSkin, LiesWhereTheRegionCutsTheBody) {
  SegmentationSettings settings;
  EXPECT_TRUE(MadeSkin(run(ball_of_tissue(), settings)).empty());
  settings.roi_box_mm = Box3(Vec3(0, 0, 0), Vec3(30, 30, 15));
  const MadeSkin in_box(run(ball_of_tissue(), settings));
  EXPECT_EQ(in_box.cut_at(Vec3(15, 15, 15.5), Vec3::UnitZ()), RegionFace::Superior);
  EXPECT_FALSE(in_box.cut_at(Vec3(15, 15, 5.4), Vec3::UnitZ())) << "the ball's own skin";
  EXPECT_FALSE(in_box.cut_at(Vec3(27, 15, 15.5), Vec3::UnitZ())) << "beside the disc, in the plane of the face";
  EXPECT_FALSE(in_box.cut_at(Vec3(25.2, 15, 15.2), Vec3::UnitX())) << "the ball's own skin at the disc's rim";
  CtVolume turned = ball_of_tissue();
  turned.grid.direction << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  settings.roi_box_mm = Box3(Vec3(-15, -100, -100), Vec3(100, 100, 100));
  EXPECT_EQ(MadeSkin(run(turned, settings)).cut_at(Vec3(-15.5, 15, 15), -Vec3::UnitX()), RegionFace::Right);
}

TEST(MadeSkin, IsNoneWhereTheRegionEndsJustAboveTheSkin) {
  SegmentationSettings settings;  // the ball ends at z 25.4
  settings.roi_box_mm = Box3(Vec3(0, 0, 0), Vec3(30, 30, 25));
  const Segmentation touched = run(ball_of_tissue(), settings);
  EXPECT_EQ(touched.cut_faces(), 0);
  EXPECT_TRUE(MadeSkin(touched).empty());
}

TEST(MadeSkin, IsThatOfABumpAloneWhereOnlyABumpReachesTheRegionsFace) {
  const CtVolume ct = scan_of(grid_of(40, 40, 30), [](const Vec3& p) {
    const bool is_slab = p.z() > 5 && p.z() < 20 && p.x() > 5 && p.x() < 35 && p.y() > 5 && p.y() < 35;
    return is_slab || (p - Vec3(12, 12, 19)).norm() < 5.0 ? 50.0 : -1000.0;
  });
  SegmentationSettings settings{.roi_box_mm = Box3(Vec3(0, 0, 0), Vec3(40, 40, 20)), .smoothing_mm = 0.0};
  const MadeSkin faces(run(ct, settings));
  EXPECT_EQ(faces.cut_at(Vec3(12, 12, 20.0), Vec3::UnitZ()), RegionFace::Superior);
  EXPECT_FALSE(faces.cut_at(Vec3(28, 28, 20.0), Vec3::UnitZ())) << "sound skin at the same height";
}

/// A slab, or a column of radius 12 mm, that goes on beyond a box that ends at z = 20.
CtVolume tissue_through_box(bool is_column, double hu_above_12 = 50.0) {
  return scan_of(grid_of(40, 40, 34), [=](const Vec3& p) {
    const bool is_wide = p.x() > 5 && p.x() < 35 && p.y() > 5 && p.y() < 35;
    const bool is_in = is_column ? (p - Vec3(20, 20, p.z())).norm() < 12 : is_wide;
    if (!is_in || p.z() < 4 || p.z() > 30) return -1000.0;
    return p.z() > 12.5 ? hu_above_12 : 50.0;
  });
}

/// The share of the skin between two radii about the column's axis, looking up at z > 10, that is artificial.
double share_of_top(const Segmentation& found, double radius_mm) {
  const MadeSkin faces(found);
  const TriMesh skin = iso_surface(found.occupancy, 0.5);
  int top = 0, cut = 0;
  for (const auto& [a, b, c] : skin.triangles) {
    const Vec3 &p = skin.vertices[a.index()], &q = skin.vertices[b.index()], &r = skin.vertices[c.index()];
    const Vec3 normal = (q - p).cross(r - p).normalized();
    if (normal.z() < 0.6 || p.z() < 10 || (p - Vec3(20, 20, p.z())).norm() > radius_mm) continue;
    ++top;
    cut += faces.cut_at((p + q + r) / 3.0, normal) == RegionFace::Superior ? 1 : 0;
  }
  EXPECT_GT(top, 50);
  return static_cast<double>(cut) / std::max(1, top);
}

TEST(MadeSkin, IsSeenWhereTheTissueWasPainted) {
  SegmentationSettings settings{.roi_box_mm = Box3(Vec3(0, 0, 0), Vec3(40, 40, 20))};
  std::vector<TissueEdit> strokes;
  for (const int y : {16, 20, 24})
    strokes.push_back({.is_tissue = true, .radius_mm = 9.0, .path_mm = {Vec3(16, y, 20), Vec3(24, y, 20)}});
  settings.edits = strokes;
  const Segmentation found = run(tissue_through_box(false, 900.0), settings);
  EXPECT_EQ(found.cut_faces(), 1);
  EXPECT_GT(share_of_top(found, 10.0), 0.95);  // the strokes' ends are round
  // A stroke that takes the tissue away on both sides of the face leaves nothing that is cut.
  settings.edits = {{.is_tissue = false, .radius_mm = 40.0, .path_mm = {Vec3(20, 20, 55)}}};
  EXPECT_EQ(run(tissue_through_box(false), settings).cut_faces(), 0);
}

TEST(MadeSkin, IsPaintedWhereAStrokeHasMadeItAndNowhereElse) {
  const auto slab = [](const Vec3& p) { return p.z() > 5 && p.z() < 15 ? 50.0 : -1000.0; };
  const CtVolume ct = scan_of(grid_of(40, 40, 30), slab);
  SegmentationSettings settings;
  // One stroke adds a mound at x = 10, one takes the slab's top away at x = 30; two change nothing.
  settings.edits = {{true, 5.0, {Vec3(10, 20, 14)}},
                    {false, 5.0, {Vec3(30, 20, 16)}},
                    {true, 4.0, {Vec3(20, 20, 10.5)}},
                    {false, 4.0, {Vec3(20, 20, 19.5)}}};
  const MadeSkin skin(run(ct, settings));
  EXPECT_TRUE(skin.is_painted(Vec3(10, 20, 19), Vec3::UnitZ()));
  EXPECT_TRUE(skin.is_painted(Vec3(30, 20, 11), Vec3::UnitZ()));
  EXPECT_FALSE(skin.is_painted(Vec3(20, 20, 15), Vec3::UnitZ())) << "both strokes end at the skin, and neither made it";
  EXPECT_FALSE(skin.is_painted(Vec3(10, 30, 15), Vec3::UnitZ())) << "beside the strokes";
  EXPECT_FALSE(skin.cut_at(Vec3(10, 20, 19), Vec3::UnitZ()));
  settings.edits = {{true, 4.0, {Vec3(20, 20, 10.5)}}};
  EXPECT_TRUE(run(ct, settings).painted.empty()) << "a stroke within the tissue";
}

TEST(MadeSkin, IsFollowedWhereOpeningAndSmoothingMoveIt) {
  SegmentationSettings settings{.roi_box_mm = Box3(Vec3(0, 0, 0), Vec3(40, 40, 20))};
  for (const double opening_mm : {0.0, 4.0, 6.0}) {
    for (const double smoothing_mm : {0.0, 1.2, 5.0}) {
      settings.opening_radius_mm = opening_mm;
      settings.smoothing_mm = smoothing_mm;
      EXPECT_GT(share_of_top(run(tissue_through_box(true), settings), 10.0), 0.95) << opening_mm << " " << smoothing_mm;
    }
  }
}

TEST(MadeSkin, IsNotMadeByNoiseAboveTheSkin) {
  CtVolume ct = tissue_through_box(true);
  for (std::size_t v = 0; v < ct.voxels.size(); ++v) {
    const auto [i, j, k] = ct.grid.voxel_at(v);
    if (k > 20) ct.voxels[v] = v % 37 == 0 ? 50 : -1000;  // above z = 20: air with specks
  }
  SegmentationSettings settings{.roi_box_mm = Box3(Vec3(0, 0, 0), Vec3(40, 40, 20))};
  EXPECT_EQ(run(ct, settings).cut_faces(), 0);
}

TEST(MadeSkin, LiesAtTheScansEndWhereAnObliqueScanEndsWithinTheRegion) {
  CtVolume ct = ball_of_tissue();
  ct.grid.direction = Eigen::AngleAxisd(0.5, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  ct.grid.size[2] = 16;
  ct.voxels.resize(ct.grid.voxel_count());
  SegmentationSettings settings{.roi_box_mm = Box3(Vec3::Constant(-100), Vec3::Constant(100))};
  const MadeSkin faces(run(ct, settings));
  const Vec3 out = ct.grid.direction.col(2);
  EXPECT_TRUE(faces.cut_at(ct.grid.world_from_index(Vec3(15, 15, 15.5)), out));
  EXPECT_FALSE(faces.cut_at(ct.grid.world_from_index(Vec3(15, 15, 5.4)), -out));
}

TEST(Segmentation, CutsHalfABallAtTheFaceOfTheLastVoxelInTheRegion) {
  SegmentationSettings settings{.roi_box_mm = Box3(Vec3(0, 0, 0), Vec3(30, 30, 15)), .smoothing_mm = 0.0};
  // The cut lies at z = 15.5, 0.1 mm above the centre: half a ball and a slice of 0.1 mm.
  EXPECT_NEAR(run(ball_of_tissue(), settings).occupancy_volume_mm3 / (0.5 * kBallVolume + 31.4), 1.0, 0.015);
}

TEST(Segmentation, KeepsOneGridForLabelAndOccupancyInWorldCoordinates) {
  CtVolume ct = ball_of_tissue();
  ct.grid.origin_mm = Vec3(100, -50, 7);
  ct.grid.direction << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // a quarter turn
  const Segmentation result = run(ct);
  ASSERT_EQ(result.labels.grid.size, result.occupancy.grid.size);
  Vec3 centroid = Vec3::Zero();
  const VolumeGrid& grid = result.labels.grid;
  for (int k = 0; k < grid.size[2]; ++k)
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i < grid.size[0]; ++i)
        if (result.labels.at(i, j, k) != 0)
          centroid += grid.world_from_index(Vec3(i, j, k)) / static_cast<double>(result.voxels);
  EXPECT_LT((centroid - Vec3(100 - 14.9, -50 + 15.2, 7 + 15.4)).norm(), 0.05);
}

TEST(Segmentation, NamesTheWorldSideThatIsCutWhenTheGridIsTurned) {
  CtVolume ct = ball_of_tissue();
  ct.grid.direction << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // j points to the right (-x), i to posterior (+y)
  SegmentationSettings settings{.roi_box_mm = Box3(Vec3(-15, -100, -100), Vec3(100, 100, 100))};
  const Segmentation result = run(ct, settings);
  EXPECT_EQ(result.cut_faces(), 1);
  EXPECT_GT(result.cut_voxels[static_cast<std::size_t>(RegionFace::Right)], 0U);
}

// Two balls, the larger at x = 15, the smaller at x = 45, and a bridge of 4 mm across between them.
CtVolume two_balls(bool with_bridge) {
  return scan_of(grid_of(60, 31, 31), [=](const Vec3& p) {
    const bool bridge = with_bridge && p.x() > 15 && p.x() < 45 && (p - Vec3(p.x(), 15, 15)).norm() < 2.0;
    return ball(p, Vec3(15, 15, 15), 10.0) > 0 || ball(p, Vec3(45, 15, 15), 8.0) > 0 || bridge ? 50.0 : -1000.0;
  });
}

TEST(Segmentation, TakesTheLargestPieceWithoutASeedAndTheSeedsPieceWithOne) {
  SegmentationSettings settings;
  const Segmentation largest = run(two_balls(false), settings);
  settings.seeds_mm = {Vec3(45, 15, 15), Vec3(47, 14, 15)};
  const Segmentation seeded = run(two_balls(false), settings);
  EXPECT_EQ(largest.components, 2U);
  EXPECT_NEAR(largest.occupancy_volume_mm3 / kBallVolume, 1.0, 0.02);
  EXPECT_NEAR(seeded.occupancy_volume_mm3 / (kBallVolume * 0.512), 1.0, 0.02);
}

TEST(Segmentation, CautionsWhereAnotherBodyMayBeTheSpecimen) {
  const auto balls_of = [](double second_mm) {
    return scan_of(grid_of(61, 31, 31), [second_mm](const Vec3& p) {
      return ball(p, Vec3(15, 15, 15), 10.0) + ball(p, Vec3(45, 15, 15), second_mm) > 0 ? 50.0 : -1000.0;
    });
  };
  const Segmentation alike = run(balls_of(9.9));
  ASSERT_EQ(alike.verdict.status(), VerdictStatus::Caution);
  const VerdictReason& reason = alike.verdict.reasons().front();
  EXPECT_EQ(reason.id, "scan");
  EXPECT_THAT(reason.message,
              ::testing::AllOf(HasSubstr("two bodies"), HasSubstr("round (15.0, 15.0, 15.0) mm, which is kept"),
                               HasSubstr("round (45.0, 15.0, 15.0) mm"), HasSubstr("seed_mm")));
  EXPECT_NEAR(reason.value.value(), 0.97, 0.02);
  EXPECT_EQ(run(balls_of(6.5)).verdict.status(), VerdictStatus::Caution);
  EXPECT_EQ(run(balls_of(6.0)).verdict.status(), VerdictStatus::Ok) << "0.22 of the other's volume";
  SegmentationSettings seeded{.seeds_mm = {Vec3(45, 15, 15)}};
  EXPECT_EQ(run(balls_of(9.9), seeded).verdict.status(), VerdictStatus::Ok);
}

TEST(Segmentation, RefusesSmoothingThatLeavesNothing) {
  SegmentationSettings settings{.smoothing_mm = 5.0};
  const CtVolume thin = scan_of(grid_of(31, 31, 9, Vec3(0.5, 0.5, 0.5)),
                                [](const Vec3& p) { return ball(p, Vec3(7.5, 7.5, 2.0), 1.0) > 0 ? 50.0 : -1000.0; });
  EXPECT_THAT(message_of(thin, settings), HasSubstr("smoothing_mm: found 5, which leaves nothing of the body"));
}

TEST(Segmentation, SeparatesPiecesThatABridgeThinnerThanTheOpeningJoins) {
  SegmentationSettings settings;
  EXPECT_EQ(run(two_balls(true), settings).components, 1U);
  settings.opening_radius_mm = 3.0;
  const Segmentation result = run(two_balls(true), settings);
  EXPECT_EQ(result.components, 2U);
  EXPECT_NEAR(result.occupancy_volume_mm3 / kBallVolume, 1.0, 0.03);
}

TEST(Segmentation, FillsClosedCavitiesAndLeavesThoseWithAWayOut) {
  const auto with_cavity = [](bool open) {
    return scan_of(grid_of(31, 31, 31), [=](const Vec3& p) {
      const bool channel = open && p.z() > 15 && (p - Vec3(15, 15, p.z())).norm() < 2.0;
      return ball(p, Vec3(15, 15, 15), 10) > 0 && ball(p, Vec3(15, 15, 15), 3.5) == 0 && !channel ? 50.0 : -1000.0;
    });
  };
  const Segmentation closed = run(with_cavity(false));
  EXPECT_EQ(closed.holes_filled, 1U);
  EXPECT_NEAR(closed.occupancy_volume_mm3 / kBallVolume, 1.0, 0.015);
  const Segmentation open = run(with_cavity(true));
  EXPECT_EQ(open.holes_filled, 0U);
  EXPECT_LT(open.occupancy_volume_mm3 / kBallVolume, 0.95);
  SegmentationSettings settings{.fill_holes = false};
  EXPECT_LT(run(with_cavity(false), settings).occupancy_volume_mm3 / kBallVolume, 0.97);
}

TEST(Segmentation, PlacesTheSurfaceBetweenTissueAndFatOrBoneAsRightAsAgainstAir) {
  for (const double around : {-1000.0, -100.0, 1200.0}) {
    const CtVolume ct = scan_of(
        grid_of(31, 31, 31), [=](const Vec3& p) { return ball(p, Vec3(15.2, 14.9, 15.4), 10.0) > 0 ? 50.0 : around; });
    SegmentationSettings settings{.smoothing_mm = 0.0};
    EXPECT_NEAR(run(ct, settings).occupancy_volume_mm3 / kBallVolume, 1.0, 0.012)
        << "surroundings of " << around << " HU";
  }
}

TEST(Segmentation, LeavesOutTheThinShellBetweenBoneAndAirThatLooksLikeTissue) {
  // A block of bone beside the ball: where bone meets air, partial volume passes through the tissue's window.
  const CtVolume ct = scan_of(grid_of(45, 31, 31), [](const Vec3& p) {
    if (ball(p, Vec3(15, 15, 15), 10.0) > 0) return 50.0;
    return p.x() > 23.3 && p.x() < 40.3 && p.y() > 4.3 && p.y() < 26.3 && p.z() > 4.3 && p.z() < 26.3 ? 1000.0
                                                                                                      : -1000.0;
  });
  SegmentationSettings settings{.opening_radius_mm = 1.5};
  const Segmentation result = run(ct, settings);
  EXPECT_NEAR(result.occupancy_volume_mm3 / kBallVolume, 1.0, 0.03);
}

TEST(Segmentation, CautionsWhereSmoothingTakesAPartOfASmallBody) {
  const auto body = [](double radius_mm) {
    const double spacing = radius_mm / 15.0;
    return scan_of(grid_of(40, 40, 40, Vec3::Constant(spacing)),
                   [&](const Vec3& p) { return -1000.0 + 1040.0 * ball(p, Vec3::Constant(20.0 * spacing), radius_mm); });
  };
  SegmentationSettings longer{.smoothing_mm = 0.6};
  const Segmentation small = run(body(3.0), longer);  // 6 mm across
  ASSERT_EQ(small.verdict.reasons().size(), 1U);
  EXPECT_EQ(small.verdict.reasons()[0].id, "scan");
  EXPECT_THAT(small.verdict.reasons()[0].message,
              ::testing::AllOf(HasSubstr("smoothing over 0.6 mm"), HasSubstr("smoothing_mm (about a voxel)")));
  EXPECT_LT(small.occupancy_volume_mm3, 0.97 * 36.0 * 3.14159265);
  const Segmentation kept = run(body(3.0));  // by default over 1.2 voxels of 0.2 mm
  EXPECT_DOUBLE_EQ(kept.smoothing_mm, 0.24);
  EXPECT_EQ(kept.verdict.status(), VerdictStatus::Ok);
  EXPECT_NEAR(kept.occupancy_volume_mm3 / (36.0 * 3.14159265), 1.0, 0.015);
  const Segmentation large = run(body(25.0));
  EXPECT_EQ(large.verdict.status(), VerdictStatus::Ok);
  EXPECT_DOUBLE_EQ(large.smoothing_mm, 0.6);
}

TEST(Segmentation, CautionsWithTheSidesThatTheSpecimenRunsInto) {
  testing::RecordingMonitor monitor;
  Workers workers(2);
  SegmentationSettings settings{.roi_box_mm = Box3(Vec3(10, 0, 0), Vec3(30, 30, 20))};
  const Segmentation found = segment(ball_of_tissue(), settings, workers, monitor);
  ASSERT_EQ(found.verdict.reasons().size(), 1U);
  EXPECT_EQ(found.verdict.reasons()[0].id, "scan");
  EXPECT_THAT(found.verdict.reasons()[0].message,
              ::testing::AllOf(HasSubstr("2 of 6 sides"), HasSubstr("right ("), HasSubstr("superior (")));
  EXPECT_TRUE(std::is_sorted(monitor.fractions.begin(), monitor.fractions.end()));
  ASSERT_FALSE(monitor.fractions.empty());
  EXPECT_EQ(monitor.fractions.back(), 1.0);
}

TEST(Segmentation, RefusesSeedsAndRegionsThatDoNotFitTheVolume) {
  const CtVolume ct = two_balls(false);
  SegmentationSettings settings{.seeds_mm = {Vec3(15, 15, 99)}};
  EXPECT_THAT(message_of(ct, settings),
              ::testing::AllOf(HasSubstr("seed_mm[0]: found [15, 15, 99]"),
                               HasSubstr("a point inside the volume, [[0, 0, 0], [59, 30, 30]] mm")));
  settings.seeds_mm = {Vec3(15, 15, 15), Vec3(1, 1, 1)};
  EXPECT_THAT(message_of(ct, settings), ::testing::AllOf(HasSubstr("seed_mm[1]: found [1, 1, 1] with -1000 HU"),
                                                         HasSubstr("window_hu [-20, 180]")));
  settings.seeds_mm = {Vec3(15, 15, 15), Vec3(45, 15, 15)};
  EXPECT_THAT(message_of(ct, settings), HasSubstr("another piece"));
  settings.seeds_mm = {Vec3(45, 15, 15)};
  settings.roi_box_mm = Box3(Vec3(0, 0, 0), Vec3(30, 30, 30));
  EXPECT_THAT(message_of(ct, settings), HasSubstr("a point inside roi_box_mm [[0, 0, 0], [30, 30, 30]]"));
  settings.seeds_mm = {};
  settings.roi_box_mm = Box3(Vec3(100, 0, 0), Vec3(130, 30, 30));
  EXPECT_THAT(message_of(ct, settings), HasSubstr("a box that meets the volume"));
  settings.roi_box_mm = Box3(Vec3(10.2, 10.2, 10.2), Vec3(10.8, 10.8, 10.8));
  EXPECT_THAT(message_of(ct, settings), HasSubstr("roi_box_mm"));
}

TEST(Segmentation, RefusesAWindowWithoutTissueAndAnOpeningThatLeavesNone) {
  SegmentationSettings settings{.window_low_hu = 300.0, .window_high_hu = 400.0};
  EXPECT_THAT(message_of(ball_of_tissue(), settings),
              ::testing::AllOf(HasSubstr("no voxel with HU in [300, 400]"), HasSubstr("-1000 to 50 HU")));
  settings = {};
  settings.opening_radius_mm = 12.0;
  EXPECT_THAT(message_of(ball_of_tissue(), settings), HasSubstr("opening_radius_mm: found 12, which leaves nothing"));
  settings.opening_radius_mm = 3.0;
  settings.seeds_mm = {Vec3(30, 15, 15)};  // in the bridge
  EXPECT_THAT(message_of(two_balls(true), settings), HasSubstr("tissue thinner than opening_radius_mm 3"));
}

TEST(Segmentation, ListsEverySettingThatIsWrong) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  SegmentationSettings settings;
  settings.window_low_hu = 200.0;
  settings.roi_box_mm = Box3(Vec3(0, 0, 0), Vec3(1, kNan, 1));
  settings.seeds_mm = {Vec3(kNan, 0, 0)};
  settings.opening_radius_mm = -1.0;
  settings.smoothing_mm = 9.0;
  settings.margin_voxels = 1;
  EXPECT_EQ(validate(settings).size(), 6U);
  EXPECT_THAT(message_of(ball_of_tissue(), settings),
              ::testing::AllOf(HasSubstr("6 violation(s)"), HasSubstr("window_hu[0]: found 200"),
                               HasSubstr("margin_voxels: found 1")));
}

TEST(Segmentation, RefusesAVolumeThatContradictsItself) {
  CtVolume ct = ball_of_tissue();
  ct.voxels.pop_back();
  EXPECT_THROW(static_cast<void>(run(ct)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(run(CtVolume{})), InvalidArgument);
  ct = ball_of_tissue();
  ct.grid.spacing_mm.z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(run(ct)), InvalidArgument);
}

struct PhantomCase {
  std::uint64_t seed;
  Vec3 spacing_mm;
};

class SegmentationOfPhantoms : public ::testing::TestWithParam<PhantomCase> {};

TEST_P(SegmentationOfPhantoms, FindsTheTrueVolumeAndTheTrueSkin) {
  Monitor monitor;
  Workers workers(2);
  PhantomSettings settings{.seed = GetParam().seed, .spacing_mm = GetParam().spacing_mm};
  const Phantom phantom = make_phantom(settings, monitor);
  const Segmentation result = segment(phantom.ct, {}, workers, monitor);
  RecordProperty("occupancy_error_percent",
                 std::to_string(100.0 * (result.occupancy_volume_mm3 / phantom.true_volume_mm3 - 1.0)));
  RecordProperty("label_error_percent", std::to_string(100.0 * (result.volume_mm3 / phantom.true_volume_mm3 - 1.0)));
  EXPECT_NEAR(result.occupancy_volume_mm3 / phantom.true_volume_mm3, 1.0, 0.0075);
  // Whole voxels cannot follow the flat sole, which lies anywhere between two layers of centres.
  EXPECT_NEAR(result.volume_mm3 / phantom.true_volume_mm3, 1.0, 0.02);
  EXPECT_EQ(result.cut_faces(), 0);

  // Down the mid-line: where the occupancy passes 0.5 on the way in, against the exact back and sole.
  const VolumeGrid& grid = result.occupancy.grid;
  for (double y = phantom.tip_end_mm + 15.0; y < phantom.posterior_end_mm - 10.0; y += 5.0) {
    const Eigen::Array3i at = grid.index_from_world(Vec3(0, y, 0)).array().round().cast<int>();
    const Vec3 column = grid.world_from_index(at.cast<double>().matrix());
    const auto span = span_at(phantom.shape, column.x(), column.y());
    int k = 0;
    while (result.occupancy.at(at[0], at[1], k) < 0.5F) ++k;
    const auto crossing = [&](int below) {
      const double a = result.occupancy.at(at[0], at[1], below);
      const double b = result.occupancy.at(at[0], at[1], below + 1);
      return grid.origin_mm.z() + (below + (0.5 - a) / (b - a)) * grid.spacing_mm.z();
    };
    EXPECT_NEAR(crossing(k - 1), span->low_mm, 0.5 * grid.spacing_mm.z()) << "sole at y = " << y;
    while (result.occupancy.at(at[0], at[1], k) >= 0.5F) ++k;
    EXPECT_NEAR(crossing(k - 1), span->high_mm, 0.2) << "back at y = " << y;
  }
}

INSTANTIATE_TEST_SUITE_P(SeedsAndVoxels, SegmentationOfPhantoms,
                         ::testing::Values(PhantomCase{1, Vec3::Constant(0.8)}, PhantomCase{2, Vec3(0.7, 0.7, 1.0)},
                                           PhantomCase{3, Vec3(1.0, 1.0, 1.0)}, PhantomCase{17, Vec3(0.9, 0.9, 1.5)}));

}  // namespace
}  // namespace incise
