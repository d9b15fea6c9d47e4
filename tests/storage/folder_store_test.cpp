#include "support/contour_shapes.hpp"
#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/storage/folder_store.hpp>
#include <incise/storage/path_schema.hpp>
#include <incise/storage/result_json.hpp>
#include <incise/workflow/study.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <numbers>

namespace incise {
namespace {

constexpr double kPi = std::numbers::pi;

/// A case of a block with 10 x 20 x 5 mm, and a store for its results.
class FolderStoreTest : public ::testing::Test {
 protected:
  void SetUp() override {
    write_vtu(folder_ / "block.vtu", make_block(Vec3(10, 20, 5), {2, 4, 1}));
    write_contour_csv(folder_ / "tumor.csv", testing::circle(2.0, 12, Vec3(5, 10, 5)));
  }

  CaseFile read(const std::string& more = "") {
    std::ofstream(folder_ / "case.yaml")
        << "schema: incise.case/1\nspecimen:\n  mesh: block.vtu\n  material: {poissons_ratio: 0.4}\n"
           "  constraints: [{kind: fixed, where: {box_mm: [[-1, -1, -1], [11, 1, 6]]}}]\n"
           "tumor: {contour: tumor.csv}\n"
        << more;
    return read_case(folder_.path());
  }

  Monitor silent_;

  /// A new store, as the next run of the program would make it.
  FolderStore open(const std::string& more = "") { return {read(more), folder_ / "out", {"incise test", 7, 2}}; }

  /// With another line in the group of the tumour.
  FolderStore open_with(const std::string& of_tumor) {
    static_cast<void>(read());
    std::string text = read_text(folder_ / "case.yaml");
    const std::string contour = "contour: tumor.csv";
    text.replace(text.find(contour), contour.size(), contour + ", " + of_tumor);
    std::ofstream(folder_ / "case.yaml") << text;
    return {read_case(folder_.path()), folder_ / "out", {"incise test", 7, 2}};
  }

  static ToolPath small_ring() {
    ToolPath path;
    for (int i = 0; i < 12; ++i) {
      const double angle = 2.0 * kPi * i / 12.0;
      path.waypoints.push_back(
          {Vec3(5.0 + 3.1 * std::cos(angle), 10.0 + 3.1 * std::sin(angle), 5.0), -Vec3::UnitZ(), 2.5, 7.0 + i});
    }
    path.tumor_edge = testing::circle(2.0, 12, Vec3(5, 10, 5));
    return path;
  }

  TissueModel model() { return tissue_of(read().settings, *open().read_specimen_mesh(silent_)); }
  StaticResult stretched() {
    StaticResult result;
    result.state = rest_state(model());
    return result;
  }
  /// Three tets, each removed for another cause, in one step.
  static SimulatedCut small_cut() {
    SimulatedCut cut;
    for (const RemovalCause cause : {RemovalCause::Dwell, RemovalCause::Tear, RemovalCause::LooseFragment}) {
      Removal removal;
      removal.tet = TetId(cut.incision.record.removals.size());
      removal.cause = cause;
      cut.incision.record.removals.push_back(removal);
    }
    cut.incision.final_tumor_edge = testing::circle(2.0, 12, Vec3(5, 10, 5));
    cut.incision.steps.push_back({0.5, 3, true, 20, 2, 0, 4, Vec3(1, 2, 3), Vec3(10, 20, 25)});
    cut.incision.slipped_bonds = 4;
    cut.incision.peak_tool_torque_mn_mm = 33.0;
    return cut;
  }

  std::vector<std::string> entries() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "out"))
      names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(FolderStoreTest, AnEmptyFolderHoldsNoProduct) {
  FolderStore store = open();
  EXPECT_FALSE(store.load_segmentation());
  EXPECT_FALSE(store.load_mesh());
  EXPECT_FALSE(store.load_plan());
  EXPECT_FALSE(store.load_cut(CutRole::AsPlanned));
  EXPECT_FALSE(store.load_correction());
}

TEST_F(FolderStoreTest, ReadsWhatTheCaseNames) {
  FolderStore store = open();
  const auto mesh = store.read_specimen_mesh(silent_);
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->tets.size(), 48U);
  EXPECT_EQ(store.read_tumor_edge()->points.size(), 12U);
  EXPECT_FALSE(store.read_line());
  EXPECT_FALSE(store.read_given_path());
}

TEST_F(FolderStoreTest, APlanComesBackExactly) {
  const ToolPath path = small_ring();
  open().save_plan(path, 0.5);
  const auto loaded = open().load_plan();
  ASSERT_TRUE(loaded);
  ASSERT_EQ(loaded->waypoints.size(), path.waypoints.size());
  for (std::size_t i = 0; i < path.waypoints.size(); ++i) {
    EXPECT_EQ(loaded->waypoints[i].position_mm, path.waypoints[i].position_mm);
    EXPECT_EQ(loaded->waypoints[i].axis, path.waypoints[i].axis);
    EXPECT_EQ(loaded->waypoints[i].depth_mm, path.waypoints[i].depth_mm);
    EXPECT_EQ(loaded->waypoints[i].speed_mm_s, path.waypoints[i].speed_mm_s);
  }
  EXPECT_EQ(loaded->tumor_edge.points, path.tumor_edge.points);
  EXPECT_EQ(loaded->frame, PathFrame::SimStretched);
}

