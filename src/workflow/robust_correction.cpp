#include "workflow/calibration_body.hpp"

#include <incise/core/error.hpp>
#include <incise/workflow/correction.hpp>
#include <incise/workflow/robust_correction.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr double kDegreesRound = 360.0;

/// The case as a calibration compares it: by the inner edge.
Case by_inner_edge(const Case& settings) {
  Case changed = settings;
  changed.compensation.observable = ContourKind::InnerEdge;
  return changed;
}

CalibrationSubject subject_of(const Case& settings, Inputs& inputs, Cache& cache, const ScenarioRequest& request) {
  CalibrationSubject subject;
  subject.settings = settings;
  subject.inputs = &inputs;
  subject.cache = &cache;
  subject.photographed.stretch_force_n = request.stretch_force_n;
  return subject;
}

/// A specimen in the tissues that a calibration leaves possible.
class TissueCuts {
 public:
  TissueCuts(const Case& settings, Inputs& inputs, Cache& cache, const Study& done, const CalibratedBelief& belief,
             const ScenarioRequest& request, Workers& workers, Monitor& monitor)
      : settings_(by_inner_edge(settings)),
        subject_(subject_of(settings, inputs, cache, request)),
        belief_(belief),
        request_(request),
        cache_(cache),
        workers_(workers),
        monitor_(monitor),
        body_(subject_, workers, monitor),
        intended_(*done.followed),
        surface_(skin_of(done.model->mesh, done.stretched->state.positions)) {
    INCISE_REQUIRE(done.correction && done.correction->iteration,
                   "expected a study that was corrected by the default method");
    intended_.tumor_edge = done.plan->tumor_edge;
    corrected_offset_mm_ = done.correction->moves.move_mm;
    find_scenarios();
  }

  [[nodiscard]] RobustCorrection choose() {
    const RobustSettings chosen_by = robust_settings();
    RobustCompensation compensation =
        compensate_robust(intended_, corrected_offset_mm_, surface_, weighted(), measure(), chosen_by);
    return {scenarios_, chosen_by, corrected_offset_mm_, std::move(compensation)};
  }

  [[nodiscard]] CorrectionOutlook foresee() {
    const RobustSettings judged_by = robust_settings();
    PathOutlook paths = foresee_paths(intended_, corrected_offset_mm_, surface_, weighted(), measure(), judged_by);
    return {scenarios_, judged_by, std::move(paths)};
  }

 private:
  /// How far this specimen's modulus may be from its reference, beside what the calibration says.
  [[nodiscard]] double own_stiffness_sd() const {
    if (request_.stretch_force_n) return request_.force_sd;
    return belief_.knows_forces ? request_.unknown_stiffness_sd : 0.0;
  }

  void find_scenarios() {
    if (request_.stretch_force_n && !belief_.knows_forces) {
      throw CaseError("command line", "--stretch-force-n", "a pull, and a calibration that was made without",
                      "both with the pull of the suture, or both without");
    }
    const double reference = body_.reference_stiffness();
    scenarios_.own_stiffness_sd = own_stiffness_sd();
    scenarios_.tissues = tissue_scenarios(belief_.samples, belief_.residual, scenarios_.own_stiffness_sd);
    scenarios_.simulated_force_n = body_.simulated_force_n();
    scenarios_.reference_kpa = settings_.material.youngs_modulus_kpa * reference;
    if (belief_.trend) follow_trend(*belief_.trend);
    for (const TissueScenario& tissue : scenarios_.tissues.points) {
      const double dullness = tissue.drag_length_mm / (belief_.speed_mm_s * settings_.cut.reference_step_s);
      scenarios_.settings.push_back({belief_.speed_mm_s, dullness, tissue.stiffness_factor * reference});
    }
  }

  /// The farther this specimen's stiffness lies from the calibrated ones, the less their bias says of it.
  void follow_trend(const StiffnessTrend& trend) {
    TissueScenarios& tissues = scenarios_.tissues;
    const double kpa = scenarios_.reference_kpa;
    scenarios_.stiffness_shift_mm = trend.shift_mm(kpa);
    scenarios_.stiffness_shift_sd_mm =
        std::hypot(trend.shift_sd_mm(kpa), trend.rise_sd_mm(kpa) * scenarios_.own_stiffness_sd);
    for (TissueScenario& tissue : tissues.points) tissue.bias_mm += trend.shift_mm(kpa * tissue.stiffness_factor);
    tissues.bias_sd_mm = std::hypot(tissues.bias_sd_mm, scenarios_.stiffness_shift_sd_mm);
    tissues.common_sd_mm = std::hypot(tissues.common_sd_mm, scenarios_.stiffness_shift_sd_mm);
  }

