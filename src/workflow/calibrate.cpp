#include "workflow/calibration_body.hpp"

#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/evaluation/contour_errors.hpp>
#include <incise/evaluation/error_profile.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace incise {
namespace {

/// Before the cut the edge is not yet where the photograph shows it.
constexpr double kEdgeBeforeCutSdMm = 1.0;
/// A drag length this near to a simulated one needs no separate cut.
constexpr double kNearMm = 0.15;

/// Runs one calibration: takes each requested run from the cache or simulates it.
class CalibrationRunner {
 public:
  CalibrationRunner(const std::vector<CalibrationSubject>& subjects, const CalibrationRequest& request, Cache& runs,
                    Workers& workers, Monitor& monitor)
      : request_(request), runs_(runs), workers_(workers), monitor_(monitor) {
    for (const CalibrationSubject& subject : subjects) subjects_.push_back({&subject});
  }

  Calibration run() {
    require_one_rule();
    for (Subject& subject : subjects_) prepare(subject);
    calibration_.method = request_.method;
    calibration_.reference_step_s = subjects_.front().of->settings.cut.reference_step_s;
    calibration_.cut_rule = subjects_.front().of->settings.cut.rule;
    make_runs(request_.method == CalibrationMethod::Paper ? grid() : knots());
    match_pictures();
    if (request_.method == CalibrationMethod::Fit) fit();
    score();
    return std::move(calibration_);
  }

 private:
  /// One setting, with the stiffness relative to each specimen's own reference.
  struct Knot {
    double speed_mm_s, dullness, stiffness_factor;
  };

  struct Subject {
    const CalibrationSubject* of = nullptr;
    std::vector<double> moved_mm = {};  ///< see CalibrationBody::moved_mm
  };

  void require_one_rule() const {
    const CutRule first = subjects_.front().of->settings.cut.rule;
    for (const Subject& subject : subjects_) {
      const CutRule rule = subject.of->settings.cut.rule;
      if (rule == first) continue;
      throw CaseError(
          "case", "cut.rule", std::string(to_string(rule)),
          fmt::format("{}, as in the first case: all cuts of a calibration follow one rule", to_string(first)))
          .in_file(subject.of->case_file);
    }
  }

  void prepare(Subject& prepared) {
    const CalibrationSubject& subject = *prepared.of;
    std::vector<double>& moved_mm = prepared.moved_mm;
    try {
      bodies_.push_back(std::make_unique<CalibrationBody>(subject, workers_, monitor_));
      moved_mm = bodies_.back()->moved_mm();
    } catch (const CaseError& error) {
      throw error.in_file(subject.case_file);
    }
    CalibratedSpecimen specimen;
    specimen.name = subject.photographed.name;
    specimen.stretch_force_n = subject.photographed.stretch_force_n;
    specimen.simulated_force_n = bodies_.back()->simulated_force_n();
    specimen.stretch_mm = bodies_.back()->stretched_by_mm();
    specimen.registration = subject.registration;
    specimen.ring = bodies_.back()->ring();
    specimen.held = bodies_.back()->digest();
    specimen.youngs_modulus_kpa = subject.settings.material.youngs_modulus_kpa * bodies_.back()->reference_stiffness();
    measure_photograph(subject, specimen);
    if (!moved_mm.empty())
      specimen.moved_mean_mm =
          std::accumulate(moved_mm.begin(), moved_mm.end(), 0.0) / static_cast<double>(moved_mm.size());
    // Detects a mirrored picture now, not after minutes of simulation.
    refuse_objection(subject, match_picture(subject.photographed.tumor_edge, subject.photographed.approach,
                                            bodies_.back()->tumor_edge(), subject.settings.plan.approach,
                                            {.edge_sd_mm = kEdgeBeforeCutSdMm}));
    calibration_.is_virtual = calibration_.is_virtual || subject.settings.is_virtual;
    calibration_.specimens.push_back(std::move(specimen));
  }

  static void refuse_objection(const CalibrationSubject& subject, const PictureMatch& match) {
    if (match.objection.empty()) return;
    throw DataError(subject.photograph_file, "tumor_edge", match.objection,
                    "the edge of this case's tumour, seen along its approach",
                    "Are case and evaluation of the same specimen? Is the picture mirrored or turned?");
  }

  static double target_of(const Case& settings) { return settings.plan.lateral_margin_mm - radius_mm(settings.tool); }