TEST_F(FolderStoreTest, ASegmentationComesBackExactly) {
  Segmentation made;
  made.labels.grid.size = made.occupancy.grid.size = {3, 2, 2};
  made.labels.grid.spacing_mm = made.occupancy.grid.spacing_mm = Vec3(0.5, 0.75, 1.25);
  made.labels.grid.origin_mm = made.occupancy.grid.origin_mm = Vec3(-3.5, 2.0, 11.0);
  made.labels.voxels = {0, 1, 0, 1, 1, 1, 0, 0, 0, 0, 1, 0};
  for (int i = 0; i < 12; ++i) made.occupancy.voxels.push_back(static_cast<float>(i) / 11.0F);
  made.voxels = 5;
  made.volume_mm3 = 2.34375;
  made.occupancy_volume_mm3 = 2.2;
  made.tissue_hu = 41.0;
  made.components = 3;
  made.holes_filled = 1;
  open().save_segmentation(made, 0.1);
  const auto loaded = open().load_segmentation();
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->labels.voxels, made.labels.voxels);
  EXPECT_EQ(loaded->occupancy.voxels, made.occupancy.voxels);
  EXPECT_EQ(loaded->occupancy.grid.spacing_mm, made.occupancy.grid.spacing_mm);
  EXPECT_EQ(loaded->occupancy.grid.origin_mm, made.occupancy.grid.origin_mm);
  EXPECT_EQ(loaded->voxels, 5U);
  EXPECT_EQ(loaded->volume_mm3, 2.34375);
  EXPECT_EQ(loaded->components, 3U);
}

TEST_F(FolderStoreTest, AMeshComesBackExactly) {
  MeshProduct product;
  product.meshing.mesh = make_block(Vec3(1, 2, 3), {1, 1, 1});
  product.planned_cut_rest = testing::circle(1.0, 8);
  open().save_mesh(product, 0.1);
  const auto loaded = open().load_mesh();
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->vertices, product.meshing.mesh.vertices);
  EXPECT_EQ(loaded->tets, product.meshing.mesh.tets);
}

TEST_F(FolderStoreTest, AStretchedStateComesBackExactly) {
  FolderStore store = open();
  const CaseFile file = store.case_file();
  const TissueModel model =
      make_tissue_model(*store.read_specimen_mesh(silent_), file.settings.material, *file.settings.constraints);
  StaticResult result;
  result.outcome = Outcome::Success;
  result.state = rest_state(model);
  for (std::size_t v = 0; v < result.state.positions.size(); ++v)
    result.state.positions[v] += Vec3(1.0 / 3.0, 0.1 * double(v), -1e-9);
  result.reactions_mn = {Vec3(1, 2, 3)};
  result.iterations = 4;
  store.save_stretched(model, result, 0.2);
  const auto loaded = open().load_stretched(model);
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->outcome, Outcome::Success);
  EXPECT_EQ(loaded->state.positions, result.state.positions);
  EXPECT_EQ(loaded->iterations, 4);
  EXPECT_TRUE(std::isnan(loaded->relative_residual)) << "none was measured";
  const std::string json = read_text(folder_ / "out" / "stretched" / "deform.json");
  EXPECT_NE(json.find("\"relative_residual\": null"), std::string::npos) << json;
  EXPECT_NE(json.find("\"penetration_mm\": 0"), std::string::npos) << json;
  ASSERT_EQ(loaded->reactions_mn.size(), 1U);
  EXPECT_EQ(loaded->reactions_mn[0], Vec3(1, 2, 3));
}

TEST_F(FolderStoreTest, ACorrectionComesBackExactly) {
  Correction correction;
  correction.method = CompensationMethod::Paper;
  correction.moves.path = small_ring();
  for (std::size_t i = 0; i < correction.moves.path.waypoints.size(); ++i) {
    correction.moves.error_mm.push_back(0.1 * double(i));
    correction.moves.move_mm.push_back(-0.1 * double(i));
  }
  correction.moves.is_limited.assign(12, 0);
  correction.moves.is_interpolated.assign(12, 0);
  correction.moves.max_move_mm = 1.1;
  open().save_correction(correction, 0.0);
  const auto loaded = open().load_correction();
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->method, CompensationMethod::Paper);
  EXPECT_FALSE(loaded->iteration);
  EXPECT_EQ(loaded->moves.error_mm, correction.moves.error_mm);
  EXPECT_EQ(loaded->moves.move_mm, correction.moves.move_mm);
  EXPECT_EQ(loaded->moves.max_move_mm, 1.1);
}