  [[nodiscard]] std::vector<CutScenario> weighted() const {
    std::vector<CutScenario> list;
    for (const TissueScenario& tissue : scenarios_.tissues.points) list.push_back({tissue.weight, tissue.bias_mm});
    return list;
  }

  [[nodiscard]] RobustSettings robust_settings() const {
    RobustSettings robust;
    robust.region = safe_region(settings_);
    robust.target_mm = settings_.plan.lateral_margin_mm - radius_mm(settings_.tool);
    robust.kerf_allowance_mm = 0.0;  // an inner edge is where the tissue ends
    robust.max_probability = request_.max_probability;
    robust.residual_sd_mm = belief_.residual.sd_mm;
    robust.residual_length_mm = belief_.residual.correlation_deg / kDegreesRound * length_mm(entry_contour(intended_));
    robust.common_sd_mm = scenarios_.tissues.common_sd_mm;
    robust.placement_sd_mm = belief_.residual.placement_mm;
    robust.seed = request_.seed;
    return robust;
  }

  [[nodiscard]] MeasureScenarios measure() {
    return [this](const ToolPath& path) {
      std::vector<std::optional<PathErrors>> errors;
      for (ScenarioRun& run : runs_along(path)) errors.push_back(std::move(run.errors));
      return errors;
    };
  }

  /// One run for each tissue: those that the store has, and the others simulated side by side.
  std::vector<ScenarioRun> runs_along(const ToolPath& path) {
    std::vector<ScenarioRun> made;
    std::vector<std::size_t> missing;
    for (const RunSetting& setting : scenarios_.settings) {
      const CacheKey key = scenario_run_key(body_.digest(), setting, path);
      std::optional<ScenarioRun> kept = cache_.find<ScenarioRun>(slot_of(key), key, monitor_);
      if (!kept) missing.push_back(made.size());
      made.push_back(kept ? std::move(*kept) : ScenarioRun{.setting = setting});
    }
    monitor_.message(Severity::Notice,
                     fmt::format("tissues of the calibration: {} cuts along a path, {} of them finished already",
                                 made.size(), made.size() - missing.size()));
    simulate(path, missing, made);
    for (const ScenarioRun& run : made) {
      if (run.problem.empty()) continue;
      monitor_.message(Severity::Warning, fmt::format("a tissue of the calibration could not be cut: {}", run.problem));
    }
    return made;
  }

  void simulate(const ToolPath& path, const std::vector<std::size_t>& missing, std::vector<ScenarioRun>& made) {
    std::vector<IncisionTask> tasks;
    std::vector<const HeldBody*> held;
    std::vector<std::size_t> simulated;  // those of the missing whose tissue can be held and stretched
    for (const std::size_t k : missing) {
      const HeldBody* body = held_at(made[k]);
      if (body == nullptr) continue;
      simulated.push_back(k);
      held.push_back(body);
      ToolPath with_edge = path;
      with_edge.tumor_edge = body->plan.tumor_edge;
      tasks.push_back({&body->model,
                       &body->stretched.state,
                       {incision_settings(with_setting(settings_, made[k].setting)), std::move(with_edge)}});
    }
    std::size_t done = 0;
    simulate_incisions(tasks, workers_, monitor_, [&](std::size_t i, IncisionJobResult result) {
      if (result.incision.outcome == Outcome::Cancelled) return;
      ScenarioRun& run = made[simulated[i]];
      run.problem = result.problem;
      if (run.problem.empty()) run.errors = errors_of(std::move(result.incision), path, run.setting, *held[i]);
      const CacheKey key = scenario_run_key(body_.digest(), run.setting, path);
      cache_.keep(slot_of(key), key, run);
      ++done;
    });
    if (done < tasks.size())
      throw Cancelled(fmt::format("the tissues of the calibration were interrupted with {} of {} cuts to go",
                                  tasks.size() - done, tasks.size()));
  }

  /// The specimen with a scenario's stiffness; null, and the scenario's problem says why: it cannot be stretched so.
  const HeldBody* held_at(ScenarioRun& run) {
    try {
      return &body_.with_stiffness(run.setting.stiffness_of_case, workers_, monitor_);
    } catch (const CaseError& error) {
      run.problem = error.what();
      return nullptr;
    }
  }

