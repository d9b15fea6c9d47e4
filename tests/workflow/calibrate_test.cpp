#include "support/contour_shapes.hpp"
#include "support/counted_entries.hpp"
#include "support/portable_kernels.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/workflow/calibrate.hpp>
#include <incise/workflow/study.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

namespace incise {
namespace {

using ::testing::HasSubstr;

constexpr double kTumorRadiusMm = 4.0;

/// A soft block that is held at its underside, with a tumour edge that is no circle on top of it.
class SoftBlock : public Inputs {
 public:
  explicit SoftBlock(double phase) : phase_(phase) {}
  std::optional<ToolPath> read_given_path() override { return own_path; }
  std::optional<ToolPath> own_path;
  CtVolume read_ct(Monitor&) override { throw std::logic_error("this specimen comes as a mesh"); }
  std::optional<TetMesh> read_specimen_mesh(Monitor&) override { return make_block({32, 32, 6}, {24, 24, 4}); }
  std::optional<Contour> read_tumor_edge() override {
    const auto radius = [this](double a) {
      return kTumorRadiusMm * (1.0 + 0.12 * std::cos(2.0 * a + phase_) + 0.05 * std::sin(3.0 * a));
    };
    return testing::polar_ring(radius, 72, Vec3(16, 16, 6));
  }

 private:
  double phase_;
};

Case block_case() {
  Case settings;
  settings.gravity_mm_s2 = Vec3::Zero();
  settings.material.youngs_modulus_kpa = 20.0;
  settings.material.poissons_ratio = 0.4;
  settings.constraints = std::vector<Constraint>{
      FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(33, 33, 0.1))}},
      DisplacedConstraint{BoxRegion{Box3(Vec3(-1, 31.9, 0.2), Vec3(33, 33, 7))}, Vec3(0.0, 0.2, 0.0)}};
  settings.plan.depth_mm = 3.0;
  settings.cut.reference_depth_mm =
      settings.plan.depth_mm;  // so that the pairs of the grid do here what they do in the paper
  settings.tool = Needle{.diameter_mm = 1.6};
  settings.cut.reach_mm = 0.4;
  settings.cut.advance_per_step_mm = 0.8;
  settings.frames = 0;
  return settings;
}

/// Held at two ends and free to slide, as a tongue is, and soft: it follows the tool as a whole.
Case sliding_case() {
  Case settings = block_case();
  settings.material.youngs_modulus_kpa = 2.0;
  settings.constraints = std::vector<Constraint>{
      FixedConstraint{EndRegion{Vec3::UnitY(), 2.0}},
      DisplacedConstraint{EndRegion{-Vec3::UnitY(), 2.0}, Vec3(0.0, -2.0, 0.0)},
      FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(33, 33, 0.1))}, {false, false, true}}};
  return settings;
}

/// Any ring will do where the photograph is not looked at.
PhotographedCut plain_photograph(const Contour& edge) {
  PhotographedCut photograph;
  photograph.name = "plain";
  photograph.tumor_edge = edge;
  for (const Vec3& p : edge.points) {
    const Vec3 out = p - Vec3(16.0, 16.0, 6.0);
    photograph.incision.points.push_back(p + 3.0 * out.normalized());
  }
  return photograph;
}

class CalibrateBlocks : public ::testing::Test {
 protected:
  CalibrateBlocks() {
    for (SoftBlock* block : {&first_, &second_}) {
      CalibrationSubject subject;
      subject.photographed = plain_photograph(*block->read_tumor_edge());
      subject.photograph_file = "cut.json";
      subject.case_file = "case.yaml";
      subject.settings = block_case();
      subject.inputs = block;
      subject.cache = block == &first_ ? &first_cache_ : &second_cache_;
      subjects_.push_back(std::move(subject));
    }
  }

  Calibration run(const CalibrationRequest& request) {
    Workers workers(2);
    return calibrate(subjects_, request, runs_, workers, silent_);
  }

  static CalibrationRequest grid(std::vector<double> speeds, std::vector<double> dullnesses) {
    CalibrationRequest request;
    request.method = CalibrationMethod::Paper;
    request.speeds_mm_s = std::move(speeds);
    request.dullnesses = std::move(dullnesses);
    return request;
  }

  /// Keeps the specimen's runs of that drag length as `change` leaves them.
  template <class Change>
  void change_kept(const Calibration& made, std::size_t specimen, double drag_mm, const Change& change) {
    for (CalibrationRun run : made.specimens[specimen].runs) {
      if (std::abs(run.drag_length_mm() - drag_mm) > 1e-9) continue;
      change(run);
      const CacheKey key = calibration_run_key(made.specimens[specimen].held, run.setting);
      runs_.keep(slot_of(key), key, run);
    }
  }

