#include "support/block_inputs.hpp"
#include "support/counted_entries.hpp"
#include "support/monitors.hpp"
#include "support/portable_kernels.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/core/memory.hpp>
#include <incise/core/units.hpp>
#include <incise/workflow/correction.hpp>
#include <incise/workflow/study.hpp>

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <string>

namespace incise {
namespace {

using testing::coarse_case;
using ::testing::Contains;
using ::testing::HasSubstr;

/// A block of tissue, a round tumour edge on it, and what a run keeps of it.
class Block : public testing::BlockInputs {
 public:
  testing::Entries kept;
  Cache cache{std::make_unique<testing::CountedEntries>(kept)};
};

/// Runs of the block with one cache.
class RunStudy : public ::testing::Test {
 protected:
  Study run(const Case& settings, const RunOptions& options = {}) {
    Workers workers(2);
    return run_study(settings, block_, block_.cache, options, workers, silent_);
  }

  /// Which stages of a run of the changed case are computed again.
  std::string computed_again(Stage until, const std::function<void(Case&)>& change) {
    Case settings = coarse_case();
    change(settings);
    std::string again;
    for (const StageReport& stage : run(settings, {.until = until}).stages) {
      if (stage.state == StageState::Computed) again += std::string(to_string(stage.stage)) + " ";
    }
    return again;
  }

