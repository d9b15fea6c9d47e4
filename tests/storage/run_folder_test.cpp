#include "support/contour_shapes.hpp"
#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/entry_folder.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/volume_io.hpp>
#include <incise/storage/path_schema.hpp>
#include <incise/storage/result_json.hpp>
#include <incise/storage/run_folder.hpp>
#include <incise/workflow/study.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace incise {
namespace {

using units::kPi;

/// A case of a block with 10 x 20 x 5 mm, and a folder for its results.
class RunFolderTest : public ::testing::Test {
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

  template <class Action>
  static void expect_file_refused(const Action& action, const char* file, const char* says) {
    const auto error = testing::error_of<DataError>(action);
    ASSERT_TRUE(error) << "no DataError for " << file << ": " << says;
    EXPECT_EQ(error->path().filename(), file);
    EXPECT_THAT(error->what(), ::testing::HasSubstr(says));
  }

  Monitor silent_;

  /// The folder, as the next run of the program would make it.
  RunFolder open(const std::string& more = "") { return {read(more), folder_ / "out", {"incise test", 7, 2}}; }

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
    StaticResult result{.state = rest_state(model())};
    return result;
  }
  /// Three tets, each removed for another cause, in one step.
  static SimulatedCut small_cut() {
    SimulatedCut cut;
    for (const RemovalCause cause : {RemovalCause::Dwell, RemovalCause::Tear, RemovalCause::LooseFragment}) {
      Removal removal{.tet = TetId(cut.incision.record.removals.size()), .cause = cause};
      cut.incision.record.removals.push_back(removal);
    }
    cut.incision.final_tumor_edge = testing::circle(2.0, 12, Vec3(5, 10, 5));
    cut.incision.steps.push_back({0.5, 3, true, 20, 2, 0, 4, Vec3(1, 2, 3), Vec3(10, 20, 25)});
    cut.incision.slipped_bonds = 4;
    cut.incision.peak_tool_torque_mn_mm = 33.0;
    return cut;
  }

  static ProductNote note(const char* name, const char* key = "a key") { return {name, key, 1.5}; }

  std::vector<std::string> entries() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "out"))
      names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

  testing::TemporaryFolder folder_;
};

/// A cut of which every measure is there.
SimulatedCut measured_cut() {
  SimulatedCut cut{.tets = 48};
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
  kerf.layers = {{2.5, true, true, std::nullopt, std::nullopt, 1.5, testing::circle(1.0 / 3.0, 9, Vec3(5, 10, 2.5))},
                 {4.0, true, false, 0.7, Vec3(1.0 / 3.0, 2, 3), 0.0, std::nullopt},
                 {5.0, false, std::nullopt, std::nullopt, std::nullopt, 0.0, std::nullopt}};
  kerf.depth = {4.5,
                {testing::circle(3.1, 8), {0, 1, 2, 3, 4, 5, 6, 7}, {0.1, 4, 4, 4, 4, 4, 4, 1.0 / 3.0}},
                {4.5, 4.5, 4.5, 4.5, 4, 4.25, 4.5, 4.5},
                {3.1, 0.1, 4.0}};
  kerf.drag = TissueDrag{{0.1, 0.2}, {0, 1.0 / 7.0}, {0.5, 0.6}, {-0.1, 0.2}, {0.55, 0.5, 0.6}, {0.05, -0.1, 0.2}};
  kerf.deep_margin = DeepMargin{1.5, 2.5, std::nullopt, {0.3, 0.1, 0.5}};
  kerf.final_centerline = testing::circle(3.0, 10);
  kerf.inner_edge_reference = testing::circle(2.5, 10);
  cut.layers.resize(3);
  return cut;
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
  done.passes[0] = {{0.0, 0.0}, {-1.0, -0.5}, {0, 0}, {0, 1}, {0.5, 9.0}, {-1.25, -0.5},
                    0.875,      1.25,         0.75,   4.0,    0.0,        true};
  done.passes[1].offset_mm = {1.0, 0.5};
  done.passes[1].is_limited = {1, 0};
  done.passes[1].max_move_mm = 1.0;
  done.best = 0;
  done.outcome = CompensationOutcome::BestKept;
  return correction;
}