  SoftBlock first_{0.0};
  Cache first_cache_, second_cache_;
  SoftBlock second_{1.3};
  std::vector<CalibrationSubject> subjects_;
  testing::Entries kept_;
  Cache runs_{std::make_unique<testing::CountedEntries>(kept_)};
  Monitor silent_;
};

TEST_F(CalibrateBlocks, TableOneHasThePapersPattern) {
  subjects_.pop_back();
  subjects_[0].settings = sliding_case();
  const CalibrationRequest paper{.method = CalibrationMethod::Paper};
  std::vector<ScoreRow> rows = run(paper).table.rows;
  ASSERT_EQ(rows.size(), 25U);
  // At 1 mm/s nothing depends on dullness: what it does is hidden in the mesh's grain.
  for (std::size_t d = 1; d < 5; ++d) {
    EXPECT_NEAR(rows[d].mean_signed_mm.value(), rows[0].mean_signed_mm.value(), 0.1);
  }
  // A best score near 100 % lies inside the grid.
  const double best = rows[run(paper).table.chosen.value()].percent;
  EXPECT_GT(best, 85.0);
  EXPECT_LT(best, 115.0);
  // The error grows inwards with speed x dullness, up to the first that fail; these are the fastest and dullest.
  const auto product = [](const ScoreRow& row) { return row.setting.speed_mm_s * row.setting.dullness; };
  std::stable_sort(rows.begin(), rows.end(),
                   [&](const ScoreRow& a, const ScoreRow& b) { return product(a) < product(b); });
  EXPECT_TRUE(rows.back().is_failure);
  EXPECT_EQ(rows.back().percent, 0.0);
  std::map<double, std::vector<double>> errors;  // by product: 9 x 13 and 13 x 9 are one place on the way, twice
  for (const ScoreRow& row : rows) {
    EXPECT_FALSE(row.is_failure && product(row) <= 153.0) << row.setting.speed_mm_s << " x " << row.setting.dullness;
    if (!row.is_failure) errors[product(row)].push_back(row.mean_signed_mm.value());
  }
  double before = 0.1;
  for (const auto& [of_product, found] : errors) {
    const auto [least, most] = std::minmax_element(found.begin(), found.end());
    EXPECT_LT(*most - *least, 0.2) << of_product << ": only the coarse mesh's grain tells them apart";
    const double mean = std::accumulate(found.begin(), found.end(), 0.0) / static_cast<double>(found.size());
    EXPECT_LT(mean, before + 0.1) << of_product;
    before = mean;
  }
  EXPECT_LT(before, -1.5);
}

TEST_F(CalibrateBlocks, AnInterruptedCalibrationGoesOnToTheSameNumbersAndMakesNoRunTwice) {
  const CalibrationRequest request = grid({13.0}, {1.0, 7.0});
  const Calibration straight = run(request);
  ASSERT_EQ(kept_.saved, 4);

  /// Asks to stop once a good third is done.
  class StopAtAThird : public Monitor {
   public:
    void progress(std::string_view stage, double fraction) override {
      if (stage == "cutting" && fraction > 0.35) is_stopped_ = true;
    }
    [[nodiscard]] bool is_cancelled() const override { return is_stopped_; }

   private:
    std::atomic<bool> is_stopped_ = false;
  } stop;
  kept_ = {};
  Workers alone(1);
  EXPECT_THAT([&] { static_cast<void>(calibrate(subjects_, request, runs_, alone, stop)); },
              ::testing::ThrowsMessage<Cancelled>(HasSubstr("of 4 simulations to go")));
  EXPECT_GT(kept_.saved, 0);
  EXPECT_LT(kept_.saved, 4);
  const Calibration resumed = run(request);
  EXPECT_EQ(kept_.saved, 4);
  for (std::size_t s = 0; s < 2; ++s) {
    for (std::size_t i = 0; i < 2; ++i) {
      const CalibrationRun& one = straight.specimens[s].runs[i];
      const CalibrationRun& other = resumed.specimens[s].runs[i];
      EXPECT_EQ(one.inner_edge->points, other.inner_edge->points);
      EXPECT_EQ(one.paper_abs_error_mm->mean, other.paper_abs_error_mm->mean);
    }
  }
  EXPECT_EQ(straight.score_percent, resumed.score_percent);
}