/// A cut of which every measure is there.
SimulatedCut measured_cut() {
  SimulatedCut cut;
  cut.tets = 48;
  cut.incision.outcome = Outcome::Success;
  cut.incision.is_closed_loop = true;
  cut.incision.centerline = testing::circle(3.1, 40, Vec3(5, 10, 5));
  cut.incision.final_tumor_edge = testing::circle(2.0, 12, Vec3(5, 10, 5));
  cut.incision.record.removals.push_back({TetId(3), 2, 0.04, RemovalCause::Dwell, Vec3(1, 2, 3), 1.0 / 3.0});
  KerfMeasures& kerf = cut.incision.kerf;
  kerf.body.surface = boundary_surface(make_block({1, 2, 3}, {1, 1, 1}));
  kerf.body.volume_mm3 = 6.0;
  kerf.body.boundary = {12, 0, 1, 2};
  kerf.body.live_skin = {30, 0, 3, 4};
  kerf.layers = {{2.5, true, true, std::nullopt, 1.5, testing::circle(1.0 / 3.0, 9, Vec3(5, 10, 2.5))},
                 {4.0, true, false, 0.7, 0.0, std::nullopt},
                 {5.0, false, std::nullopt, std::nullopt, 0.0, std::nullopt}};
  kerf.depth = {4.5, {testing::circle(3.1, 8), {0, 1, 2, 3, 4, 5, 6, 7}, {0.1, 4, 4, 4, 4, 4, 4, 1.0 / 3.0}}, {4.5, 4.5, 4.5, 4.5, 4, 4.25, 4.5, 4.5}, {3.1, 0.1, 4.0}};
  kerf.drag = TissueDrag{{0.1, 0.2}, {0, 1.0 / 7.0}, {0.5, 0.6}, {-0.1, 0.2}, {0.55, 0.5, 0.6}, {0.05, -0.1, 0.2}};
  kerf.deep_margin = DeepMargin{1.5, 2.5, std::nullopt, {0.3, 0.1, 0.5}};
  kerf.final_centerline = testing::circle(3.0, 10);
  kerf.inner_edge_reference = testing::circle(2.5, 10);
  cut.layers.resize(3);
  return cut;
}

TEST_F(FolderStoreTest, WhatCameOutOfACutComesBackExactly) {
  FolderStore store = open();
  store.save_plan(small_ring(), 0.0);
  const TissueModel model = tissue_of(store.case_file().settings, *store.read_specimen_mesh(silent_));
  StaticResult stretched;
  stretched.state = rest_state(model);
  store.save_cut(CutRole::AsPlanned, model, stretched, measured_cut(), 0.1);
  const auto loaded = open().load_cut(CutRole::AsPlanned);
  ASSERT_TRUE(loaded);
  const KerfMeasures made = measured_cut().incision.kerf;
  const KerfMeasures& found = loaded->incision.kerf;
  EXPECT_EQ(found.body.surface.vertices, made.body.surface.vertices);
  EXPECT_EQ(found.body.surface.triangles, made.body.surface.triangles);
  EXPECT_EQ(found.body.boundary, made.body.boundary);
  EXPECT_EQ(found.body.live_skin, made.body.live_skin);
  ASSERT_EQ(found.layers.size(), 3U);
  EXPECT_EQ(found.layers[0].centerline->points, made.layers[0].centerline->points);
  EXPECT_EQ(found.layers[1].gap_mm, 0.7);
  EXPECT_FALSE(found.layers[2].is_closed);
  EXPECT_EQ(found.depth.profile.depth_mm, made.depth.profile.depth_mm);
  EXPECT_EQ(found.depth.profile.course.points, made.depth.profile.course.points);
  EXPECT_EQ(found.depth.planned_mm, 4.5);
  EXPECT_EQ(found.depth.planned_at_mm, made.depth.planned_at_mm);
  EXPECT_EQ(found.drag->arclength_mm, made.drag->arclength_mm);
  EXPECT_EQ(found.drag->drift.min, -0.1);
  EXPECT_EQ(found.deep_margin->beside_mm, 2.5);
  EXPECT_FALSE(found.deep_margin->beneath_mm);
  EXPECT_EQ(found.final_centerline->points, made.final_centerline->points);
  EXPECT_EQ(found.inner_edge_reference->points, made.inner_edge_reference->points);
}

TEST_F(FolderStoreTest, ALayerIsHeldAgainstTheLateralMargin) {
  FolderStore store = open();
  store.save_plan(small_ring(), 0.0);
  const SimulatedCut judged = judge(store.case_file().settings, measured_cut().incision, small_ring(), small_ring(), 48);
  ASSERT_EQ(judged.layers.size(), 3U);
  ASSERT_TRUE(judged.layers[0].signed_error_mm);
  EXPECT_NEAR(judged.layers[0].signed_error_mm->mean, -(2.0 - 1.0 / 3.0) - 5.0, 0.1) << "a third of a millimetre round the tumour's middle";
  EXPECT_FALSE(judged.layers[1].signed_error_mm);
}

TEST_F(FolderStoreTest, WhyADeepMarginIsNotKnownIsSaid) {
  SimulatedCut cut = measured_cut();
  cut.incision.kerf.deep_margin.reset();
  const nlohmann::ordered_json json = to_json(cut);
  EXPECT_TRUE(json.at("deep_margin_mm").is_null());
  EXPECT_NE(json.at("deep_margin_unknown").get<std::string>().find("tumor.surface"), std::string::npos);
}