  static void measure_photograph(const CalibrationSubject& subject, CalibratedSpecimen& specimen) {
    const ContourErrors errors = contour_errors(subject.photographed.incision, subject.photographed.tumor_edge,
                                                target_of(subject.settings), subject.photographed.approach);
    const auto count = static_cast<double>(errors.signed_error_mm.size());
    double signed_mean_mm = 0.0;
    for (const double e : errors.signed_error_mm) {
      specimen.photographed.mean_mm += std::abs(e) / count;
      specimen.photographed.max_mm = std::max(specimen.photographed.max_mm, std::abs(e));
      signed_mean_mm += e / count;
    }
    specimen.signed_mean_mm = signed_mean_mm;
  }

  [[nodiscard]] std::vector<Knot> grid() const {
    std::vector<Knot> knots;
    for (const double speed : request_.speeds_mm_s) {
      for (const double dullness : request_.dullnesses) knots.push_back({speed, dullness, 1.0});
    }
    return knots;
  }

  [[nodiscard]] Knot knot_at(double drag_length_mm, double stiffness_factor) const {
    return {request_.fit_speed_mm_s, drag_length_mm / (request_.fit_speed_mm_s * calibration_.reference_step_s),
            stiffness_factor};
  }

  [[nodiscard]] std::vector<Knot> knots() const {
    std::vector<Knot> knots;
    for (const double drag : request_.drag_lengths_mm) knots.push_back(knot_at(drag, 1.0));
    for (const double drag : request_.second_drag_lengths_mm) knots.push_back(knot_at(drag, request_.second_stiffness));
    return knots;
  }

  /// Appends one run for each specimen and knot.
  void make_runs(const std::vector<Knot>& knots) {
    struct Missing {
      std::size_t specimen, place;
    };
    std::vector<Missing> missing;
    for (std::size_t s = 0; s < subjects_.size(); ++s) {
      for (const Knot& knot : knots) {
        const RunSetting setting{knot.speed_mm_s, knot.dullness,
                                 knot.stiffness_factor * bodies_[s]->reference_stiffness()};
        std::vector<CalibrationRun>& runs = calibration_.specimens[s].runs;
        const CacheKey key = calibration_run_key(bodies_[s]->digest(), setting);
        std::optional<CalibrationRun> kept = runs_.find<CalibrationRun>(slot_of(key), key, monitor_);
        if (!kept) missing.push_back({s, runs.size()});
        runs.push_back(kept ? std::move(*kept) : CalibrationRun{.setting = setting});
        factors_.resize(std::max(factors_.size(), runs.size()));
        factors_[runs.size() - 1] = knot.stiffness_factor;
      }
    }
    const std::size_t asked = subjects_.size() * knots.size();
    calibration_.simulations += asked;
    const char* simulations = asked == 1 ? "simulation" : "simulations";
    monitor_.message(Severity::Notice, fmt::format("calibration: {} {}, {} of them finished already", asked,
                                                   simulations, asked - missing.size()));
    std::vector<IncisionTask> tasks;
    std::vector<Missing> simulated;
    std::vector<const HeldBody*> held;
    for (const Missing& one : missing) {
      CalibrationRun& run = calibration_.specimens[one.specimen].runs[one.place];
      const HeldBody* body = body_or_problem(one.specimen, run);
      if (body == nullptr) {
        keep(one.specimen, run);
        continue;
      }
      simulated.push_back(one);
      held.push_back(body);
      const Case settings = with_setting(subjects_[one.specimen].of->settings, run.setting);
      ToolPath path = held.back()->followed;
      path.tumor_edge = held.back()->plan.tumor_edge;
      tasks.push_back({&held.back()->model, &held.back()->stretched.state, {incision_settings(settings, path), path}});
    }
    std::size_t done = 0;
    simulate_incisions(tasks, workers_, monitor_, [&](std::size_t i, IncisionJobResult result) {
      if (result.incision.outcome == Outcome::Cancelled) return;
      const Missing& one = simulated[i];
      CalibrationRun& run = calibration_.specimens[one.specimen].runs[one.place];
      run = run_of(with_setting(subjects_[one.specimen].of->settings, run.setting), run.setting, std::move(result),
                   *held[i]);
      keep(one.specimen, run);
      ++done;
    });
    if (done < tasks.size()) {
      throw Cancelled(fmt::format("the calibration was interrupted with {} of {} {} to go", tasks.size() - done, asked,
                                  simulations));
    }
  }

