#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/workflow/cut_doubts.hpp>
#include <incise/workflow/margin_room.hpp>
#include <incise/workflow/study.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace incise {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

/// A block of 24 x 24 x 8 mm, held at its underside.
TissueModel block(int cells_across, double poissons_ratio, VolumeTreatment volume = VolumeTreatment::PerTet) {
  Material material{.volume = volume, .poissons_ratio = poissons_ratio};
  return make_tissue_model(make_block({24, 24, 8}, {cells_across, cells_across, cells_across / 3}), material,
                           {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(25, 25, 0.1))}}});
}

ToolPath ring(double radius_mm = 7.0) {
  ToolPath path;
  for (int i = 0; i < 24; ++i) {
    const double angle = 2.0 * M_PI * i / 24.0;
    Waypoint waypoint;
    waypoint.position_mm = Vec3(12.0 + radius_mm * std::cos(angle), 12.0 + radius_mm * std::sin(angle), 8.0);
    path.waypoints.push_back(waypoint);
  }
  return path;
}

/// "id: message" of each reason.
std::vector<std::string> doubts(const TissueModel& model) {
  std::vector<std::string> lines;
  const Verdict verdict = verdict_before_cut(Case{}, model, {}, model.mesh.vertices, ring());
  for (const VerdictReason& reason : verdict.reasons()) {
    lines.push_back(reason.id + ": " + reason.message);
  }
  return lines;
}

TEST(RequireNoLocking, RefusesToCutTetsThatKeepTheirVolumeOneByOneAndNamesTheWayOut) {
  for (const double good : {0.45, 0.49, 0.495}) EXPECT_NO_THROW(require_no_locking(block(6, good))) << good;
  EXPECT_NO_THROW(require_no_locking(block(6, 0.4999, VolumeTreatment::Averaged)));
  for (const double bad : {0.4951, 0.499, 0.4999}) {
    SCOPED_TRACE(bad);
    const auto error = testing::error_of<CaseError>([&] { require_no_locking(block(6, bad)); });
    if (!error) {
      ADD_FAILURE() << "not refused";
      continue;
    }
    EXPECT_EQ(error->field(), "specimen.material.volume");
    EXPECT_THAT(error->what(),
                AllOf(HasSubstr("per_tet with a Poisson's ratio of 0.49"), HasSubstr("expected averaged")));
  }
}

TEST(VerdictBeforeCut, CautionsOfTissueThatBeginsToLock) {
  EXPECT_THAT(doubts(block(24, 0.49)), IsEmpty());
  EXPECT_THAT(doubts(block(24, 0.493)), ElementsAre(AllOf(HasSubstr("locking: "), HasSubstr("0.493"), HasSubstr("volume: averaged"))));
  EXPECT_THAT(doubts(block(24, 0.493, VolumeTreatment::Averaged)), IsEmpty());
}

TEST(VerdictBeforeCut, CautionsOfARuleOfTheCutThatNothingWasFittedTo) {
  const TissueModel model = block(24, 0.45);
  Case settings;
  EXPECT_FALSE(verdict_before_cut(settings, model, {}, model.mesh.vertices, ring()).has("cut_rule"));
  settings.cut.rule = CutRule::Lattice;
  const Verdict verdict = verdict_before_cut(settings, model, {}, model.mesh.vertices, ring());
  ASSERT_TRUE(verdict.has("cut_rule"));
  EXPECT_THAT(verdict.reasons().front().message, AllOf(HasSubstr("lattice"), HasSubstr("cut.rule")));
}

/// A cube of edge a, cut into six tets: three edges of a, two diagonals √2 a and one √3 a each.
double mean_edge_of_cubes(double a) {
  return a * (3.0 + 2.0 * std::sqrt(2.0) + std::sqrt(3.0)) / 6.0;
}

TEST(EdgeAlong, IsTheMeanOfTheTetsEdgesAtRest) {
  const TissueModel model = block(12, 0.45);
  EXPECT_NEAR(*edge_along_mm(model, model.mesh.vertices, ring(), -Vec3::UnitZ()), mean_edge_of_cubes(2.0), 1e-9);
  Points stretched = model.mesh.vertices;
  for (Vec3& p : stretched) p.y() *= 1.2;
  EXPECT_NEAR(*edge_along_mm(model, stretched, ring(), -Vec3::UnitZ()), mean_edge_of_cubes(2.0), 1e-9)
      << "stretched tissue has the edges that it was meshed with";
  ToolPath beside = ring();
  for (Waypoint& waypoint : beside.waypoints) waypoint.position_mm.x() += 100.0;
  EXPECT_FALSE(edge_along_mm(model, model.mesh.vertices, beside, -Vec3::UnitZ()));
}