TEST_F(FolderStoreTest, HeatIsThatOfThePathThatIsFollowedAlsoWhenTheCutIsRead) {
  ToolPath slow = small_ring();
  for (Waypoint& waypoint : slow.waypoints) waypoint.speed_mm_s = 0.5;
  write_tool_path(folder_ / "slow.json", slow);
  const auto slow_store = [this] { return open("path: slow.json\n"); };
  slow_store().save_plan(small_ring(), 0.0);
  const SimulatedCut planned = judge(read().settings, measured_cut().incision, small_ring(), small_ring(), 48);
  const SimulatedCut followed = judge(read().settings, measured_cut().incision, slow, small_ring(), 48);
  EXPECT_NEAR(followed.thermal_half_width_mm / planned.thermal_half_width_mm, 7.0 / 0.5, 1e-6) << "its slowest waypoint has 7 mm/s";
  EXPECT_LT(*followed.thermal_margin_mm, 0.0);
  slow_store().save_cut(CutRole::AsPlanned, model(), stretched(), followed, 0.1);
  const auto loaded = slow_store().load_cut(CutRole::AsPlanned);
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->thermal_half_width_mm, followed.thermal_half_width_mm);
}

// --- the tumour's surface

TEST_F(FolderStoreTest, ATumourSurfaceWithAHoleIsRefused) {
  TriMesh open_box = boundary_surface(make_block({1, 1, 1}, {1, 1, 1}));
  open_box.triangles.pop_back();
  write_ply(folder_ / "tumor.ply", open_box);
  std::ofstream(folder_ / "case.yaml") << "schema: incise.case/1\nspecimen: {mesh: block.vtu}\ntumor: {contour: tumor.csv, surface: tumor.ply}\n";
  FolderStore store(read_case(folder_.path()), folder_ / "out", {"incise test", 7, 2});
  try {
    static_cast<void>(store.read_tumor_surface());
    FAIL() << "expected DataError";
  } catch (const DataError& error) {
    EXPECT_EQ(error.path().filename(), "tumor.ply");
    EXPECT_NE(std::string(error.what()).find("open boundary"), std::string::npos) << error.what();
  }
}

TEST_F(FolderStoreTest, AChangedTumourSurfaceMakesTheCutStaleAndNotThePlan) {
  const auto with_surface = [this](double size) -> FolderStore {
    write_ply(folder_ / "tumor.ply", boundary_surface(make_block({size, 1, 1}, {1, 1, 1})));
    std::ofstream(folder_ / "case.yaml") << "schema: incise.case/1\nspecimen: {mesh: block.vtu}\ntumor: {contour: tumor.csv, surface: tumor.ply}\n";
    return {read_case(folder_.path()), folder_ / "out", {"incise test", 7, 2}};
  };
  FolderStore store = with_surface(1.0);
  store.save_plan(small_ring(), 0.0);
  const TissueModel model = make_tissue_model(*store.read_specimen_mesh(silent_), Material{}, {FixedConstraint{EndRegion{Vec3::UnitY(), 1.0}}});
  StaticResult stretched;
  stretched.state = rest_state(model);
  store.save_cut(CutRole::AsPlanned, model, stretched, measured_cut(), 0.1);
  EXPECT_TRUE(with_surface(1.0).is_current(Product::AsPlanned));
  EXPECT_FALSE(with_surface(2.0).is_current(Product::AsPlanned));
  EXPECT_TRUE(with_surface(2.0).is_current(Product::Plan));
}

// --- what a product depends on
// -----------------------------------------------------------------------------------------

TEST_F(FolderStoreTest, AChangedSettingMakesItsProductStale) {
  open().save_plan(small_ring(), 0.0);
  EXPECT_TRUE(open().is_current(Product::Plan));
  EXPECT_FALSE(open("plan: {depth_mm: 4}\n").load_plan()) << "its own group";
  EXPECT_FALSE(open_with("configuration: rest").load_plan()) << "where its edge is drawn";
  EXPECT_TRUE(open("plan: {depth_mm: 5}\n").load_plan()) << "the default, spelt out";
  EXPECT_TRUE(open("title: Another name\n").load_plan()) << "a setting that no product depends on";
}

TEST_F(FolderStoreTest, ASettingOfALaterStageLeavesAProductCurrent) {
  open().save_plan(small_ring(), 0.0);
  EXPECT_TRUE(open("cut: {dullness: 4}\n").load_plan());
  EXPECT_TRUE(open("tool: {diameter_mm: 0.8}\n").load_plan());
}

TEST_F(FolderStoreTest, AGivenMeshIsStretchedAnewForItsOwnSettingsOnly) {
  FolderStore store = open();
  store.save_stretched(model(), stretched(), 0.1);
  store.save_plan(small_ring(), 0.0);
  for (const char* more : {"meshing: {fine_mm: 0.5}\n", "plan: {depth_mm: 4}\n", "ct: {smoothing_mm: 1}\n", "cut: {dullness: 4}\n"}) {
    EXPECT_TRUE(open(more).is_current(Product::Stretched)) << more;
  }
  EXPECT_FALSE(open("plan: {depth_mm: 4}\n").is_current(Product::Plan));
  EXPECT_TRUE(open("meshing: {fine_mm: 0.5}\n").is_current(Product::Plan)) << "nothing is meshed";
}

TEST_F(FolderStoreTest, ATumourSurfaceThatIsAddedMakesTheCutStaleAlone) {
  open().save_stretched(model(), stretched(), 0.1);
  open().save_plan(small_ring(), 0.0);
  open().save_cut(CutRole::AsPlanned, model(), stretched(), small_cut(), 0.1);
  write_ply(folder_ / "tumor.ply", boundary_surface(make_block({1, 1, 1}, {1, 1, 1})));
  FolderStore with = open_with("surface: tumor.ply");
  EXPECT_TRUE(with.is_current(Product::Stretched));
  EXPECT_TRUE(with.is_current(Product::Plan));
  EXPECT_FALSE(with.is_current(Product::AsPlanned));
}