TEST_F(RunFolderTest, ReadsWhatTheCaseNames) {
  RunFolder run = open();
  const auto mesh = run.read_specimen_mesh(silent_);
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->tets.size(), 48U);
  EXPECT_EQ(run.read_tumor_edge()->points.size(), 12U);
  EXPECT_FALSE(run.read_line());
  EXPECT_FALSE(run.read_given_path());
}

TEST_F(RunFolderTest, KeepsItsCacheInTheFolderSoThatItMayBeMoved) {
  Monitor quiet;
  const CacheKey key = CacheKey("plan").add(small_ring());
  open().cache().keep("plan", key, small_ring());
  EXPECT_EQ(bytes_of(open().cache().find<ToolPath>("plan", key, quiet).value()), bytes_of(small_ring()));
  std::filesystem::rename(folder_ / "out", folder_ / "moved");
  RunFolder moved(read(), folder_ / "moved", {});
  EXPECT_TRUE(moved.cache().find<ToolPath>("plan", key, quiet));
  EXPECT_FALSE(moved.has_products());
}

TEST_F(RunFolderTest, ARunTakesTheProductsThatAnotherHasKeptAndLeavesItsOwn) {
  const std::string theirs = std::string(kCacheMagic) + "theirs", own = std::string(kCacheMagic) + "own";
  EntryFolder from(folder_ / "a/cache"), to(folder_ / "b/cache");
  for (const char* name : {"mesh", "plan", "as_planned", "verdicts"}) from.save(name, theirs);
  to.save("plan", own);
  take_products(folder_ / "a", folder_ / "b", Stage::Plan);
  EXPECT_EQ(to.load("mesh"), theirs);
  EXPECT_EQ(to.load("plan"), own);
  EXPECT_FALSE(to.holds("as_planned")) << "beyond the last stage that was asked for";
  take_products(folder_ / "a", folder_ / "b", Stage::Verify);
  EXPECT_EQ(to.load("as_planned"), theirs);
  EXPECT_FALSE(to.holds("verdicts")) << "what was judged there";
  EXPECT_NO_THROW(take_products(folder_ / "none", folder_ / "b", Stage::Verify));
}

TEST_F(RunFolderTest, ARunThatTookTheProductsOfAnotherComputesNoneOfThem) {
  Workers workers(1);
  const auto run_in = [&](const char* name) {
    RunFolder run(read("plan: {lateral_margin_mm: 1.5, depth_mm: 1}\n"), folder_ / name, {"incise test", 7, 2});
    return run_study(run.case_file().settings, run, run.cache(), {.until = Stage::Plan}, workers, silent_, run);
  };
  const Study first = run_in("a");
  take_products(folder_ / "a", folder_ / "b", Stage::Plan);
  const Study second = run_in("b");
  for (const StageReport& stage : second.stages) EXPECT_NE(stage.state, StageState::Computed) << to_string(stage.stage);
  EXPECT_EQ(bytes_of(*second.plan), bytes_of(*first.plan));
  EXPECT_EQ(bytes_of(second.stretched->state), bytes_of(first.stretched->state));
}

TEST_F(RunFolderTest, AScanIsKnownByItsContentAndHowItIsRead) {
  std::filesystem::create_directories(folder_ / "ct");
  std::ofstream(folder_ / "ct" / "1.png") << "one";
  const auto digest = [this](const std::string& more) {
    std::ofstream(folder_ / "case.yaml") << "schema: incise.case/1\nct: {volume: ct" << more
                                         << "}\ntumor: {contour: tumor.csv}\n";
    Monitor quiet;
    return RunFolder(read_case(folder_.path()), folder_ / "out", {}).scan_digest(quiet);
  };
  const std::string first = digest("");
  EXPECT_EQ(digest(", opening_radius_mm: 2"), first) << "what is made of it does not count";
  EXPECT_NE(digest(", spacing_mm: [1, 1, 2]"), first);
  std::ofstream(folder_ / "ct" / "1.png") << "two";
  EXPECT_NE(digest(""), first);
}