TEST_F(CalibrateBlocks, PhotographsThatAreSwappedOrOfAnotherSpecimenAreNoticed) {
  const CalibrationRequest request = grid({13.0}, {1.0});
  const Calibration made = run(request);
  for (std::size_t s = 0; s < 2; ++s) {
    subjects_[s].photographed.tumor_edge = made.specimens[s].runs[0].final_tumor_edge;
    subjects_[s].photographed.incision = *made.specimens[s].runs[0].inner_edge;
    subjects_[s].case_file = fmt::format("case_{}.yaml", s + 1);
  }
  EXPECT_EQ(run(request).verdict.status(), VerdictStatus::Ok);

  std::swap(subjects_[0].photographed, subjects_[1].photographed);
  EXPECT_THAT([&] { static_cast<void>(run(request)); },
              ::testing::ThrowsMessage<DataError>(HasSubstr("fits the case case_2.yaml")));

  // Of two photographs of the second specimen one is wrong, and the case that it belongs to is not there.
  subjects_.pop_back();
  const Calibration doubtful = run(request);
  EXPECT_EQ(doubtful.verdict.status(), VerdictStatus::Caution);
  EXPECT_TRUE(doubtful.verdict.has("photo_specimen"));
}

TEST_F(CalibrateBlocks, TheFitFindsTheDragLengthAndTheStiffnessIsThatOfTheForce) {
  subjects_.pop_back();
  // The photograph: the same block, twice as stiff, cut at a drag length between those that the fit simulates, and 0.2
  // mm farther out all round, with errors that go slowly round the ring.
  const double true_drag_mm = 2.2;
  Case truth = subjects_[0].settings;
  truth.material.youngs_modulus_kpa *= 2.0;
  std::swap(truth, subjects_[0].settings);
  const Calibration made = run(grid({13.0}, {true_drag_mm / (13.0 * 0.02)}));
  std::swap(truth, subjects_[0].settings);
  const CalibrationRun& cut = made.specimens[0].runs[0];
  PhotographedCut& photograph = subjects_[0].photographed;
  photograph.tumor_edge = cut.final_tumor_edge;
  photograph.incision = *cut.inner_edge;
  for (Vec3& p : photograph.incision.points) {
    const Vec3 out = (p - Vec3(16.0, 16.0, 6.0)).normalized();
    const double turn = std::atan2(out.y(), out.x());
    p += (0.2 + 0.1 * std::sin(5.0 * turn) + 0.07 * std::cos(7.0 * turn)) * out;
  }
  photograph.stretch_force_n = made.specimens[0].simulated_force_n;
  kept_ = {};

  const Calibration fit = run({});
  EXPECT_LE(fit.simulations, 9U);
  EXPECT_NEAR(fit.specimens[0].youngs_modulus_kpa, 40.0, 0.4);
  EXPECT_NEAR(fit.specimens[0].picture.turn_deg, 0.0, 2.0);
  ASSERT_TRUE(fit.fit);
  const ParameterEstimate& drag = fit.fit->drag_length_mm;
  EXPECT_LT(drag.low, true_drag_mm);
  EXPECT_GT(drag.high, true_drag_mm);
  EXPECT_LT(drag.sd, drag.prior_sd);
  EXPECT_LT(fit.fit->bias_mm.low, 0.2);
  EXPECT_GT(fit.fit->bias_mm.high, 0.2);
  EXPECT_NEAR(fit.chosen->dullness, drag.mean / (13.0 * 0.02), 1e-9);
  EXPECT_LT(fit.fit->specimens[0].check_rms_mm.value(), 0.35);  // the mesh's grain is in it
}