TEST_F(FolderStoreTest, ACaseFolderThatWasMovedKeepsItsProducts) {
  const std::filesystem::path before = folder_ / "before";
  const std::filesystem::path after = folder_ / "after";
  std::filesystem::create_directories(before);
  static_cast<void>(read());
  for (const char* name : {"block.vtu", "tumor.csv", "case.yaml"}) std::filesystem::rename(folder_ / name, before / name);
  const auto open_in = [](const std::filesystem::path& folder) -> FolderStore {
    return {read_case(folder), folder / "out", {"incise test", 7, 2}};
  };
  open_in(before).save_plan(small_ring(), 0.0);
  std::filesystem::rename(before, after);
  EXPECT_TRUE(open_in(after).load_plan());
  std::filesystem::rename(after / "tumor.csv", after / "edge.csv");
  std::string text = read_text(after / "case.yaml");
  text.replace(text.find("tumor.csv"), 9, "edge.csv");
  std::ofstream(after / "case.yaml") << text;
  EXPECT_TRUE(open_in(after).load_plan()) << "a file of another name with the same content";
}

TEST_F(FolderStoreTest, WhatIsOnlyHeldAgainstACutJudgesItAnewInItsFilesToo) {
  open().save_plan(small_ring(), 0.1);
  const SimulatedCut made = judge(read().settings, measured_cut().incision, small_ring(), small_ring(), 48);
  open().save_cut(CutRole::AsPlanned, model(), stretched(), made, 0.1);
  const std::filesystem::path cut = folder_ / "out" / "as_planned";
  const auto first = nlohmann::ordered_json::parse(read_text(cut / "incision.json"));
  const std::string manifest = read_text(cut / "manifest.json");

  const auto loaded = open("thermal: {absorbed_fraction: 0.25}\n").load_cut(CutRole::AsPlanned);
  ASSERT_TRUE(loaded) << "nothing of the cut itself is another";
  auto second = nlohmann::ordered_json::parse(read_text(cut / "incision.json"));
  EXPECT_EQ(second["thermal_half_width_mm"], loaded->thermal_half_width_mm);
  EXPECT_LT(loaded->thermal_half_width_mm, first["thermal_half_width_mm"].get<double>());
  const auto settings = nlohmann::json::parse(read_text(cut / "manifest.json"))["settings"];
  EXPECT_EQ(settings["thermal.absorbed_fraction"], "0.25");
  EXPECT_NO_THROW(require_replaceable(cut)) << "its manifest still lists its files";

  // Judged as it was again, it is what it was, to the last digit.
  ASSERT_TRUE(open().load_cut(CutRole::AsPlanned));
  EXPECT_EQ(nlohmann::ordered_json::parse(read_text(cut / "incision.json")), first);
  EXPECT_EQ(read_text(cut / "manifest.json"), manifest);
}

TEST_F(FolderStoreTest, AMarginThatAWaypointKeepsMakesTheCorrectionStaleAndNotTheCut) {
  open().save_plan(small_ring(), 0.1);
  open().save_cut(CutRole::AsPlanned, model(), stretched(), small_cut(), 0.1);
  Correction correction;
  correction.moves.path = small_ring();
  open().save_correction(correction, 0.1);
  FolderStore other = open("plan: {close_margin_mm: 3}\n");
  EXPECT_TRUE(other.is_current(Product::AsPlanned));
  EXPECT_FALSE(other.is_current(Product::Correction));
}

/// A correction that took one pass and kept it.
Correction small_correction(const ToolPath& path) {
  Correction correction;
  correction.moves.path = path;
  correction.moves.error_mm = {-1.0, -0.5};
  correction.moves.move_mm = {1.0, 0.5};
  correction.floor_mm = 0.1;
  ConvergedCompensation& done = correction.iteration.emplace();
  done.path = path;
  done.passes.resize(2);
  done.passes[0] = {{0.0, 0.0}, {-1.0, -0.5}, {0, 0}, {0, 1}, {0.5, 9.0}, {-1.25, -0.5}, 0.875, 1.25, 0.75, 4.0, 0.0, true};
  done.passes[1].offset_mm = {1.0, 0.5};
  done.passes[1].is_limited = {1, 0};
  done.passes[1].max_move_mm = 1.0;
  done.best = 0;
  done.outcome = CompensationOutcome::BestKept;
  return correction;
}