TEST_F(RunFolderTest, LabelsTakeThePlaceOfThresholdsAndHaveToLieInTheirScan) {
  LabelVolume labels{{.size = {4, 4, 4}}, std::vector<std::uint8_t>(64, 0)};
  labels.at(1, 1, 1) = 2;
  write_labels(folder_ / "labels.nrrd", labels);
  CtVolume ct{labels.grid, std::vector<std::int16_t>(64, 40)};
  ct.grid.origin_mm = Vec3(0, 0, 10);
  write_ct(folder_ / "ct.nrrd", ct);
  Monitor quiet;
  const auto opened = [this](const std::string& of_ct) {
    std::ofstream(folder_ / "case.yaml") << "schema: incise.case/1\nct: {labels: labels.nrrd" << of_ct
                                         << "}\ntumor: {contour: tumor.csv}\n";
    return RunFolder(read_case(folder_.path()), folder_ / "out", {});
  };
  RunFolder alone = opened("");
  ASSERT_TRUE(alone.read_labels(quiet));
  EXPECT_EQ(alone.read_labels(quiet)->voxels, labels.voxels);
  EXPECT_TRUE(alone.specimen_id().starts_with("ct-")) << alone.specimen_id();
  const std::string digest = alone.scan_digest(quiet);
  labels.at(2, 2, 2) = 1;
  write_labels(folder_ / "labels.nrrd", labels);
  EXPECT_NE(opened("").scan_digest(quiet), digest);
  expect_file_refused([&] { return opened(", volume: ct.nrrd").read_labels(quiet); }, "labels.nrrd",
                      "tissue inside the volume");
}

TEST_F(RunFolderTest, ALayerIsHeldAgainstTheLateralMargin) {
  RunFolder run = open();
  const SimulatedCut judged = judge(run.case_file().settings, measured_cut().incision, small_ring(), small_ring(), 48);
  ASSERT_EQ(judged.layers.size(), 3U);
  ASSERT_TRUE(judged.layers[0].signed_error_mm);
  EXPECT_NEAR(judged.layers[0].signed_error_mm->mean, -(2.0 - 1.0 / 3.0) - 5.0, 0.1)
      << "a third of a millimetre round the tumour's middle";
  EXPECT_FALSE(judged.layers[1].signed_error_mm);
}

TEST_F(RunFolderTest, WhyADeepMarginIsNotKnownIsSaid) {
  SimulatedCut cut = measured_cut();
  cut.incision.kerf.deep_margin.reset();
  const nlohmann::ordered_json json = to_json(cut);
  EXPECT_TRUE(json.at("deep_margin_mm").is_null());
  EXPECT_NE(json.at("deep_margin_unknown").get<std::string>().find("tumor.surface"), std::string::npos);
}

TEST_F(RunFolderTest, ATumourSurfaceWithAHoleIsRefused) {
  TriMesh open_box = boundary_surface(make_block({1, 1, 1}, {1, 1, 1}));
  open_box.triangles.pop_back();
  write_ply(folder_ / "tumor.ply", open_box);
  std::ofstream(folder_ / "case.yaml")
      << "schema: incise.case/1\nspecimen: {mesh: block.vtu}\ntumor: {contour: tumor.csv, surface: tumor.ply}\n";
  RunFolder run(read_case(folder_.path()), folder_ / "out", {"incise test", 7, 2});
  expect_file_refused([&] { return run.read_tumor_surface(); }, "tumor.ply", "open boundary");
}