  Block block_;
  Monitor silent_;
};

TEST_F(RunStudy, OnePassOfTheCorrectionLowersTheErrorByMoreThanHalf) {
  Workers workers(2);
  testing::RecordingMonitor monitor;
  Case settings = coarse_case();
  settings.plan.power_w = 90.0;
  settings.cut.power_exponent = 0.0;  // power does nothing but heat
  settings.compensation.method = CompensationMethod::Paper;
  const Study study = run_study(settings, block_, block_.cache, {}, workers, monitor);
  EXPECT_THAT(monitor.warnings, Contains(HasSubstr("the mesh is coarse for a tool of 1.6 mm")));
  for (const char* cut : {"the cut as planned: caution: heat: heat reaches", "the corrected cut: caution: heat: heat reaches"}) {
    EXPECT_THAT(monitor.warnings, Contains(HasSubstr(cut)));
  }
  ASSERT_TRUE(study.as_planned && study.corrected);
  EXPECT_EQ(study.as_planned->outcome, Outcome::Success);
  EXPECT_EQ(study.corrected->outcome, Outcome::Success);
  const double before = study.as_planned->centerline.abs_error_mm->mean;
  const double after = study.corrected->centerline.abs_error_mm->mean;
  EXPECT_GT(before, 0.3) << "nothing to correct";
  EXPECT_LT(after, 0.5 * before);
}

TEST_F(RunStudy, TheDefaultMethodCutsAtMostFourTimesAndEndsWithOneOfThoseCuts) {
  const testing::PortableKernels portable;
  const Study study = run(coarse_case());
  ASSERT_TRUE(study.corrected && study.correction && study.correction->iteration);
  const ConvergedCompensation& done = *study.correction->iteration;
  EXPECT_LE(done.passes.size(), 4U);
  // The cuts on the way are let go; the one that the correction ended with is kept.
  EXPECT_TRUE(block_.kept.bytes.contains("as_planned") && block_.kept.bytes.contains("corrected"));
  EXPECT_FALSE(block_.kept.bytes.contains("pass_1") || block_.kept.bytes.contains("pass_2"));
  EXPECT_NEAR(*done.result().mean_abs_error_mm, study.corrected->centerline.abs_error_mm->mean, 1e-12);
  EXPECT_LT(study.corrected->centerline.abs_error_mm->mean, 0.5 * study.as_planned->centerline.abs_error_mm->mean);
  ASSERT_TRUE(study.correction->floor_mm);
  EXPECT_LT(*study.correction->floor_mm, study.corrected->centerline.abs_error_mm->mean + 0.05);

  // A second run makes none of it again.
  const int saved = block_.kept.saved;
  const Study again = run(coarse_case());
  EXPECT_EQ(again.stages.back().state, StageState::Reused);
  EXPECT_EQ(block_.kept.saved, saved);
  EXPECT_EQ(bytes_of(again.corrected->incision), bytes_of(study.corrected->incision))
      << "what is loaded equals what was computed";
  EXPECT_EQ(bytes_of(*again.correction), bytes_of(*study.correction));
  EXPECT_EQ(bytes_of(*again.stretched), bytes_of(*study.stretched));
  EXPECT_EQ(bytes_of(*again.plan), bytes_of(*study.plan));
  EXPECT_EQ(bytes_of(again.verdict), bytes_of(study.verdict));
  EXPECT_EQ(again.is_accepted, study.is_accepted);
}

TEST_F(RunStudy, ACutByPointsThatSplitsTetsIsLoadedAsItWasComputed) {
  Case settings = coarse_case();
  settings.frames = 3;
  settings.cut.rule = CutRule::Lattice;
  settings.cut.dullness = 4.0;
  const Study study = run(settings, {.until = Stage::Simulate});
  ASSERT_FALSE(study.as_planned->incision.final_state.splits.vertices.empty());
  EXPECT_TRUE(study.as_planned->incision.inner_edge.has_value());
  const Study again = run(settings, {.until = Stage::Simulate});
  EXPECT_EQ(again.stages.back().state, StageState::Reused);
  EXPECT_EQ(bytes_of(again.as_planned->incision), bytes_of(study.as_planned->incision));
}

TEST(PathErrors, AnInnerEdgeThatIsOpenNearTheSkinIsToldFromADeeperLayer) {
  Contour edge, middle;
  for (int i = 0; i < 120; ++i) {
    const double angle = 2.0 * units::kPi * i / 120.0;
    const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
    edge.points.push_back(10.0 * out);
    middle.points.push_back(15.3 * out - 1.0 * Vec3::UnitZ());
  }
  Case settings;
  settings.compensation.observable = ContourKind::InnerEdge;
  SimulatedCut cut;
  cut.incision.is_closed_loop = false;
  cut.incision.kerf.layers = {
      {.depth_mm = 1.0, .is_within_plan = true, .is_closed = true, .width_mm = 2.4, .centerline = middle}};
  Monitor silent;
  const auto errors = path_errors(settings, cut, edge, silent);
  ASSERT_TRUE(errors.has_value());
  EXPECT_FALSE(errors->is_success);
  // 0.3 mm outside as a mid-line; the edge lies 1.2 mm nearer, where a needle's would lie 0.5 mm nearer.
  for (const double error : errors->signed_error_mm) EXPECT_NEAR(error, 0.3 - 1.2 + 0.5, 0.02);
  settings.compensation.observable = ContourKind::Centerline;
  const auto of_middle = path_errors(settings, cut, edge, silent);
  ASSERT_TRUE(of_middle.has_value());
  for (const double error : of_middle->signed_error_mm) EXPECT_NEAR(error, 0.3, 0.02);
}

TEST(IsAccepted, NotWhatBuysTheLateralErrorWithDepthOrClosure) {
  Case settings;
  const auto cut_with = [](double mean_error_mm, double least_depth_mm, bool is_deep_layer_closed) {
    SimulatedCut cut{.outcome = Outcome::Success};
    cut.centerline.abs_error_mm = Summary{.mean = mean_error_mm};
    cut.incision.is_closed_loop = true;
    cut.incision.kerf.layers = {{.depth_mm = 4.0, .is_within_plan = true, .is_closed = is_deep_layer_closed}};
    cut.incision.kerf.depth.profile.depth_mm = {5.3, least_depth_mm, 5.1};
    cut.incision.kerf.depth.planned_at_mm = {5.0, 5.0, 5.0};
    return cut;
  };
  Correction paper{.method = CompensationMethod::Paper};
  EXPECT_EQ(objection_to(settings, paper, cut_with(1.9, 5.0, true), cut_with(0.3, 4.6, true)), "")
      << "shallower, and deep enough";
  EXPECT_THAT(objection_to(settings, paper, cut_with(1.9, 3.6, true), cut_with(0.3, 2.6, true)),
              HasSubstr("at its shallowest it reaches 52 % of the planned depth, the cut before 72 %"))
      << "as in the head CT";
  EXPECT_EQ(objection_to(settings, paper, cut_with(1.9, 2.6, true), cut_with(0.3, 3.6, true)), "");
  EXPECT_THAT(objection_to(settings, paper, cut_with(1.9, 5.0, true), cut_with(0.3, 5.0, false)),
              HasSubstr("1 of the measured layers (4 mm deep); the cut before left 0"));
  EXPECT_EQ(objection_to(settings, paper, cut_with(1.9, 5.0, false), cut_with(0.3, 5.0, false)), "")
      << "no worse; the verdict refuses both";
}

/// Of a mid-line with this mean |error|, mm.
SimulatedCut cut_with(double mean_error_mm) {
  SimulatedCut cut{.outcome = Outcome::Success};
  cut.centerline.abs_error_mm = Summary{.mean = mean_error_mm};
  return cut;
}

TEST(IsAccepted, ByThePapersRule) {
  Case settings;  // a needle of 1 mm: radius 0.5
  Correction paper{.method = CompensationMethod::Paper};
  EXPECT_EQ(objection_to(settings, paper, cut_with(1.99), cut_with(0.33)), "");
  EXPECT_THAT(objection_to(settings, paper, cut_with(1.99), cut_with(0.63)),
              HasSubstr("0.63 mm, but must be below the electrode's radius, 0.50 mm"))
      << "the paper's own case that is not";
  EXPECT_THAT(objection_to(settings, paper, cut_with(0.3), cut_with(0.4)), HasSubstr("0.40 mm, not below the 0.30 mm"))
      << "worse than before";
  SimulatedCut open = cut_with(0.1);
  open.outcome = Outcome::OpenLoop;
  EXPECT_THAT(objection_to(settings, paper, cut_with(1.0), open), HasSubstr("its ring does not close"));
}

TEST(IncisionSettings, HaveTheEnergyPerAreaThatThePathIsCutWith) {
  Case settings;
  ToolPath path{.waypoints = {{.depth_mm = 5.0, .speed_mm_s = 7.0}, {.depth_mm = 5.0, .speed_mm_s = 7.0}}};
  EXPECT_EQ(incision_settings(settings, path).cut.relative_energy(), 1.0);
  for (Waypoint& waypoint : path.waypoints) waypoint.speed_mm_s = 3.5;
  EXPECT_EQ(incision_settings(settings, path).cut.relative_energy(), 2.0);
  path.waypoints[1].depth_mm = 15.0;  // 10 mm in the mean
  EXPECT_EQ(incision_settings(settings, path).cut.relative_energy(), 1.0);
  settings.plan.power_w = 70.0;
  EXPECT_EQ(incision_settings(settings, path).cut.relative_energy(), 2.0);
}

TEST(IncisionSettings, OfViscousTissueHaveThePaceOfTheRealToolAndTheTimeSinceTheStretch) {
  Case settings;
  settings.time_since_stretch_s = 90.0;
  ToolPath path{.waypoints = {{.depth_mm = 5.0, .speed_mm_s = 4.0}, {.depth_mm = 5.0, .speed_mm_s = 8.0}}};
  EXPECT_FALSE(incision_settings_for(settings, path, {}).time_since_stretch_s);
  settings.material.kelvin_voigt_time_s = 0.1;
  EXPECT_EQ(incision_settings_for(settings, path, {}).cut.real_speed_mm_s, 6.0);
  EXPECT_EQ(incision_settings_for(settings, path, {}).cut.depth_mm, 5.0);
  EXPECT_EQ(incision_settings_for(settings, path, {}).time_since_stretch_s, 90.0);
}

TEST_F(RunStudy, ASecondRunTakesEveryProductFromTheCache) {
  run(coarse_case(), {.until = Stage::Plan});
  const Study again = run(coarse_case(), {.until = Stage::Plan});
  ASSERT_EQ(again.stages.size(), 4U);
  EXPECT_EQ(again.stages[0].state, StageState::Skipped);
  EXPECT_EQ(again.stages[1].state, StageState::Skipped);
  EXPECT_EQ(again.stages[2].state, StageState::Reused);
  EXPECT_EQ(again.stages[3].state, StageState::Reused);
}

TEST_F(RunStudy, AStageIsComputedAgainForWhatItReadsAndForNothingElse) {
  EXPECT_EQ(computed_again(Stage::Simulate, [](Case&) {}), "stretch plan simulate ");
  EXPECT_EQ(computed_again(Stage::Simulate,
                           [](Case& c) {
                             c.title = "Another name";
                             c.thermal.absorbed_fraction = 0.5;  // a cut is judged anew, not made anew
                             c.close_margin_mm = 1.5;
                             c.compensation.method = CompensationMethod::Paper;
                             c.meshing.fine_mm = 0.5;  // the mesh is given
                           }),
            "");
  EXPECT_EQ(computed_again(Stage::Plan, [](Case& c) { c.plan.power_w = 30.0; }), "");
  EXPECT_EQ(computed_again(Stage::Simulate, [](Case& c) { c.plan.power_w = 30.0; }), "simulate ");
  EXPECT_EQ(computed_again(Stage::Plan, [](Case& c) { c.plan.depth_mm = 4.0; }), "plan ");
  EXPECT_EQ(computed_again(Stage::Plan, [](Case& c) { c.cut.dullness = 4.0; }), "plan ")
      << "the plan of 4 mm took its place";
  EXPECT_EQ(computed_again(Stage::Plan, [](Case& c) { c.material.youngs_modulus_kpa = 60.0; }), "stretch plan ");
}

TEST_F(RunStudy, ThatHasToGoOnRefusesWhereNothingWasInterrupted) {
  EXPECT_THROW(run(coarse_case(), {.must_resume = true}), CaseError);
  EXPECT_TRUE(block_.kept.bytes.empty()) << "nothing was computed";
}

TEST_F(RunStudy, StopsAfterTheStageThatWasAskedFor) {
  const Study study = run(coarse_case(), {.until = Stage::Stretch});
  EXPECT_TRUE(study.stretched.has_value());
  EXPECT_FALSE(study.plan.has_value());
  EXPECT_NEAR(study.stretched->max_displacement_mm, 5.0, 0.5);
}

/// Photographs of cuts along the planned path, all 0.8 mm too near.
Case case_by_photographs() {
  Case settings = coarse_case();
  settings.compensation.method = CompensationMethod::Profile;
  settings.compensation.photographed_mm = {-0.8};
  return settings;
}

/// What counts towards RLIMIT_DATA already: libraries reserve buffers at start.
rlim_t data_bytes_in_use() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (rlim_t kilobytes = 0; word == "VmData:" && status >> kilobytes) return 1024 * kilobytes;
  }
  return 0;
}