  void keep(std::size_t specimen, const CalibrationRun& run) {
    const CacheKey key = calibration_run_key(bodies_[specimen]->digest(), run.setting);
    runs_.keep(slot_of(key), key, run);
  }

  /// Returns the body that a run cuts. Null, with the reason in the run, if the specimen cannot be held at that
  /// stiffness: one such run among many does not end the calibration.
  const HeldBody* body_or_problem(std::size_t specimen, CalibrationRun& run) {
    try {
      return &bodies_[specimen]->with_stiffness(run.setting.stiffness_of_case, workers_, monitor_);
    } catch (const CaseError& error) {
      run.problem = sentence(error.problem());
      std::string told = error.in_file(subjects_[specimen].of->case_file).what();
      if (const auto [place, is_new] = told_.insert(std::move(told)); is_new)
        monitor_.message(Severity::Warning, *place);  // once, not for every run of that stiffness
      return nullptr;
    }
  }

  /// Matches each photograph to the simulated specimen after its first cut that closed, tool out.
  void match_pictures() {
    for (std::size_t s = 0; s < subjects_.size(); ++s) {
      CalibratedSpecimen& specimen = calibration_.specimens[s];
      const auto closed = std::find_if(specimen.runs.begin(), specimen.runs.end(),
                                       [](const CalibrationRun& run) { return run.inner_edge.has_value(); });
      if (closed == specimen.runs.end()) continue;
      specimen.picture = match_picture(subjects_[s].of->photographed.tumor_edge, subjects_[s].of->photographed.approach,
                                       closed->final_tumor_edge, subjects_[s].of->settings.plan.approach);
      refuse_objection(*subjects_[s].of, specimen.picture);
      if (!specimen.picture.is_doubtful) continue;
      refuse_if_of_another_case(s);
      doubt_specimen(subjects_[s].of->photograph_file, specimen.picture);
    }
  }

  /// Refuses a photograph that matches another case of the calibration without doubt, and far better than its own: the
  /// two were mixed up.
  void refuse_if_of_another_case(std::size_t s) const {
    constexpr double kBetterBy = 2.0;
    const CalibrationSubject& subject = *subjects_[s].of;
    const PictureMatch& own = calibration_.specimens[s].picture;
    for (std::size_t other = 0; other < subjects_.size(); ++other) {
      const auto& runs = calibration_.specimens[other].runs;
      const auto closed = std::find_if(runs.begin(), runs.end(), [](const CalibrationRun& run) { return run.inner_edge.has_value(); });
      if (other == s || closed == runs.end()) continue;
      const PictureMatch match = match_picture(subject.photographed.tumor_edge, subject.photographed.approach, closed->final_tumor_edge,
                                               subjects_[other].of->settings.plan.approach);
      if (match.is_doubtful || kBetterBy * match.rms_mm > own.rms_mm) continue;
      throw DataError(subject.photograph_file, "tumor_edge",
                      fmt::format("a tumour edge that fits the case {} ({:.2f} mm apart, turned by {:.1f} degrees), not its own case {} "
                                  "({:.2f} mm, {:.1f} degrees)",
                                  subjects_[other].of->case_file, match.rms_mm, match.turn_deg, subject.case_file, own.rms_mm, own.turn_deg),
                      "the edge of its own case's tumour", "Are --observed and the cases in the same order?");
    }
  }

  void doubt_specimen(const std::string& file, const PictureMatch& match) {
    const std::string message = fmt::format(
        "{}: its tumour edge lies {:.2f} mm off the simulated one, turned by {:.1f} degrees; a photograph of the same specimen lies within "
        "{} mm and {} degrees. Is it of another specimen?",
        file, match.rms_mm, match.turn_deg, PictureMatchSettings{}.edge_sd_mm, PictureMatchSettings{}.doubtful_turn_deg);
    calibration_.verdict.add("photo_specimen", match.rms_mm, message);
    monitor_.message(Severity::Warning, "caution: photo_specimen: " + message);
  }

  /// Returns a profile as if the cut had followed the planned path: a path and its cut move together.
  [[nodiscard]] std::vector<double> as_if_planned(std::size_t s, std::vector<double> profile) const {
    const std::vector<double>& moved = subjects_[s].moved_mm;
    for (std::size_t i = 0; i < profile.size() && !moved.empty(); ++i) profile[i] -= moved[i];
    return profile;
  }