TEST_F(RunFolderTest, AMeshThatIsNotOneSoundBodyIsRefusedNamingTheFile) {
  TetMesh mesh = make_block(Vec3(10, 20, 5), {2, 4, 1});
  mesh.tets.push_back(mesh.tets[5]);
  write_vtu(folder_ / "block.vtu", mesh);
  expect_file_refused([&] { return open().read_specimen_mesh(silent_); }, "block.vtu", "the first is tet 48");
}

TEST_F(RunFolderTest, HeatIsThatOfThePathThatIsFollowed) {
  ToolPath slow = small_ring();
  for (Waypoint& waypoint : slow.waypoints) waypoint.speed_mm_s = 0.5;
  const SimulatedCut planned = judge(read().settings, measured_cut().incision, small_ring(), small_ring(), 48);
  const SimulatedCut followed = judge(read().settings, measured_cut().incision, slow, small_ring(), 48);
  EXPECT_NEAR(followed.thermal_half_width_mm / planned.thermal_half_width_mm, 7.0 / 0.5, 1e-6)
      << "its slowest waypoint has 7 mm/s";
  EXPECT_LT(*followed.thermal_margin_mm, 0.0);
}

// --- what people look at

TEST_F(RunFolderTest, AProductIsWrittenOnceForAKeyAndAnewForAnother) {
  open().plan(note("plan"), small_ring());
  const std::filesystem::path file = folder_ / "out" / "plan" / "stage.json";
  std::ofstream(file, std::ios::app) << "\n";
  open().plan(note("plan"), small_ring());
  EXPECT_TRUE(read_text(file).ends_with("\n\n")) << "it is there already";
  open().plan(note("plan", "another"), small_ring());
  EXPECT_FALSE(read_text(file).ends_with("\n\n"));
  EXPECT_EQ(entries(), std::vector<std::string>{"plan"});
}

TEST_F(RunFolderTest, AProductOfAnotherSpecimenIsWrittenAnew) {
  for (const char* id : {"tongue-07", "tongue-08"}) {
    open(std::string("specimen_id: ") + id + "\n").plan(note("plan"), small_ring());
    EXPECT_EQ(read_tool_path(folder_ / "out" / "plan" / "path.json").specimen_id, id);
    EXPECT_EQ(read_manifest(folder_ / "out" / "plan").specimen_id, id);
  }
}

TEST_F(RunFolderTest, WhatWasChangedAddedOrDamagedSinceIsRefusedNamingIt) {
  const auto write = [this] { open().cut(note("as_planned"), model(), stretched(), measured_cut()); };
  write();
  const std::filesystem::path folder = folder_ / "out" / "as_planned";
  const auto expect_refused = [&](const char* name, const char* says) {
    const auto error = testing::error_of<DataError>(write);
    ASSERT_TRUE(error) << name;
    EXPECT_EQ(error->path(), folder / name);
    EXPECT_THAT(error->what(), ::testing::AllOf(::testing::HasSubstr(says), ::testing::HasSubstr("Remove the folder")));
  };
  for (const char* name : {"centerline.csv", "incision.json", "kerf.vtp"}) {
    const std::string sound = read_text(folder / name);
    std::ofstream(folder / name, std::ios::app) << "\n";
    expect_refused(name, "a file that was changed since it was computed");
    std::filesystem::remove(folder / name);
    expect_refused(name, "no such file any more");
    std::ofstream(folder / name) << sound;
  }
  std::ofstream(folder / "centerline_9mm.csv") << "x\n";
  expect_refused("centerline_9mm.csv", "a file that was added since");
  std::filesystem::remove(folder / "centerline_9mm.csv");
  std::ofstream(folder / "note.txt") << "mine";
  EXPECT_NO_THROW(write());
  std::ofstream(folder / "stage.json") << "{ not json";
  expect_refused("stage.json", "a damaged file");
}