TEST_F(RunStudy, AMeshThatNeedsMoreMemoryThanThereIsIsRefusedBeforeItIsStretched) {
  rlimit old{};
  ASSERT_EQ(getrlimit(RLIMIT_DATA, &old), 0);
  ASSERT_TRUE(available_memory_bytes().has_value());
  Case settings = coarse_case();
  settings.frames = 500;  // 125 MB of them, beside some 45 MB
  Workers workers(1);
  rlimit tight = old;
  tight.rlim_cur = data_bytes_in_use() + 100'000'000;
  ASSERT_EQ(setrlimit(RLIMIT_DATA, &tight), 0);
  const std::string said = testing::refusal_of<DataError>(
      [&] { return run_study(settings, block_, block_.cache, {.until = Stage::Stretch}, workers, silent_); });
  ASSERT_EQ(setrlimit(RLIMIT_DATA, &old), 0);
  EXPECT_NE(said.find("this machine: memory: found "), std::string::npos) << said;
  EXPECT_NE(said.find("MB for 42840 tets"), std::string::npos) << said;
  EXPECT_TRUE(block_.kept.bytes.empty());
}

TEST_F(RunStudy, ACutByPointsThatNeedsMoreMemoryThanThereIsIsRefusedBeforeTheStretch) {
  rlimit old{};
  ASSERT_EQ(getrlimit(RLIMIT_DATA, &old), 0);
  Case settings = coarse_case();
  settings.cut.rule = CutRule::Lattice;
  Workers workers(1);
  const auto said_until = [&](Stage until, const Case& of_case) {
    rlimit tight = old;
    tight.rlim_cur = data_bytes_in_use() + 150'000'000;  // for the stretch, not for the points besides
    EXPECT_EQ(setrlimit(RLIMIT_DATA, &tight), 0);
    std::string said;
    try {
      static_cast<void>(run_study(of_case, block_, block_.cache, {.until = until}, workers, silent_));
    } catch (const DataError& error) {
      said = error.what();
    }
    EXPECT_EQ(setrlimit(RLIMIT_DATA, &old), 0);
    return said;
  };
  EXPECT_THAT(said_until(Stage::Simulate, settings), HasSubstr("this machine: memory: found "));
  EXPECT_TRUE(block_.kept.bytes.empty()) << "nothing was stretched";
  EXPECT_EQ(said_until(Stage::Stretch, settings), "");
  Case by_photographs = case_by_photographs();
  by_photographs.cut.rule = CutRule::Lattice;
  EXPECT_EQ(said_until(Stage::Compensate, by_photographs), "") << "no cut is simulated";
}