  /// Returns the photographed profile from the simulation's start direction, transferred to the photograph.
  [[nodiscard]] std::vector<double> photographed_profile(std::size_t s) const {
    const CalibrationSubject& subject = *subjects_[s].of;
    ProfileSettings profile = profile_of_inner_edge(subject.settings);
    const ViewFrame view = view_along(subject.settings.plan.approach);
    const ViewFrame picture = view_along(subject.photographed.approach);
    const Vec3& start = subject.settings.plan.start_direction;
    profile.approach = subject.photographed.approach;
    profile.start_direction = picture.x * start.dot(view.x) + picture.y * start.dot(view.y);
    profile.turn_deg = -calibration_.specimens[s].picture.turn_deg;
    std::optional<std::vector<double>> errors =
        error_profile(subject.photographed.incision, subject.photographed.tumor_edge, profile);
    if (!errors) {
      throw DataError(subject.photograph_file, "points", "an incision that does not go round the tumour's middle",
                      "a ring round the tumour");
    }
    return as_if_planned(s, std::move(*errors));
  }

  /// Returns the profile of a run's inner edge; empty if the ring did not part at the skin, or does not go round the
  /// tumour's middle.
  [[nodiscard]] std::vector<double> inner_edge_profile(std::size_t s, const CalibrationRun& run) const {
    if (!run.inner_edge || !run.closed_loop) return {};
    return error_profile(*run.inner_edge, run.final_tumor_edge, profile_of_inner_edge(subjects_[s].of->settings))
        .value_or(std::vector<double>{});
  }

  /// Estimates the profile of the inner edge from the mid-line of the shallowest closed layer and half the kerf's width
  /// there, before the tissue moves. Empty if the ring did not close.
  [[nodiscard]] std::vector<double> midline_profile(std::size_t s, const CalibrationRun& run) const {
    if (!run.ring || !run.closed_loop) return {};
    const Case& settings = subjects_[s].of->settings;
    ProfileSettings profile = profile_of_inner_edge(settings);
    profile.target_mm += run.ring->half_width_mm;
    return error_profile(run.ring->midline, bodies_[s]->tumor_edge(), profile).value_or(std::vector<double>{});
  }

  /// Returns the mean difference, sector by sector, between the inner edges of a specimen's runs and the estimates from
  /// their mid-lines; empty if no run has both.
  [[nodiscard]] std::vector<double> edge_beside_midline(std::size_t s) const {
    std::vector<double> sum;
    double count = 0.0;
    for (const CalibrationRun& run : calibration_.specimens[s].runs) {
      const std::vector<double> edge = inner_edge_profile(s, run);
      const std::vector<double> midline = midline_profile(s, run);
      if (edge.empty() || midline.empty()) continue;
      sum.resize(edge.size(), 0.0);
      for (std::size_t i = 0; i < edge.size(); ++i) sum[i] += edge[i] - midline[i];
      count += 1.0;
    }
    for (double& difference : sum) difference /= count;
    return sum;
  }

  /// Returns the profiles of the inner edges of all runs. Where strips of skin still hold the plug of a ring that
  /// closed beneath, the profile is the estimate from the mid-line plus the specimen's mean difference. Empty: no
  /// closed ring.
  [[nodiscard]] std::vector<SimulatedProfile> profiles_of(std::size_t s) const {
    std::vector<SimulatedProfile> profiles;
    const std::vector<CalibrationRun>& runs = calibration_.specimens[s].runs;
    const std::vector<double> beside = edge_beside_midline(s);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      std::vector<double> profile = inner_edge_profile(s, runs[i]);
      if (profile.empty() && !beside.empty()) {
        profile = midline_profile(s, runs[i]);
        for (std::size_t j = 0; j < profile.size(); ++j) profile[j] += beside[j];
      }
      profiles.push_back({runs[i].drag_length_mm(), factors_[i], as_if_planned(s, std::move(profile))});
    }
    return profiles;
  }

  /// Reports the rings of a fit that are not measured as the photograph's is.
  void tell_midlines(std::size_t s, const std::vector<SimulatedProfile>& profiles) {
    CalibratedSpecimen& specimen = calibration_.specimens[s];
    for (std::size_t i = 0; i < profiles.size(); ++i) {
      if (!profiles[i].signed_error_mm.empty() && inner_edge_profile(s, specimen.runs[i]).empty())
        ++specimen.read_by_midline;
    }
    if (specimen.read_by_midline == 0) return;
    const auto closed = std::count_if(profiles.begin(), profiles.end(),
                                      [](const SimulatedProfile& profile) { return !profile.signed_error_mm.empty(); });
    monitor_.message(
        Severity::Notice,
        fmt::format("{}: {} of {} closed simulated rings have no inner edge at the skin; it is estimated from their "
                    "mid-line",
                    specimen.name, specimen.read_by_midline, closed));
  }