  /// Absent: no closed ring, or an inner edge that is open at the skin.
  [[nodiscard]] std::optional<PathErrors> errors_of(IncisionResult incision, const ToolPath& followed,
                                                    const RunSetting& setting, const HeldBody& held) const {
    const Case settings = with_setting(settings_, setting);
    const SimulatedCut cut = judge(settings, std::move(incision), followed, held.plan, held.model.mesh.tets.size());
    if (!cut.incision.is_closed_loop.value_or(false) || !cut.incision.inner_edge) return std::nullopt;
    Monitor silent;  // any thread may come here
    return path_errors(settings, cut, held.plan.tumor_edge, silent);
  }

  const Case settings_;
  const CalibrationSubject subject_;
  const CalibratedBelief& belief_;
  const ScenarioRequest& request_;
  Cache& cache_;
  Workers& workers_;
  Monitor& monitor_;
  CalibrationBody body_;
  ToolPath intended_;
  SurfaceQuery surface_;
  std::vector<double> corrected_offset_mm_;
  ScenarioSet scenarios_;
};

}  // namespace

CacheKey scenario_run_key(const std::string& held, const RunSetting& setting, const ToolPath& path) {
  return CacheKey("scenario_run").add_text(held).add(setting).add(unmarked(path));
}

RobustCorrection correct_robustly(const Case& settings, Inputs& inputs, Cache& cache, const Study& done,
                                  const CalibratedBelief& belief, const ScenarioRequest& request, Workers& workers,
                                  Monitor& monitor) {
  return TissueCuts(settings, inputs, cache, done, belief, request, workers, monitor).choose();
}

CorrectionOutlook foresee_correction(const Case& settings, Inputs& inputs, Cache& cache, const Study& done,
                                     const CalibratedBelief& belief, const ScenarioRequest& request, Workers& workers,
                                     Monitor& monitor) {
  return TissueCuts(settings, inputs, cache, done, belief, request, workers, monitor).foresee();
}

void describe_scenarios(Visitor& v, ScenarioSet& s, RobustSettings& settings) {
  v.begin({"scenarios", "Tissues that the calibration leaves possible."});
  v({"reference_kpa", "Young's modulus that stiffness factors are over.", "kPa"}, s.reference_kpa);
  v({"simulated_force_n", "Pull of the specimen at the case's modulus.", "N"}, s.simulated_force_n);
  v("own_stiffness_sd", s.own_stiffness_sd, "Of the logarithm of the specimen's own stiffness.");
  v.begin({"spread", "Of what is believed of the next specimen."});
  v({"drag_length_sd_mm", "Of the drag length.", "mm"}, s.tissues.drag_length_sd_mm);
  v("ln_stiffness_sd", s.tissues.ln_stiffness_sd, "The specimen's own included.");
  v({"bias_sd_mm", "From specimen to specimen included.", "mm"}, s.tissues.bias_sd_mm);
  v.end();
  v.begin({"stiffness_shift_mm", "By which the bias is expected to differ at this specimen's stiffness.", "mm"});
  v("mean", s.stiffness_shift_mm, "Expected.");
  v("sd", s.stiffness_shift_sd_mm, "Standard deviation.");
  v.end();
  v.begin({"residual", "Of a real cut about what its scenario says."});
  v({"sd_mm", "Standard deviation.", "mm"}, settings.residual_sd_mm);
  v({"length_mm", "Over which its correlation falls to 1/e.", "mm"}, settings.residual_length_mm);
  v({"common_sd_mm", "Of what is the same all round.", "mm"}, settings.common_sd_mm);
  v({"placement_sd_mm", "Of a shift of the whole cut.", "mm"}, settings.placement_sd_mm);
  v.end();
  v("tissues", s.tissues.points, "The first: the middle.");
  v.end();
}

void describe(Visitor& v, RobustCorrection& r) {
  RobustCompensation& chosen = r.compensation;
  v("outcome", chosen.outcome, "Whether the path keeps the probability.");
  v("max_probability", r.settings.max_probability, "Allowed of less tissue than the close margin.");
  v({"close_margin_mm", "Clinical cut-off.", "mm"}, r.settings.region.close_margin_mm);
  v.derived("contour", ContourKind::InnerEdge, "What is measured.");
  v("intended", chosen.intended, "Risk of the intended path.");
  v("corrected", chosen.corrected, "Of the corrected one.");
  v("robust", chosen.robust, "Of the chosen one.");
  v("simulations", chosen.simulations, "Scenarios times paths.");
  describe_scenarios(v, r.scenarios, r.settings);
  v.bulk("corrected_offset_mm", r.corrected_offset_mm, "Per waypoint: of the corrected path.");
}

}  // namespace incise