TEST_F(FolderStoreTest, ACorrectionComesBackPassByPass) {
  open().save_plan(small_ring(), 0.1);
  open().save_correction(small_correction(small_ring()), 0.1);
  const auto loaded = open().load_correction();
  ASSERT_TRUE(loaded && loaded->iteration);
  EXPECT_EQ(loaded->method, CompensationMethod::Default);
  EXPECT_EQ(loaded->floor_mm, 0.1);
  const ConvergedCompensation& done = *loaded->iteration;
  ASSERT_EQ(done.passes.size(), 2U);
  EXPECT_EQ(done.outcome, CompensationOutcome::BestKept);
  EXPECT_EQ(done.passes[0].mean_abs_error_mm, 0.875);
  EXPECT_EQ(done.passes[0].error_mm, (std::vector<double>{-1.0, -0.5}));
  EXPECT_EQ(done.passes[0].is_interpolated, (std::vector<std::uint8_t>{0, 1}));
  EXPECT_FALSE(done.passes[1].mean_abs_error_mm) << "it left nothing to measure";
  EXPECT_EQ(done.passes[1].is_limited, (std::vector<std::uint8_t>{1, 0}));
  EXPECT_FALSE(done.contraction);
  const std::filesystem::path folder = folder_ / "out" / "correction";
  EXPECT_EQ(read_text(folder / "history.csv"),
            "pass,waypoint,offset_mm,error_mm,limited,interpolated\n0,0,0,-1,0,0\n0,1,0,-0.5,0,1\n1,0,1,,1,1\n1,1,0.5,,0,1\n");
  EXPECT_EQ(read_text(folder / "errors.csv"), "pass,along_mm,signed_error_mm\n0,0.5,-1.25\n0,9,-0.5\n");
  EXPECT_FALSE(open("compensation: {method: paper}\n").load_correction()) << "another method";
}

TEST_F(FolderStoreTest, ADamagedCorrectionSaysWhatToRemove) {
  open().save_plan(small_ring(), 0.1);
  open().save_correction(small_correction(small_ring()), 0.1);
  const std::filesystem::path file = folder_ / "out" / "correction" / "compensate.json";
  const std::string whole = read_text(file);
  for (const auto& [from, to] : {std::pair{"\"best_kept\"", "\"fine\""}, std::pair{"\"best_pass\": 0", "\"best_pass\": 7"}}) {
    std::string text = whole;
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), std::string(from).size(), to);
    std::ofstream(file) << text;
    try {
      static_cast<void>(open().load_correction());
      FAIL() << to;
    } catch (const DataError& error) {
      EXPECT_NE(std::string(error.what()).find("Remove the folder"), std::string::npos) << error.what();
    }
  }
}

TEST_F(FolderStoreTest, APassBecomesTheCorrectedCutAndThePassesGo) {
  open().save_plan(small_ring(), 0.1);
  open().save_cut(CutRole::AsPlanned, model(), stretched(), small_cut(), 0.1);
  EXPECT_FALSE(open().adopt_cut(CutRole::Pass1)) << "it was not made";
  for (const CutRole role : {CutRole::Pass1, CutRole::Pass2}) open().save_cut(role, model(), stretched(), small_cut(), 0.1);
  open().save_correction(small_correction(small_ring()), 0.1);
  EXPECT_TRUE(open().load_cut(CutRole::Pass1));
  const std::string pass = read_text(folder_ / "out" / "pass_1" / "incision.json");
  std::ofstream(folder_ / "out" / "pass_2" / "note.txt") << "mine";
  EXPECT_THROW(static_cast<void>(open().adopt_cut(CutRole::Pass1)), DataError) << "a file of the user's own";
  EXPECT_TRUE(open().is_current(Product::Pass1));
  std::filesystem::remove(folder_ / "out" / "pass_2" / "note.txt");
  EXPECT_TRUE(open().adopt_cut(CutRole::Pass1));
  EXPECT_TRUE(open().load_cut(CutRole::Corrected));
  EXPECT_EQ(read_text(folder_ / "out" / "corrected" / "incision.json"), pass);
  EXPECT_NO_THROW(require_replaceable(folder_ / "out" / "corrected")) << "its manifest lists its files";
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "pass_1"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "pass_2"));
  EXPECT_TRUE(open().load_cut(CutRole::AsPlanned)) << "the first cut stays";
  EXPECT_TRUE(open().adopt_cut(CutRole::Pass1)) << "it is there already";
}

TEST_F(FolderStoreTest, AChangedPowerIsCutAnewAndPlannedNoMore) {
  open("plan: {power_w: 35}\n").save_plan(small_ring(), 0.1);
  open("plan: {power_w: 35}\n").save_cut(CutRole::AsPlanned, model(), stretched(), small_cut(), 0.1);
  FolderStore other = open("plan: {power_w: 30}\n");
  EXPECT_TRUE(other.load_plan());
  EXPECT_FALSE(other.load_cut(CutRole::AsPlanned));
}

TEST_F(FolderStoreTest, ACutComesBackWithItsCausesSlipsAndTorque) {
  open().save_plan(small_ring(), 0.1);
  open().save_cut(CutRole::AsPlanned, model(), stretched(), small_cut(), 0.1);
  const auto loaded = open().load_cut(CutRole::AsPlanned);
  ASSERT_TRUE(loaded);
  const std::vector<Removal>& removals = loaded->incision.record.removals;
  ASSERT_EQ(removals.size(), 3U);
  EXPECT_EQ(removals[0].cause, RemovalCause::Dwell);
  EXPECT_EQ(removals[1].cause, RemovalCause::Tear);
  EXPECT_EQ(removals[2].cause, RemovalCause::LooseFragment);
  EXPECT_EQ(loaded->incision.slipped_bonds, 4U);
  EXPECT_EQ(loaded->incision.peak_tool_torque_mn_mm, 33.0);
  EXPECT_GT(loaded->thermal_half_width_mm, 0.0);
}