TEST(DefaultConstraints, ClampTheBackPullTheTipAndSupportTheUnderside) {
  const TetMesh tongue = make_block({50, 100, 30}, {5, 10, 3});
  const std::vector<Constraint> constraints = default_constraints(tongue);
  ASSERT_EQ(constraints.size(), 3U);
  EXPECT_EQ(std::get<DisplacedConstraint>(constraints[1]).displacement_mm, Vec3(0.0, -20.0, 0.0));
  EXPECT_EQ(std::get<SupportConstraint>(constraints[2]).point_mm.z(), 0.0);
}

TEST(DefaultConstraints, AreRefusedForABodyThatTheirLengthsWereNotMadeFor) {
  const TetMesh small = make_block({6, 9, 5}, {3, 4, 2});
  EXPECT_THAT(
      [&] { static_cast<void>(default_constraints(small)); },
      ::testing::ThrowsMessage<CaseError>(::testing::AllOf(HasSubstr("specimen.constraints"), HasSubstr("9 mm long"))));
}

TEST_F(RunStudy, ByAProfileMovesThePathWithoutAnySimulatedCutUntilItIsVerified) {
  Case settings = case_by_photographs();
  const Study moved = run(settings, {.until = Stage::Compensate});
  EXPECT_FALSE(moved.as_planned);
  ASSERT_TRUE(moved.correction && moved.plan);
  EXPECT_EQ(moved.correction->method, CompensationMethod::Profile);
  ASSERT_EQ(moved.correction->moves.move_mm.size(), moved.plan->waypoints.size());
  for (const double move : moved.correction->moves.move_mm) EXPECT_NEAR(move, 0.8, 1e-6);
  ASSERT_EQ(moved.stages.size(), 6U);
  EXPECT_EQ(moved.stages[4].stage, Stage::Simulate);
  EXPECT_EQ(moved.stages[4].state, StageState::Skipped);

  const Study verified = run(settings);
  ASSERT_TRUE(verified.as_planned && verified.corrected);
  EXPECT_EQ(verified.correction->moves.move_mm, moved.correction->moves.move_mm) << "the same product";
}