TEST(EdgeAlong, LooksAtTheTetsThatTheToolMeetsAndNoOthers) {
  TetMesh mesh = make_block({24, 24, 8}, {24, 24, 8});
  for (Vec3& p : mesh.vertices) {
    if (p.z() < 2.5) p.z() = 2.5 - 40.0 * (2.5 - p.z());  // long tets far below the needle's tip
  }
  const TissueModel model = make_tissue_model(
      std::move(mesh), Material{}, {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -200), Vec3(25, 25, -90))}}});
  EXPECT_NEAR(*edge_along_mm(model, model.mesh.vertices, ring(), -Vec3::UnitZ()), mean_edge_of_cubes(1.0), 1e-9);
}

TEST(VerdictBeforeCut, CautionsOfAMeshThatIsTooCoarseForTheTool) {
  EXPECT_THAT(doubts(block(24, 0.49)), IsEmpty());  // edges of 1.26 mm
  EXPECT_THAT(doubts(block(12, 0.49)), ElementsAre(AllOf(HasSubstr("mesh_resolution: "), HasSubstr("2.52 mm"), HasSubstr("meshing.tets"))));
}

TEST(VerdictBeforeCut, RefusesATipThatGoesThroughThePlatform) {
  const TissueModel model = make_tissue_model(make_block({24, 24, 8}, {24, 24, 8}), Material{},
                                              {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(1, 25, 9))}}, SupportConstraint{Vec3(0, 0, 2), Vec3::UnitZ()}});
  ToolPath path = ring();  // on z = 8, 5 mm deep: a millimetre above the platform
  EXPECT_NEAR(platform_clearance(model, path)->height_mm, 1.0, 1e-12);
  EXPECT_FALSE(verdict_before_cut(Case{}, model, {}, model.mesh.vertices, path).has("platform"));
  path.waypoints[7].depth_mm = 6.5;
  const Verdict verdict = verdict_before_cut(Case{}, model, {}, model.mesh.vertices, path);
  ASSERT_TRUE(verdict.has("platform"));
  EXPECT_NEAR(*verdict.reasons().front().value, -0.5, 1e-12);
  EXPECT_EQ(verdict.reasons().front().at->text, "waypoint 7");
  EXPECT_FALSE(platform_clearance(block(6, 0.45), path)) << "no platform";
}

/// The block as a scan of 1 mm shows it: its voxels lie at 0.5, 1.5, …
Segmentation block_of_voxels() {
  Segmentation found;
  found.labels.grid.size = {24, 24, 8};
  found.labels.grid.origin_mm = Vec3::Constant(0.5);
  found.labels.voxels.assign(found.labels.grid.voxel_count(), 1);
  return found;
}

/// Those of one layer.
std::vector<std::int32_t> voxels_with(const Segmentation& found, std::size_t axis, int index) {
  std::vector<std::int32_t> voxels;
  for (std::size_t v = 0; v < found.labels.voxels.size(); ++v) {
    if (found.labels.grid.voxel_at(v).at(axis) == index) voxels.push_back(static_cast<std::int32_t>(v));
  }
  return voxels;
}

TEST(VerdictBeforeCut, RefusesAPathOrAnEdgeOnAFaceThatTheRegionMade) {
  const TissueModel model = block(24, 0.45);
  Points stretched = model.mesh.vertices;
  for (Vec3& place : stretched) place.x() *= 1.5;  // faces are of the tissue at rest, a path is on the stretched tissue
  const auto cut_towards = [](std::int32_t side, std::size_t axis, int last) {  // its top, or its end at x = 24
    Segmentation found = block_of_voxels();
    for (const std::int32_t v : voxels_with(found, axis, last)) found.cut.push_back({v, side});
    return MadeSkin(found);
  };
  const MadeSkin above = cut_towards(5, 2, 7), beside = cut_towards(1, 0, 23);
  const auto judged = [&](const MadeSkin& faces, double middle_mm) {
    ToolPath path = ring();
    for (Waypoint& waypoint : path.waypoints) waypoint.position_mm.x() += middle_mm - 12.0;
    path.tumor_edge.points = {Vec3(20, 10, 8), Vec3(18, 14, 8), Vec3(22, 14, 8)};
    return verdict_before_cut(Case{}, model, faces, stretched, path);
  };
  EXPECT_FALSE(judged(beside, 18.0).has("cut_face")) << "its skin is the specimen's own, 11 mm from the face";
  EXPECT_FALSE(judged(beside, 28.0).has("cut_face")) << "beside the face, on the skin";
  const Verdict verdict = judged(above, 18.0);
  ASSERT_TRUE(verdict.has("cut_face"));
  EXPECT_EQ(verdict.status(), VerdictStatus::Refused);
  std::vector<std::string> lines;
  for (const VerdictReason& reason : verdict.reasons()) {
    if (reason.id == "cut_face") lines.push_back(reason.message);
  }
  EXPECT_THAT(lines, ElementsAre(HasSubstr("24 of 24 points of the path lie"),
                                 HasSubstr("3 of 3 points of the tumour's edge lie")));
  EXPECT_THAT(lines.front(), HasSubstr("on its superior side"));
  EXPECT_EQ(verdict.reasons().front().at->position_mm, Vec3(25, 12, 8));
}