TEST_F(FolderStoreTest, EachStepOfACutHasALineWithForceAndTorque) {
  open().save_plan(small_ring(), 0.1);
  open().save_cut(CutRole::AsPlanned, model(), stretched(), small_cut(), 0.1);
  std::ifstream in(folder_ / "out" / "as_planned" / "steps.csv");
  std::string header;
  std::string line;
  std::getline(in, header);
  std::getline(in, line);
  EXPECT_EQ(header, "time_s,iterations,tets_in_contact,removed,slipped,tool_force_x_mn,tool_force_y_mn,tool_force_z_mn,"
                    "tool_torque_x_mn_mm,tool_torque_y_mn_mm,tool_torque_z_mn_mm");
  EXPECT_EQ(line, "0.5,3,20,2,4,1,2,3,10,20,25");
}

TEST_F(FolderStoreTest, ACauseThatThereIsNotIsRefusedNamingItsFile) {
  open().save_plan(small_ring(), 0.1);
  open().save_cut(CutRole::AsPlanned, model(), stretched(), small_cut(), 0.1);
  const std::filesystem::path file = folder_ / "out" / "as_planned" / "incision.json";
  nlohmann::ordered_json json;
  std::ifstream(file) >> json;
  json["removals"][0][3] = 9;
  std::ofstream(file) << json;
  try {
    static_cast<void>(open().load_cut(CutRole::AsPlanned));
    FAIL() << "the file was changed";
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find("incision.json: found a file that was changed since it was computed"),
              std::string::npos)
        << error.what();
  }
  const std::filesystem::path stage = folder_ / "out" / "as_planned" / "stage.json";  // forged, too
  nlohmann::ordered_json digests;
  std::ifstream(stage) >> digests;
  digests["files"]["incision.json"] = sha256_of_file(file);
  std::ofstream(stage) << digests;
  try {
    static_cast<void>(open().load_cut(CutRole::AsPlanned));
    FAIL() << "there is no cause 9";
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find("incision.json: removals: found a cause 9"), std::string::npos) << error.what();
  }
}

TEST_F(FolderStoreTest, AChangedInputFileMakesItsProductsStale) {
  open().save_plan(small_ring(), 0.0);
  write_contour_csv(folder_ / "tumor.csv", testing::circle(2.5, 12, Vec3(5, 10, 5)));
  EXPECT_FALSE(open().load_plan());
  write_contour_csv(folder_ / "tumor.csv", testing::circle(2.0, 12, Vec3(5, 10, 5)));
  EXPECT_TRUE(open().load_plan()) << "as it was";
  write_vtu(folder_ / "block.vtu", make_block(Vec3(10, 20, 5), {2, 5, 1}));
  EXPECT_FALSE(open().load_plan());
}

TEST_F(FolderStoreTest, AChangedHolderMakesTheStretchStale) {
  const auto write_holder = [this](double z) {
    std::ofstream(folder_ / "holder.stl") << "solid s\nfacet normal 0 0 1\nouter loop\nvertex -90 -90 " << z << "\nvertex 90 -90 " << z
                                          << "\nvertex 0 90 " << z << "\nendloop\nendfacet\nendsolid s\n";
  };
  const auto open_held = [this]() -> FolderStore {
    std::ofstream(folder_ / "case.yaml")
        << "schema: incise.case/1\nspecimen:\n  mesh: block.vtu\n  constraints:\n"
           "    - {kind: fixed, where: {box_mm: [[-1, -1, -1], [11, 1, 6]]}}\n    - {kind: support, surface: holder.stl}\n";
    return {read_case(folder_.path()), folder_ / "out", {"incise test", 7, 2}};
  };
  write_holder(-1.0);
  FolderStore store = open_held();
  const TissueModel model = tissue_of(store.case_file().settings, *store.read_specimen_mesh(silent_));
  StaticResult result;
  result.state = rest_state(model);
  store.save_stretched(model, result, 0.1);
  EXPECT_TRUE(open_held().is_current(Product::Stretched));
  write_holder(-2.0);
  EXPECT_FALSE(open_held().is_current(Product::Stretched));
  const auto inputs = read_text(folder_ / "out" / "stretched" / "manifest.json");
  EXPECT_NE(inputs.find("holder.stl"), std::string::npos);
}

TEST_F(FolderStoreTest, AMeshThatIsNotOneSoundBodyIsRefusedNamingTheFile) {
  TetMesh mesh = make_block(Vec3(10, 20, 5), {2, 4, 1});
  mesh.tets.push_back(mesh.tets[5]);
  write_vtu(folder_ / "block.vtu", mesh);
  try {
    static_cast<void>(open().read_specimen_mesh(silent_));
    FAIL() << "expected DataError";
  } catch (const DataError& error) {
    EXPECT_EQ(error.path().filename(), "block.vtu");
    EXPECT_NE(std::string(error.what()).find("the first is tet 48"), std::string::npos) << error.what();
  }
}

TEST_F(FolderStoreTest, ANewProductTakesThePlaceOfAStaleOneAsAWhole) {
  open().save_plan(small_ring(), 0.0);
  std::ofstream(folder_ / "out/plan/stage.json", std::ios::app) << "\n";
  open("plan: {depth_mm: 4}\n").save_plan(small_ring(), 0.0);
  EXPECT_EQ(read_text(folder_ / "out/plan/stage.json").find("\n\n"), std::string::npos);
  EXPECT_TRUE(open("plan: {depth_mm: 4}\n").load_plan());
  EXPECT_EQ(entries(), std::vector<std::string>{"plan"});
}