TEST_F(RunStudy, JudgesEveryCutByWhatIsExpectedAlongThePlannedPath) {
  const testing::PortableKernels portable;  // one tooth of these coarse tets more or less moves the least margin
  Case settings = case_by_photographs();
  settings.close_margin_mm = 4.9;  // so that every cut is too near, and the verdict says how near
  const Study study = run(settings);
  ASSERT_TRUE(study.as_planned && study.corrected);
  const auto left_mm = [](const SimulatedCut& cut) {
    for (const VerdictReason& reason : cut.verdict.reasons())
      if (reason.id == "lateral_margin") return *reason.value;
    return std::numeric_limits<double>::quiet_NaN();
  };
  EXPECT_NEAR(left_mm(*study.as_planned), 5.0 - 0.8 - 0.8, 0.7) << "margin, radius, as photographed; tets of 1.5 mm";
  EXPECT_GT(left_mm(*study.corrected), left_mm(*study.as_planned) + 0.4)
      << "the path moved out by 0.8 mm, and its cut with it";
}

class Correct : public RunStudy {};

TEST_F(Correct, AddsTheProfileToTheBiasWaypointByWaypoint) {
  Case settings = coarse_case();
  settings.compensation.bias_mm = 0.3;
  const Study by_bias = run(settings);
  settings.compensation.bias_mm = 0.1;
  settings.compensation.residual_mm = {0.2};
  const Study by_both = run(settings);
  ASSERT_TRUE(by_bias.correction && by_both.correction);
  const std::vector<double>&one = by_bias.correction->moves.move_mm, &other = by_both.correction->moves.move_mm;
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(one[i], other[i], 1e-9) << i;
}