TEST_F(CalibrateBlocks, APhotographOfAnotherPathCountsAsIfThePlannedOneHadBeenCut) {
  const testing::PortableKernels portable;
  subjects_.pop_back();
  const auto photographed_along = [&](const std::optional<ToolPath>& path) {
    first_.own_path = path;
    const CalibrationRun cut = run(grid({13.0}, {2.2 / (13.0 * 0.02)})).specimens[0].runs[0];
    subjects_[0].photographed.tumor_edge = cut.final_tumor_edge;
    subjects_[0].photographed.incision = *cut.inner_edge;
    const Calibration fitted = run({});
    return std::pair(fitted.specimens[0], fitted.fit->specimens[0]);
  };
  const auto mean = [](const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  const auto [specimen, planned] = photographed_along(std::nullopt);
  EXPECT_FALSE(specimen.moved_mean_mm);
  Workers workers(1);
  ToolPath path =
      *run_study(subjects_[0].settings, first_, first_cache_, {.until = Stage::Plan}, workers, silent_).plan;
  for (Waypoint& waypoint : path.waypoints) {
    Vec3 out = waypoint.position_mm - Vec3(16.0, 16.0, 6.0);
    out.z() = 0.0;
    waypoint.position_mm += 0.6 * out.normalized();
  }
  const auto [moved_specimen, moved] = photographed_along(path);
  EXPECT_NEAR(*moved_specimen.moved_mean_mm, 0.6, 0.02);
  constexpr double kGrainMm = 0.25;  // tets of 1.3 mm
  EXPECT_NEAR(*moved_specimen.signed_mean_mm - *specimen.signed_mean_mm, 0.6, kGrainMm) << "what the photograph shows";
  EXPECT_NEAR(mean(moved.observed_mm), mean(planned.observed_mm), kGrainMm);
  EXPECT_NEAR(mean(moved.fitted_mm), mean(planned.fitted_mm), kGrainMm);
}

TEST_F(CalibrateBlocks, RefusesAPathThatDoesNotGoRoundTheTumour) {
  subjects_.pop_back();
  Workers workers(1);
  ToolPath path =
      *run_study(subjects_[0].settings, first_, first_cache_, {.until = Stage::Plan}, workers, silent_).plan;
  for (Waypoint& waypoint : path.waypoints)
    waypoint.position_mm = Vec3(8, 8, 6) + 0.3 * (waypoint.position_mm - Vec3(16, 16, 6));
  first_.own_path = path;
  EXPECT_THAT(testing::refusal_of<CaseError>([&] { return run({}); }),
              HasSubstr("path: found a path that does not go round"));
}

TEST_F(CalibrateBlocks, LooksHalfWayToTheFirstFailureWhereTheAnswerMayLieThere) {
  const testing::PortableKernels portable;
  subjects_.pop_back();
  subjects_[0].settings = sliding_case();
  // Photographed at 3 mm; simulated up to 2 mm, and then at 10 mm, where no ring is left.
  const Calibration made = run(grid({13.0}, {3.0 / (13.0 * 0.02)}));
  subjects_[0].photographed.tumor_edge = made.specimens[0].runs[0].final_tumor_edge;
  subjects_[0].photographed.incision = *made.specimens[0].runs[0].inner_edge;
  CalibrationRequest request{.drag_lengths_mm = {0.5, 1.25, 2.0, 10.0}, .second_drag_lengths_mm = {}};
  const Calibration fit = run(request);
  ASSERT_FALSE(fit.specimens[0].runs[3].closed_loop);
  const double beyond_mm = fit.fit->drag_length_mm.grid.back();
  EXPECT_NEAR(beyond_mm, 6.0, 1e-9);
  EXPECT_FALSE(fit.identifiability->parameters[0].is_at_limit);
  EXPECT_FALSE(fit.fit->knows_stiffness);
  EXPECT_THAT(fit.identifiability->sentences[1], HasSubstr("not varied"));
}

TEST_F(CalibrateBlocks, ASpecimenWhoseRingOpensIsLeftOutOfTheFitAndNamed) {
  subjects_[0].photographed.name = "opens";
  subjects_[1].photographed.name = "closes";
  CalibrationRequest request{.drag_lengths_mm = {0.5, 1.25, 2.0}, .second_drag_lengths_mm = {}};
  const Calibration both = run(request);
  EXPECT_TRUE(both.left_out.empty());
  ASSERT_EQ(both.fit->specimens.size(), 2U);

  const auto open_beyond = [&](std::size_t specimen, double drag_mm) {
    for (const CalibrationRun& run : both.specimens[specimen].runs) {
      if (run.drag_length_mm() < drag_mm) continue;
      change_kept(both, specimen, run.drag_length_mm(), [](CalibrationRun& kept) {
        kept.inner_edge.reset();
        kept.closed_loop = false;
        kept.outcome = Outcome::OpenLoop;
      });
    }
  };
  open_beyond(0, 0.6);
  kept_.saved = 0;
  const Calibration one = run(request);
  ASSERT_EQ(one.left_out.size(), 1U);
  EXPECT_EQ(one.left_out[0].name, "opens");
  EXPECT_THAT(one.left_out[0].reason, HasSubstr("a closed ring at fewer than two drag lengths"));
  ASSERT_EQ(one.specimens.size(), 1U);
  EXPECT_EQ(one.specimens[0].name, "closes");
  ASSERT_EQ(one.fit->specimens.size(), 1U);
  EXPECT_EQ(one.fit->specimens[0].name, "closes");
  EXPECT_LE(kept_.saved, 2);  // those near its own answer
  for (const CalibrationRun& kept : one.specimens[0].runs)
    EXPECT_TRUE(kept_.bytes.contains(slot_of(calibration_run_key(one.specimens[0].held, kept.setting))));

  open_beyond(1, 0.6);
  EXPECT_THAT([&] { static_cast<void>(run(request)); },
              ::testing::ThrowsMessage<CaseError>(::testing::AllOf(HasSubstr("case.yaml"), HasSubstr("closed ring"))));
}

TEST_F(CalibrateBlocks, ASpecimenThatOpensBetweenTheTwoFitsIsLeftOutThen) {
  CalibrationRequest request{.drag_lengths_mm = {0.5, 2.0}, .second_drag_lengths_mm = {}};
  const Calibration made = run(grid({13.0}, {1.25 / (13.0 * 0.02)}));
  for (std::size_t s = 0; s < 2; ++s) {
    subjects_[s].photographed.name = fmt::format("s{}", s);
    subjects_[s].photographed.tumor_edge = made.specimens[s].runs[0].final_tumor_edge;
    subjects_[s].photographed.incision = *made.specimens[s].runs[0].inner_edge;
  }
  kept_ = {};
  const Calibration whole = run(request);
  ASSERT_EQ(whole.fit->specimens.size(), 2U);
  const double near_mm = whole.specimens[0].runs[2].drag_length_mm();  // made after the first fit
  ASSERT_GT(near_mm, 0.65);
  ASSERT_LT(near_mm, 1.85);
  change_kept(whole, 0, near_mm, [](CalibrationRun& kept) {
    kept.inner_edge.reset();
    kept.closed_loop = false;
    kept.outcome = Outcome::OpenLoop;
  });
  const Calibration one = run(request);
  ASSERT_EQ(one.left_out.size(), 1U);
  EXPECT_EQ(one.left_out[0].name, "s0");
  ASSERT_EQ(one.fit->specimens.size(), 1U);
  EXPECT_EQ(one.fit->specimens[0].name, "s1");
  EXPECT_EQ(one.specimens[0].name, "s1");
  EXPECT_TRUE(is_usable(whole));
  EXPECT_FALSE(is_usable(one)) << "half of the specimens say nothing";
}

/// Soft tissue that its own weight turns inside out.
TEST_F(CalibrateBlocks, ASpecimenThatCannotBeStretchedAtItsStiffnessIsLeftOutAndItsCellsAreFailures) {
  for (CalibrationSubject& subject : subjects_) subject.settings.gravity_mm_s2 = Vec3(0.0, 0.0, -9810.0);
  const CalibrationRequest one_cell = grid({13.0}, {1.0});
  const double pull_n = run(one_cell).specimens[0].simulated_force_n;
  subjects_[0].photographed.name = "too soft";
  subjects_[0].photographed.stretch_force_n = 0.0005 * pull_n;
  const Calibration table = run(one_cell);
  EXPECT_TRUE(table.table.rows[0].is_failure);
  EXPECT_THAT(table.specimens[0].runs[0].problem, HasSubstr("can be stretched"));
  EXPECT_FALSE(table.specimens[1].runs[0].is_failure());

  CalibrationRequest request{.drag_lengths_mm = {0.5, 1.25}, .second_drag_lengths_mm = {}};
  const Calibration fit = run(request);
  ASSERT_EQ(fit.left_out.size(), 1U);
  EXPECT_EQ(fit.left_out[0].name, "too soft");
  EXPECT_THAT(fit.left_out[0].reason, HasSubstr("can be stretched"));
  ASSERT_EQ(fit.fit->specimens.size(), 1U);

  subjects_.pop_back();
  EXPECT_THAT([&] { static_cast<void>(run(request)); },
              ::testing::ThrowsMessage<CaseError>(::testing::AllOf(HasSubstr("case.yaml"), HasSubstr("be stretched"))));
}

TEST_F(CalibrateBlocks, ARingThatClosedBeneathTheSkinIsReadByItsMidline) {
  subjects_.pop_back();
  CalibrationRequest request{.drag_lengths_mm = {0.5, 1.25, 2.0, 2.75}, .second_drag_lengths_mm = {}};
  const Calibration made = run(grid({13.0}, {1.25 / (13.0 * 0.02)}));
  subjects_[0].photographed.tumor_edge = made.specimens[0].runs[0].final_tumor_edge;
  subjects_[0].photographed.incision = *made.specimens[0].runs[0].inner_edge;
  const Calibration whole = run(request);
  change_kept(whole, 0, 1.25, [](CalibrationRun& kept) {
    ASSERT_TRUE(kept.closed_loop && kept.ring);
    kept.inner_edge.reset();
    kept.inner_signed_error_mm.reset();
    kept.inner_abs_error_mm.reset();
  });
  const Calibration read = run(request);
  EXPECT_TRUE(read.left_out.empty());
  EXPECT_DOUBLE_EQ(read.fit->drag_length_mm.grid.back(), whole.fit->drag_length_mm.grid.back());
  EXPECT_NEAR(read.fit->drag_length_mm.mean, whole.fit->drag_length_mm.mean, 0.3);
  EXPECT_TRUE(is_usable(read));
  EXPECT_EQ(whole.specimens[0].read_by_midline, 0U);
  EXPECT_GE(read.specimens[0].read_by_midline, 1U);
}

/// A tumour edge that is unlike its mirror image by more than the tissue's give.
class LopsidedBlock : public SoftBlock {
 public:
  LopsidedBlock() : SoftBlock(0.0) {}
  std::optional<Contour> read_tumor_edge() override {
    const auto radius = [](double a) { return 4.0 + 1.1 * std::cos(2.0 * a) + 1.3 * std::sin(3.0 * a + 0.9); };
    return testing::polar_ring(radius, 72, Vec3(16, 16, 6));
  }
};

TEST_F(CalibrateBlocks, RefusesAPhotographOfAnotherTumourLyingTheOtherWayBeforeAnyCut) {
  LopsidedBlock block;
  subjects_.pop_back();
  subjects_[0].inputs = &block;
  subjects_[0].photographed = plain_photograph(*block.read_tumor_edge());
  // Turned half round, the picture's errors would be taken for those of the other side.
  for (Contour* contour : {&subjects_[0].photographed.tumor_edge, &subjects_[0].photographed.incision}) {
    for (Vec3& p : contour->points) p = Vec3(32.0 - p.x(), 32.0 - p.y(), p.z());
  }
  EXPECT_THAT([&] { static_cast<void>(run({})); },
              ::testing::ThrowsMessage<DataError>(::testing::AllOf(HasSubstr("cut.json"), HasSubstr("turned by"))));
  EXPECT_EQ(kept_.saved, 0);
}

TEST_F(CalibrateBlocks, RefusesALineAndAForceWithoutAPull) {
  subjects_.pop_back();
  subjects_[0].settings.plan.kind = PlanKind::Line;
  EXPECT_THAT([&] { static_cast<void>(run({})); },
              ::testing::ThrowsMessage<CaseError>(::testing::AllOf(HasSubstr("case.yaml"), HasSubstr("plan.kind"))));
  subjects_[0].settings = block_case();
  subjects_[0].settings.constraints->pop_back();
  subjects_[0].photographed.stretch_force_n = 3.0;
  EXPECT_THAT([&] { static_cast<void>(run({})); },
              ::testing::ThrowsMessage<CaseError>(HasSubstr("specimen.constraints")));
  EXPECT_EQ(kept_.saved, 0);
}

TEST_F(CalibrateBlocks, RefusesCasesOfDifferentRules) {
  subjects_[1].settings.cut.rule = CutRule::Lattice;
  EXPECT_THAT([&] { static_cast<void>(run({})); },
              ::testing::ThrowsMessage<CaseError>(::testing::AllOf(HasSubstr("cut.rule"), HasSubstr("lattice"),
                                                                   HasSubstr("tets, as in the first case"))));
  EXPECT_EQ(kept_.saved, 0);
}

TEST(CalibrationRequest, ListsEveryViolation) {
  EXPECT_TRUE(validate(CalibrationRequest{}).empty());
  CalibrationRequest request;
  request.speeds_mm_s = {0.0};
  request.drag_lengths_mm = {1.0};
  request.second_drag_lengths_mm = {2.0};
  request.second_stiffness = 1.0;
  EXPECT_THAT(sentences(validate(request)),
              ::testing::UnorderedElementsAre(HasSubstr("speeds_mm_s"), HasSubstr("drag_lengths_mm: found 1 values"),
                                              HasSubstr("second_drag_lengths_mm"), HasSubstr("second_stiffness")));
}

}  // namespace
}  // namespace incise