TEST_F(FolderStoreTest, AFileOfTheUsersOwnIsNeverRemoved) {
  Correction correction;
  correction.moves.path = small_ring();
  open().save_plan(small_ring(), 0.0);
  open().save_correction(correction, 0.0);
  for (const char* name : {"plan", "correction"}) {  // the one that is replaced, and one that is stale after it
    const std::filesystem::path note = folder_ / "out" / name / "note.txt";
    std::ofstream(note) << "mine";
    EXPECT_THROW(open("plan: {depth_mm: 4}\n").save_plan(small_ring(), 0.0), DataError) << name;
    EXPECT_TRUE(std::filesystem::exists(note));
    EXPECT_TRUE(open().load_plan());
    std::filesystem::remove(note);
  }
  open("plan: {depth_mm: 4}\n").save_plan(small_ring(), 0.0);
  EXPECT_EQ(entries(), std::vector<std::string>{"plan"});
}

TEST_F(FolderStoreTest, TheSchemaOfAPathNamesEveryFieldThatIsWritten) {
  const auto schema = nlohmann::json::parse(path_schema_json());
  ToolPath path = small_ring();
  path.T_robot_sim = Mat4::Identity();
  path.tumor_edge.is_closed = false;
  path.source_sha256 = sha256_of_text("");
  path.specimen_id = "tongue-07";
  path.is_virtual = true;
  const auto written = nlohmann::json::parse(to_json(path));
  const auto keys_of = [](const nlohmann::json& object) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : object.items()) keys.push_back(key);
    return keys;
  };
  EXPECT_EQ(keys_of(written), keys_of(schema["properties"]));
  EXPECT_EQ(keys_of(written["waypoints"][0]), keys_of(schema["properties"]["waypoints"]["items"]["properties"]));
  EXPECT_EQ(written["schema"], schema["properties"]["schema"]["const"]);
  for (const char* key : {"frame", "kind"}) {
    const auto& names = schema["properties"][key]["enum"];
    EXPECT_NE(std::find(names.begin(), names.end(), written[key]), names.end());
  }
  // What is required is all that the reader asks for.
  nlohmann::json least;
  for (const std::string key : schema["required"]) least[key] = written[key];
  EXPECT_EQ(tool_path_from_json(least.dump(), "least").waypoints.size(), path.waypoints.size());
  for (const std::string key : schema["required"]) {
    nlohmann::json less = least;
    less.erase(key);
    EXPECT_THROW(static_cast<void>(tool_path_from_json(less.dump(), "less")), DataError) << key;
  }
}

TEST_F(FolderStoreTest, AProductWithoutItsStageFileCountsAsAbsent) {
  open().save_plan(small_ring(), 0.0);
  std::filesystem::remove(folder_ / "out/plan/stage.json");
  EXPECT_FALSE(open().load_plan());
}

TEST_F(FolderStoreTest, AProductThatCannotBeWrittenLeavesNothing) {
  FolderStore store = open();
  ToolPath broken = small_ring();
  broken.waypoints[3].axis = Vec3::Zero();
  EXPECT_ANY_THROW(store.save_plan(broken, 0.0));
  EXPECT_EQ(entries(), std::vector<std::string>{});
}

TEST_F(FolderStoreTest, ADamagedProductIsRefusedNamingItsFile) {
  open().save_plan(small_ring(), 0.0);
  std::ofstream(folder_ / "out/plan/path.json") << "{ not json";
  try {
    static_cast<void>(open().load_plan());
    FAIL() << "the path is damaged";
  } catch (const DataError& error) {
    EXPECT_EQ(error.path(), folder_ / "out/plan/path.json");
    EXPECT_NE(std::string(error.what()).find("Remove the folder"), std::string::npos) << error.what();
  }
}

TEST_F(FolderStoreTest, EveryProductHasAManifestWithSettingsInputsSeedAndThreads) {
  open("plan: {depth_mm: 4}\n").save_plan(small_ring(), 1.5);
  const Manifest manifest = read_manifest(folder_ / "out/plan");
  EXPECT_EQ(manifest.command, "incise test");
  EXPECT_EQ(manifest.seed, 7U);
  EXPECT_EQ(manifest.threads, 2);
  EXPECT_EQ(manifest.wall_s, 1.5);
  EXPECT_NE(manifest.settings_json.find("plan.depth_mm"), std::string::npos);
  ASSERT_EQ(manifest.inputs.size(), 3U);
  EXPECT_EQ(manifest.inputs[0].path, "case.yaml");
  EXPECT_EQ(manifest.inputs[1].path, "block.vtu");
  EXPECT_EQ(manifest.inputs[1].sha256, sha256_of_file(folder_ / "block.vtu"));
  EXPECT_EQ(manifest.inputs[2].path, "tumor.csv");
}

TEST_F(FolderStoreTest, AnOutputThatIsAFileIsRefused) {
  std::ofstream(folder_ / "occupied") << "a file";
  EXPECT_THROW(FolderStore(read(), folder_ / "occupied", {}), DataError);
  EXPECT_THROW(FolderStore(read(), folder_ / "occupied" / "below", {}), DataError);
}

}  // namespace
}  // namespace incise