  /// Returns why a specimen has too few simulated drag lengths to interpolate between.
  [[nodiscard]] std::string why_no_line(std::size_t s) const {
    const std::vector<CalibrationRun>& runs = calibration_.specimens[s].runs;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (is_reference_stiffness(factors_[i]) && !runs[i].problem.empty()) return runs[i].problem;
    }
    const bool is_any_closed =
        std::any_of(runs.begin(), runs.end(), [](const CalibrationRun& run) { return run.closed_loop; });
    const bool is_any_at_skin =
        std::any_of(runs.begin(), runs.end(), [](const CalibrationRun& run) { return run.inner_edge.has_value(); });
    if (is_any_closed && !is_any_at_skin) return "no simulated cut that parts the skin all round";
    return "simulated cuts with a closed ring at fewer than two drag lengths before the first open one";
  }

  /// Leaves out specimens for which fewer than two drag lengths can be measured: they say nothing of the others. The
  /// fit continues without them and reports it. If it is the only one left, the case is refused.
  void leave_out_what_cannot_be_read() {
    for (std::size_t s = 0; s < subjects_.size();) {
      if (DragResponse::can_be_made_of(profiles_of(s))) {
        ++s;
        continue;
      }
      const CalibrationSubject& subject = *subjects_[s].of;
      const std::string why = why_no_line(s);
      if (subjects_.size() == 1) {
        throw CaseError("case", "cut", why, "a specimen that the simulated tool can cut round",
                        calibration_.left_out.empty()
                            ? ""
                            : fmt::format("{} others were left out before it", calibration_.left_out.size()))
            .in_file(subject.case_file);
      }
      monitor_.message(Severity::Warning,
                       fmt::format("{}: {}: this specimen is left out of the fit", subject.case_file, why));
      calibration_.left_out.push_back({subject.photographed.name, why});
      const auto place = static_cast<std::ptrdiff_t>(s);
      subjects_.erase(subjects_.begin() + place);
      bodies_.erase(bodies_.begin() + place);
      calibration_.specimens.erase(calibration_.specimens.begin() + place);
    }
  }

  /// Fits twice. Between simulated drag lengths the profile is interpolated linearly, which is not exact. So after the
  /// first fit one more cut is made near the drag length that it found and, if the interval ends at a cut that failed,
  /// another half-way to that.
  void fit() {
    fit_once();
    std::vector<Knot> more;
    const double found_mm = calibration_.fit->drag_length_mm.mean;
    const auto is_near = [found_mm](double drag_mm) { return std::abs(drag_mm - found_mm) < kNearMm; };
    if (std::none_of(request_.drag_lengths_mm.begin(), request_.drag_lengths_mm.end(), is_near)) {
      more.push_back(knot_at(found_mm, 1.0));
    }
    if (const std::optional<double> beyond_mm = half_way_to_failure()) more.push_back(knot_at(*beyond_mm, 1.0));
    if (!more.empty()) {
      make_runs(more);
      fit_once();
    }
    check();
  }

  /// Returns the drag length half-way between the end of the simulated range and the first that failed, if the interval
  /// ends there.
  [[nodiscard]] std::optional<double> half_way_to_failure() const {
    const double end_mm = calibration_.fit->drag_length_mm.grid.back();
    const bool is_at_end =
        calibration_.identifiability->parameters[0].is_at_limit &&
        calibration_.fit->drag_length_mm.high > 0.5 * (end_mm + calibration_.fit->drag_length_mm.mean);
    std::optional<double> failed_mm;
    for (const double drag : request_.drag_lengths_mm) {
      if (drag > end_mm + kNearMm && (!failed_mm || drag < *failed_mm)) failed_mm = drag;
    }
    return is_at_end && failed_mm ? std::optional(0.5 * (end_mm + *failed_mm)) : std::nullopt;
  }

  void fit_once() {
    leave_out_what_cannot_be_read();  // each time: a cut made since then may have stayed open, too
    std::vector<FitSpecimen> specimens;
    DragFitSettings settings = request_.fit;
    bool is_every_force_measured = true;
    for (std::size_t s = 0; s < subjects_.size(); ++s) {
      const bool has_force = subjects_[s].of->photographed.stretch_force_n.has_value();
      is_every_force_measured = is_every_force_measured && has_force;
      specimens.push_back({calibration_.specimens[s].name, photographed_profile(s), DragResponse(profiles_of(s)),
                           has_force ? request_.force_sd : 0.0});
    }
    if (is_every_force_measured) settings.stiffness_sd = request_.stiffness_sd_with_force;
    calibration_.fit = fit_drag(specimens, settings);
    calibration_.identifiability = identifiability(*calibration_.fit);
  }

  /// Makes one cut at the fitted values, to show the error of interpolating between the simulated drag lengths.
  void check() {
    DragFit& fit = *calibration_.fit;
    make_runs({knot_at(fit.drag_length_mm.mean, fit.knows_stiffness ? std::exp(fit.ln_stiffness.mean) : 1.0)});
    for (std::size_t s = 0; s < subjects_.size(); ++s) {
      SpecimenFit& specimen = fit.specimens[s];
      const std::vector<SimulatedProfile> profiles = profiles_of(s);
      specimen.simulated_mm = profiles.back().signed_error_mm;
      tell_midlines(s, profiles);
      if (specimen.simulated_mm.empty()) {
        const std::string& problem = calibration_.specimens[s].runs.back().problem;
        monitor_.message(Severity::Warning,
                         problem.empty()
                             ? fmt::format("{}: the simulated ring stays open at the fitted values", specimen.name)
                             : fmt::format("{}: cannot be cut at the fitted values: {}", specimen.name, problem));
        continue;
      }
      double squares = 0.0;
      for (std::size_t i = 0; i < specimen.simulated_mm.size(); ++i) {
        squares += std::pow(specimen.simulated_mm[i] + fit.bias_mm.mean - specimen.fitted_mm[i], 2);
      }
      specimen.check_rms_mm = std::sqrt(squares / static_cast<double>(specimen.simulated_mm.size()));
    }
  }

  void score() {
    std::vector<PhotographedErrors> photographs;
    std::vector<std::vector<CalibrationRun>> runs;
    for (const CalibratedSpecimen& specimen : calibration_.specimens) {
      photographs.push_back(specimen.photographed);
      runs.push_back(specimen.runs);
    }
    calibration_.table = score_table(runs, photographs);
    if (calibration_.fit)
      calibration_.table.chosen = calibration_.table.rows.size() - 1;  // the cut at the fitted values
    if (!calibration_.table.chosen) return;
    const ScoreRow& row = calibration_.table.rows[*calibration_.table.chosen];
    calibration_.chosen = row.setting;
    calibration_.score_percent = calibration_.fit ? row.inner_percent : std::optional(row.percent);
  }

  std::vector<Subject> subjects_;
  const CalibrationRequest& request_;
  Cache& runs_;
  Workers& workers_;
  Monitor& monitor_;
  std::vector<std::unique_ptr<CalibrationBody>> bodies_;
  std::vector<double> factors_;  ///< stiffness factor of each row
  std::set<std::string> told_;   ///< reasons already reported why specimens cannot be held
  Calibration calibration_;
};

}  // namespace