TEST_F(RunFolderTest, ACutThatIsJudgedAnewIsWrittenAnew) {
  const auto write = [this](const std::string& more) {
    open(more).cut(note("as_planned"), model(), stretched(),
                   judge(read(more).settings, measured_cut().incision, small_ring(), small_ring(), 48));
    return nlohmann::json::parse(read_text(folder_ / "out" / "as_planned" / "incision.json"));
  };
  const auto first = write("");
  const auto second = write("thermal: {absorbed_fraction: 0.25}\n");
  EXPECT_LT(second["thermal_half_width_mm"].get<double>(), first["thermal_half_width_mm"].get<double>());
  EXPECT_EQ(write(""), first);
}

TEST_F(RunFolderTest, WhatWasMadeFromAnOlderProductGoes) {
  open().plan(note("plan"), small_ring());
  open().correction(note("correction"), small_correction(small_ring()));
  AtomicFolder program(folder_ / "out" / "program");
  open().write_manifest_to(program.path(), 0.0);
  program.commit();
  open().plan(note("plan", "another"), small_ring());
  EXPECT_EQ(entries(), std::vector<std::string>{"plan"});
}

TEST_F(RunFolderTest, AFileOfTheUsersOwnIsNeverRemoved) {
  open().plan(note("plan"), small_ring());
  open().correction(note("correction"), small_correction(small_ring()));
  for (const char* name : {"plan", "correction"}) {  // the one that is replaced, and one that goes after it
    const std::filesystem::path own = folder_ / "out" / name / "note.txt";
    std::ofstream(own) << "mine";
    EXPECT_THROW(open().plan(note("plan", "another"), small_ring()), DataError) << name;
    EXPECT_TRUE(std::filesystem::exists(own));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "plan" / "path.json"));
    std::filesystem::remove(own);
  }
  open().plan(note("plan", "another"), small_ring());
  EXPECT_EQ(entries(), std::vector<std::string>{"plan"});
}

TEST_F(RunFolderTest, AProductThatCannotBeWrittenLeavesNothing) {
  ToolPath broken = small_ring();
  broken.waypoints[3].axis = Vec3::Zero();
  EXPECT_ANY_THROW(open().plan(note("plan"), broken));
  EXPECT_EQ(entries(), std::vector<std::string>{});
}

TEST_F(RunFolderTest, AVerdictIsNotedInThePathAndIsNoChangeOfIt) {
  open().plan(note("plan"), small_ring());
  Verdict verdict;
  verdict.add("depth", 0.5, "too shallow");
  open().verdicts(verdict, std::nullopt);
  const std::filesystem::path file = folder_ / "out" / "plan" / "path.json";
  EXPECT_TRUE(read_path_verdict(file).has("depth"));
  const std::string noted = read_text(file);
  open().plan(note("plan"), small_ring());
  EXPECT_EQ(read_text(file), noted);
  Monitor quiet;
  open("plan: {close_margin_mm: 3}\n").remove_what_is_out_of_date(Stage::Verify, quiet);
  EXPECT_NE(read_text(file), noted) << "it was judged by other limits";
}

TEST_F(RunFolderTest, ARunThatEndsBeforeItCutsLeavesTheVerdictAndEveryRunLeavesARefusal) {
  open().plan(note("plan"), small_ring());
  Verdict verdict;
  verdict.add("depth", 0.5, "too shallow");
  verdict.add("open_layer", 0.5, "open");
  open().verdicts(verdict, std::nullopt);
  open().write_manifest_to(folder_ / "out", 1.0);
  const std::filesystem::path file = folder_ / "out" / "plan" / "path.json";
  const auto ids = [&] {
    std::vector<std::string> found;
    const Verdict stated = read_path_verdict(file);
    for (const VerdictReason& reason : stated.reasons()) found.push_back(reason.id);
    return found;
  };
  Monitor quiet;
  open().remove_what_is_out_of_date(Stage::Stretch, quiet);
  EXPECT_EQ(ids(), (std::vector<std::string>{"open_layer", "depth"}));
  open("plan: {close_margin_mm: 3}\n").remove_what_is_out_of_date(Stage::Stretch, quiet);
  EXPECT_EQ(ids(), (std::vector<std::string>{"open_layer", "not_simulated"}));
  open().remove_what_is_out_of_date(Stage::Verify, quiet);
  EXPECT_EQ(ids(), (std::vector<std::string>{"open_layer", "not_simulated"}));
}