TEST(Validate, RefusesAChoiceOfCorrectionThatWouldNotAct) {
  const auto path_of = [](const CompensationChoice& choice) {
    const std::vector<Problem> problems = validate(choice);
    return problems.empty() ? std::string() : problems.front().path;
  };
  EXPECT_EQ(path_of({}), "");
  EXPECT_EQ(path_of({.bias_mm = 0.2, .simulated_share = 0.5, .residual_mm = {0.1, 0.2}}), "");
  EXPECT_EQ(path_of({.method = CompensationMethod::Profile, .photographed_mm = {0.1}}), "");
  EXPECT_EQ(path_of({.method = CompensationMethod::Profile}), "photographed_mm");
  EXPECT_EQ(path_of({.photographed_mm = {0.1}}), "photographed_mm") << "the default method has its own list";
  EXPECT_EQ(path_of({.method = CompensationMethod::Profile, .bias_mm = 0.2, .photographed_mm = {0.1}}), "bias_mm");
  for (const CompensationMethod method : {CompensationMethod::Paper, CompensationMethod::Profile}) {
    CompensationChoice choice{.method = method};
    if (method == CompensationMethod::Profile) choice.photographed_mm = {0.1};
    choice.simulated_share = 0.5;
    EXPECT_EQ(path_of(choice), "simulated_share");
    choice.residual_mm = {0.1};
    EXPECT_EQ(path_of(choice), "residual_mm");
  }
  EXPECT_EQ(path_of({.residual_mm = std::vector<double>(361, 0.0)}), "residual_mm");
}

TEST(ObjectionTo, APathByPhotographsIsNotHeldToTheSimulatedError) {
  Correction correction{.method = CompensationMethod::Profile};
  EXPECT_EQ(objection_to({}, correction, cut_with(0.5), cut_with(1.1)), "") << "photographs say more than is simulated";
  SimulatedCut open = cut_with(0.1);
  open.outcome = Outcome::OpenLoop;
  EXPECT_THAT(objection_to({}, correction, cut_with(0.5), open), HasSubstr("its ring does not close"));
}

}  // namespace
}  // namespace incise