std::vector<Problem> validate(const CalibrationRequest& r) {
  std::vector<Problem> violations = problems_of(r);
  const Expect expect(violations);
  for (const double drag : r.second_drag_lengths_mm) {
    const bool is_among =
        std::find(r.drag_lengths_mm.begin(), r.drag_lengths_mm.end(), drag) != r.drag_lengths_mm.end();
    expect(is_among, "second_drag_lengths_mm", drag, "one of drag_lengths_mm");
  }
  expect(r.second_stiffness != 1.0, "second_stiffness", r.second_stiffness, "a number other than 1");
  if (r.speeds_mm_s.empty() || r.dullnesses.empty())
    violations.push_back({"speeds_mm_s", "none", "at least one speed and one dullness"});
  if (r.drag_lengths_mm.size() < 2)
    violations.push_back({"drag_lengths_mm", fmt::format("{} values", r.drag_lengths_mm.size()), "at least 2"});
  return violations;
}

CacheKey calibration_run_key(const std::string& held, const RunSetting& setting) {
  return CacheKey("calibration_run").add_text(held).add(setting);
}

Calibration calibrate(const std::vector<CalibrationSubject>& subjects, const CalibrationRequest& request, Cache& runs,
                      Workers& workers, Monitor& monitor) {
  require_none(validate(request));
  INCISE_REQUIRE(!subjects.empty(), "expected at least one specimen");
  return CalibrationRunner(subjects, request, runs, workers, monitor).run();
}

}  // namespace incise