TEST_F(RunFolderTest, ACaseThatIsChangedAndChangedBackFindsTheVerdictOfItsCut) {
  open().plan(note("plan"), small_ring());
  Verdict verdict;
  verdict.add("depth", 0.5, "too shallow");
  open().verdicts(verdict, std::nullopt);
  open().write_manifest_to(folder_ / "out", 1.0);
  const std::filesystem::path file = folder_ / "out" / "plan" / "path.json";
  const auto planned = [&](const std::string& change, const ToolPath& path) {
    Monitor quiet;
    RunFolder folder = open(change);
    folder.remove_what_is_out_of_date(Stage::Plan, quiet);
    folder.plan(note("plan"), path);
    folder.verdicts(std::nullopt, std::nullopt);
    folder.write_manifest_to(folder_ / "out", 1.0);
    std::vector<std::string> ids;
    const Verdict stated = read_path_verdict(file);
    for (const VerdictReason& reason : stated.reasons()) ids.push_back(reason.id);
    return ids;
  };
  EXPECT_EQ(planned("plan: {close_margin_mm: 3}\n", small_ring()), std::vector<std::string>{"not_simulated"});
  EXPECT_EQ(planned("", small_ring()), std::vector<std::string>{"depth"});
  ToolPath other = small_ring();
  other.waypoints[0].depth_mm += 1.0;
  std::filesystem::remove_all(folder_ / "out" / "plan");
  EXPECT_EQ(planned("", other), std::vector<std::string>{"not_simulated"}) << "a verdict is that of one path";
  std::filesystem::remove_all(folder_ / "out" / "plan");
  EXPECT_EQ(planned("", small_ring()), std::vector<std::string>{"depth"});
  // What is refused without a cut joins the verdict of the cut, and is not kept with it.
  Verdict refused;
  refused.add("cut_face", 1.0, "on a face");
  open().verdicts(refusals_of(refused, "the run ended before it cut along the path"), std::nullopt);
  EXPECT_TRUE(read_path_verdict(file).has("depth"));
  EXPECT_TRUE(read_path_verdict(file).has("cut_face"));
  std::filesystem::remove_all(folder_ / "out" / "plan");
  EXPECT_EQ(planned("", small_ring()), std::vector<std::string>{"depth"});
  // The advice of an assessment that came later goes with a verdict that is found again.
  std::filesystem::remove_all(folder_ / "out" / "plan");
  RunFolder advised = open();
  advised.plan(note("plan"), small_ring());
  std::filesystem::create_directories(folder_ / "out" / "assessment");
  std::ofstream(folder_ / "out" / "assessment" / "assess.json")
      << R"({"advice": "do_not_use", "reasons": ["far off"]})";
  advised.verdicts(std::nullopt, std::nullopt);
  EXPECT_TRUE(read_path_verdict(file).has("depth"));
  EXPECT_TRUE(read_path_verdict(file).has("eligibility"));
}

TEST_F(RunFolderTest, ARunThatOnlySimulatesLeavesTheVerdictOfTheCorrection) {
  const ToolPath ring = small_ring();
  open().plan(note("plan"), ring);
  open().correction(note("correction"), small_correction(ring));
  Verdict planned, corrected;
  planned.add("depth", 0.5, "too shallow");
  corrected.add("heat", -0.5, "warm");
  open().verdicts(planned, corrected);
  open().write_manifest_to(folder_ / "out", 1.0);
  Monitor quiet;
  RunFolder again = open();
  again.remove_what_is_out_of_date(Stage::Simulate, quiet);
  again.verdicts(planned, std::nullopt);
  EXPECT_TRUE(read_path_verdict(folder_ / "out" / "correction" / "path.json").has("heat"));
  EXPECT_FALSE(read_path_verdict(folder_ / "out" / "correction" / "path.json").has("not_simulated"));
}