TEST(VerdictBeforeCut, NamesSkinThatStrokesOfTheBrushMade) {
  const TissueModel model = block(24, 0.45);
  const auto judged = [&](int last) {  // strokes made the top as far as x = last
    Segmentation found = block_of_voxels();
    for (const std::int32_t v : voxels_with(found, 2, 7)) {
      if (found.labels.grid.voxel_at(static_cast<std::size_t>(v))[0] <= last) found.painted.push_back({v, 5});
    }
    return verdict_before_cut(Case{}, model, MadeSkin(found), model.mesh.vertices, ring());
  };
  const Verdict verdict = judged(23);
  ASSERT_TRUE(verdict.has("painted_skin"));
  EXPECT_FALSE(verdict.has("cut_face"));
  EXPECT_EQ(verdict.status(), VerdictStatus::Caution);
  EXPECT_THAT(verdict.reasons().front().message, HasSubstr("24 of 24 points of the path lie on skin that strokes"));
  EXPECT_FALSE(judged(2).has("painted_skin")) << "a stroke beside the path";
}

TEST(MarginRoom, EndsBeforeTheRimOrBeforeSkinThatTheRegionMade) {
  const TetMesh mesh = make_block({24, 24, 8}, {48, 48, 16});
  const auto greatest = [&](const MadeSkin& made, double middle_mm, double radius_mm) {
    Contour edge{{}, true};
    for (int i = 0; i < 48; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / 48;
      edge.points.emplace_back(middle_mm + radius_mm * std::cos(angle), 12.0 + radius_mm * std::sin(angle), 8.0);
    }
    PlanSettings settings{.depth_mm = 2.0};
    return margin_room({boundary_surface(mesh), mesh.vertices, made}, edge, settings, 0.5);
  };
  // The rim lies 12 mm from the middle, and the path keeps 1 mm clear of it.
  EXPECT_EQ(greatest({}, 12.0, 3.0).greatest_mm, 8.0) << "radius 3, margin 8: on the limit";
  EXPECT_EQ(greatest({}, 12.0, 3.2).greatest_mm, 7.5);
  EXPECT_EQ(greatest({}, 9.0, 3.2).greatest_mm, 4.5) << "the rim is nearer on one side";
  EXPECT_EQ(in_words(greatest({}, 12.0, 10.2)), "No lateral margin fits here")
      << "0.5 mm would, but is not above the radius";
  EXPECT_EQ(greatest({}, 12.0, 9.8).greatest_mm, 1.0);
  Segmentation found = block_of_voxels();
  for (const std::int32_t v : voxels_with(found, 2, 7)) {
    if (found.labels.grid.voxel_at(static_cast<std::size_t>(v))[0] >= 20) found.cut.push_back({v, 5});
  }
  // The cut skin begins at x = 20; a place counts up to a voxel before it.
  const std::optional<double> before_cut_face = greatest(MadeSkin(found), 12.0, 3.2).greatest_mm;
  ASSERT_TRUE(before_cut_face);
  EXPECT_GE(*before_cut_face, 3.5);
  EXPECT_LE(*before_cut_face, 4.5);
  EXPECT_TRUE(greatest(MadeSkin(found), 12.0, 9.5).is_edge_cut);
  EXPECT_THAT(in_words(greatest(MadeSkin(found), 12.0, 9.5)), HasSubstr("The tumour's edge itself lies where"));
}

TEST(PlacedSkin, GoesByThePlaceWhereOneTriangleLiesOnTheFaceAndBesideIt) {
  const TetMesh coarse = make_block({24, 24, 8}, {1, 1, 1});  // two triangles are its top
  Segmentation found = block_of_voxels();
  for (const std::int32_t v : voxels_with(found, 2, 7)) {
    if (found.labels.grid.voxel_at(static_cast<std::size_t>(v))[0] >= 12) found.cut.push_back({v, 5});
  }
  const PlacedSkin skin(boundary_surface(coarse), coarse.vertices, MadeSkin(found));
  EXPECT_EQ(skin.cut_at(Vec3(18, 10, 8)), RegionFace::Superior);
  EXPECT_FALSE(skin.cut_at(Vec3(6, 10, 8)));
}

TEST(PlanOn, NamesTheGreatestMarginThatFitsWhereTheSetOneDoesNot) {
  const TissueModel model = block(24, 0.45);
  Case settings;
  settings.plan.depth_mm = 2.0;
  settings.plan.lateral_margin_mm = 9.0;
  Contour edge{{Vec3(9, 9, 8), Vec3(15, 9, 8), Vec3(15, 15, 8), Vec3(9, 15, 8)}, true};
  EXPECT_THAT([&] { return plan_on(settings, model, model.mesh.vertices, edge, {}); },
              ThrowsMessage<CaseError>(HasSubstr("A lateral margin of at most 8 mm fits here")));
  settings.plan.lateral_margin_mm = 8.0;
  EXPECT_EQ(plan_on(settings, model, model.mesh.vertices, edge, {}).waypoints.size(), 48U);
}

}  // namespace
}  // namespace incise