TEST_F(RunFolderTest, ACorrectionIsWrittenPassByPass) {
  open().correction(note("correction"), small_correction(small_ring()));
  const std::filesystem::path folder = folder_ / "out" / "correction";
  EXPECT_EQ(read_text(folder / "history.csv"),
            "pass,waypoint,offset_mm,error_mm,limited,interpolated\n0,0,0,-1,0,0\n0,1,0,-0.5,0,1\n1,0,1,,1,1\n1,1,0.5,,"
            "0,1\n");
  EXPECT_EQ(read_text(folder / "errors.csv"), "pass,along_mm,signed_error_mm\n0,0.5,-1.25\n0,9,-0.5\n");
}

TEST_F(RunFolderTest, EachStepOfACutHasALineWithForceAndTorque) {
  open().cut(note("as_planned"), model(), stretched(), small_cut());
  std::ifstream in(folder_ / "out" / "as_planned" / "steps.csv");
  std::string header;
  std::string line;
  std::getline(in, header);
  std::getline(in, line);
  EXPECT_EQ(header,
            "time_s,iterations,tets_in_contact,removed,slipped,tool_force_x_mn,tool_force_y_mn,tool_force_z_mn,"
            "tool_torque_x_mn_mm,tool_torque_y_mn_mm,tool_torque_z_mn_mm");
  EXPECT_EQ(line, "0.5,3,20,2,4,1,2,3,10,20,25");
}

TEST_F(RunFolderTest, AStretchThatWasNotMeasuredSaysSo) {
  open().stretched(note("stretched"), model(), stretched());
  const std::string json = read_text(folder_ / "out" / "stretched" / "deform.json");
  EXPECT_NE(json.find("\"relative_residual\": null"), std::string::npos) << json;
}

TEST_F(RunFolderTest, TheSchemaOfAPathNamesEveryFieldThatIsWritten) {
  const auto schema = nlohmann::json::parse(path_schema_json());
  ToolPath path = small_ring();
  path.T_robot_sim = Mat4::Identity();
  path.tumor_edge.is_closed = false;
  path.source_sha256 = sha256_of_text("");
  path.specimen_id = "tongue-07";
  path.is_virtual = true;
  write_tool_path(folder_ / "path.json", path, Verdict{});
  const auto written = nlohmann::json::parse(read_text(folder_ / "path.json"));
  const auto keys_of = [](const nlohmann::json& object) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : object.items()) keys.push_back(key);
    return keys;
  };
  EXPECT_EQ(keys_of(written), keys_of(schema["properties"]));
  EXPECT_EQ(keys_of(written["waypoints"][0]), keys_of(schema["properties"]["waypoints"]["items"]["properties"]));
  EXPECT_EQ(written["schema"], schema["properties"]["schema"]["const"]);
  const std::vector<std::string> of_verdict = keys_of(written["verdict"]);
  EXPECT_THAT(schema["properties"]["verdict"]["required"].get<std::vector<std::string>>(),
              ::testing::UnorderedElementsAreArray(of_verdict));
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

TEST_F(RunFolderTest, EveryProductHasAManifestWithSettingsInputsSeedAndThreads) {
  open("plan: {depth_mm: 4}\n").plan(note("plan"), small_ring());
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

TEST_F(RunFolderTest, AnOutputThatIsAFileIsRefused) {
  std::ofstream(folder_ / "occupied") << "a file";
  EXPECT_THROW(RunFolder(read(), folder_ / "occupied", {}), DataError);
  EXPECT_THROW(RunFolder(read(), folder_ / "occupied" / "below", {}), DataError);
}

}  // namespace
}  // namespace incise
