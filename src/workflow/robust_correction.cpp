#include "workflow/calibration_body.hpp"

#include <incise/core/error.hpp>
#include <incise/evaluation/error_profile.hpp>
#include <incise/workflow/correction.hpp>
#include <incise/workflow/robust_correction.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace {

/// The case as a calibration compares it: by the inner edge.
Case by_inner_edge(const Case& settings) {
  Case changed = settings;
  changed.compensation.observable = ContourKind::InnerEdge;
  return changed;
}

CalibrationSubject subject_of(const Case& settings, Inputs& inputs, Cache& cache, const ScenarioRequest& request) {
  CalibrationSubject subject{.settings = settings, .inputs = &inputs, .cache = &cache};
  subject.photographed.stretch_force_n = request.stretch_force_n;
  return subject;
}

/// Cuts of a specimen in the tissue that a calibration expects.
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
    expect_photographs();
  }

  [[nodiscard]] RobustCorrection choose() {
    const RobustSettings chosen_by = robust_settings();
    RobustCompensation compensation =
        compensate_robust(intended_, corrected_offset_mm_, surface_, weighted(), measure(), residual_, chosen_by);
    return {scenarios_, chosen_by, corrected_offset_mm_, std::move(compensation)};
  }

  [[nodiscard]] CorrectionOutlook foresee() {
    const RobustSettings judged_by = robust_settings();
    PathOutlook paths =
        foresee_paths(intended_, corrected_offset_mm_, surface_, weighted(), measure(), residual_, judged_by);
    return {scenarios_, judged_by, std::move(paths)};
  }

 private:
  /// Uncertainty of this specimen's modulus about its reference, beyond the calibration's.
  [[nodiscard]] double own_stiffness_sd() const {
    if (request_.stretch_force_n) return 0.0;  // the calibration's photographs include the error of a measured pull
    return belief_.knows_forces ? request_.unknown_stiffness_sd : 0.0;
  }

  void find_scenarios() {
    if (request_.stretch_force_n && !belief_.knows_forces) {
      throw CaseError("command line", "--stretch-force-n", "a pull, but a calibration made without one",
                      "both with the pull of the suture, or both without");
    }
    const double reference = body_.reference_stiffness();
    scenarios_.own_stiffness_sd = own_stiffness_sd();
    scenarios_.tissues = tissue_scenarios(belief_.samples, scenarios_.own_stiffness_sd);
    scenarios_.simulated_force_n = body_.simulated_force_n();
    scenarios_.reference_kpa = settings_.material.youngs_modulus_kpa * reference;
    for (const TissueScenario& tissue : scenarios_.tissues) {
      const double dullness = tissue.drag_length_mm / (belief_.speed_mm_s * settings_.cut.reference_step_s);
      scenarios_.settings.push_back({belief_.speed_mm_s, dullness, tissue.stiffness_factor * reference});
    }
  }

  /// Predicts real cuts of this ring from the calibration's photographs.
  void expect_photographs() {
    planned_ = runs_along(intended_);
    std::vector<double> simulated_mm = planned_.front().profile_mm;
    if (simulated_mm.empty())
      monitor_.message(Severity::Warning,
                       "forecast: in the calibrated tissue, the planned cut left no closed ring. This ring is treated "
                       "as an average one");
    if (belief_.rings.size() < belief_.specimens)
      monitor_.message(Severity::Warning,
                       fmt::format("forecast: {} of the calibration's {} specimens have a ring and a "
                                   "photograph; the forecast leaves the others out",
                                   belief_.rings.size(), belief_.specimens));
    for (double& error : simulated_mm) error += scenarios_.tissues.front().bias_mm;
    const RingForecaster forecaster(belief_.rings, true);
    warn_unless_converged(forecaster, monitor_);
    scenarios_.photographs = belief_.rings.size();
    scenarios_.prediction = forecaster.predict(body_.ring(), simulated_mm, scenarios_.own_stiffness_sd);
    const RingPrediction& prediction = scenarios_.prediction;
    require_usable_share(belief_.file, prediction.simulated_share, monitor_);
    residual_.degrees = prediction.degrees;
    residual_.mean_mm = values_at_waypoints(settings_, prediction.residual_mm, intended_, intended_.tumor_edge);
    const std::size_t sectors = prediction.residual_mm.size();
    Eigen::MatrixXd at_waypoints(static_cast<Eigen::Index>(intended_.waypoints.size()),
                                 static_cast<Eigen::Index>(sectors));
    for (std::size_t k = 0; k < sectors; ++k) {
      std::vector<double> one(sectors, 0.0);
      one[k] = 1.0;
      const std::vector<double> share = values_at_waypoints(settings_, one, intended_, intended_.tumor_edge);
      at_waypoints.col(static_cast<Eigen::Index>(k)) =
          Eigen::Map<const Eigen::VectorXd>(share.data(), at_waypoints.rows());
    }
    residual_.covariance_mm2 = at_waypoints * prediction.covariance_mm2 * at_waypoints.transpose();
  }

  [[nodiscard]] std::vector<CutScenario> weighted() const {
    std::vector<CutScenario> list;
    for (const TissueScenario& tissue : scenarios_.tissues) list.push_back({tissue.weight, tissue.bias_mm});
    return list;
  }

  [[nodiscard]] RobustSettings robust_settings() const {
    return {.region = safe_region(settings_),
            .target_mm = settings_.plan.lateral_margin_mm - radius_mm(settings_.tool),
            .kerf_allowance_mm = 0.0,  // an inner edge is where the tissue ends
            .max_probability = request_.max_probability,
            .seed = request_.seed};
  }

  [[nodiscard]] MeasureScenarios measure() {
    return [this](const ToolPath& path) {
      std::vector<std::optional<PathErrors>> errors;
      const RunSetting& middle = scenarios_.settings.front();
      const bool is_planned = key_of(middle, path).digest() == key_of(middle, intended_).digest();
      for (const ScenarioRun& run : is_planned ? planned_ : runs_along(path)) errors.push_back(run.errors);
      return errors;
    };
  }

  [[nodiscard]] CacheKey key_of(const RunSetting& setting, const ToolPath& path) const {
    return CacheKey("scenario_run").add_text(body_.digest()).add(setting).add(unmarked(path));
  }

  /// Returns one run for each tissue: those in the cache, and the others simulated side by side.
  std::vector<ScenarioRun> runs_along(const ToolPath& path) {
    std::vector<ScenarioRun> made;
    std::vector<std::size_t> missing;
    for (const RunSetting& setting : scenarios_.settings) {
      const CacheKey key = key_of(setting, path);
      std::optional<ScenarioRun> kept = cache_.find<ScenarioRun>(slot_of(key), key, monitor_);
      if (!kept) missing.push_back(made.size());
      made.push_back(kept ? std::move(*kept) : ScenarioRun{.setting = setting});
    }
    monitor_.message(Severity::Notice,
                     fmt::format("tissue of the calibration: {} along a path, {} finished already",
                                 made.size() == 1 ? std::string("1 cut") : fmt::format("{} cuts", made.size()),
                                 made.size() - missing.size()));
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
    std::vector<std::size_t> simulated;  // those missing runs whose tissue can be held and stretched
    for (const std::size_t k : missing) {
      const HeldBody* body = held_at(made[k]);
      if (body == nullptr) continue;
      simulated.push_back(k);
      held.push_back(body);
      ToolPath with_edge = path;
      with_edge.tumor_edge = body->plan.tumor_edge;
      tasks.push_back({&body->model,
                       &body->stretched.state,
                       {incision_settings(with_setting(settings_, made[k].setting), path), std::move(with_edge)}});
    }
    std::size_t done = 0;
    simulate_incisions(tasks, workers_, monitor_, [&](std::size_t i, IncisionJobResult result) {
      if (result.incision.outcome == Outcome::Cancelled) return;
      ScenarioRun& run = made[simulated[i]];
      run.problem = result.problem;
      if (run.problem.empty()) measure_into(run, std::move(result.incision), path, *held[i]);
      const CacheKey key = key_of(run.setting, path);
      cache_.keep(slot_of(key), key, run);
      ++done;
    });
    if (done < tasks.size())
      throw Cancelled(fmt::format("the cuts of the calibration's tissue were interrupted with {} of {} cuts to go",
                                  tasks.size() - done, tasks.size()));
  }

  /// Returns the specimen with a scenario's stiffness. Null, with the reason in the run's problem, if it cannot be
  /// stretched.
  const HeldBody* held_at(ScenarioRun& run) {
    try {
      return &body_.with_stiffness(run.setting.stiffness_of_case, workers_, monitor_);
    } catch (const CaseError& error) {
      run.problem = error.what();
      return nullptr;
    }
  }

  /// Measures a cut; leaves the run empty without a closed ring, or with an inner edge that is open at the skin.
  void measure_into(ScenarioRun& run, IncisionResult incision, const ToolPath& followed, const HeldBody& held) const {
    const Case settings = with_setting(settings_, run.setting);
    const SimulatedCut cut = judge(settings, std::move(incision), followed, held.plan, held.model.mesh.tets.size());
    if (!cut.incision.is_closed_loop.value_or(false) || !cut.incision.inner_edge) return;
    Monitor silent;  // any thread may come here
    run.errors = path_errors(settings, cut, held.plan.tumor_edge, silent);
    run.profile_mm =
        error_profile(*cut.incision.inner_edge, cut.incision.final_tumor_edge, profile_of_inner_edge(settings))
            .value_or(std::vector<double>{});
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
  std::vector<ScenarioRun> planned_;  ///< along the intended path
  CutResidual residual_;
};

}  // namespace

void warn_unless_converged(const RingForecaster& forecaster, Monitor& monitor) {
  if (!forecaster.is_converged())
    monitor.message(Severity::Warning, "forecast: the search for its spreads ended before it converged");
}

void require_usable_share(const std::filesystem::path& file, double simulated_share, Monitor& monitor) {
  if (!contains(kUsableShare, simulated_share))
    throw DataError(
        file, "fitted",
        fmt::format("a simulated share of {:.2f} (photographed differences per simulated difference)", simulated_share),
        fmt::format("a share from {} to {}", kUsableShare.least, kUsableShare.most),
        "The simulation predicts nothing about these specimens");
  if (!contains(kLikelyShare, simulated_share))
    monitor.message(
        Severity::Warning,
        fmt::format("forecast: photographed differences are {:.2f} of the simulated ones. The simulation misleads",
                    simulated_share));
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

void describe_scenarios(Visitor& v, ScenarioSet& s) {
  v.begin(
      {"scenarios", "The tissue that the calibration expects, and the differences from it that its photographs show."});
  v({"reference_kpa", "Young's modulus that corresponds to stiffness factor 1.", "kPa"}, s.reference_kpa);
  v({"simulated_force_n", "Pull of the specimen at the case's modulus.", "N"}, s.simulated_force_n);
  v("own_stiffness_sd", s.own_stiffness_sd,
    "Standard deviation of the logarithm of the specimen's stiffness; 0: its pull is known, or none was ever "
    "measured.");
  v("photographs", s.photographs, "Number of photographs of the calibration's specimens.");
  v.derived("simulated_share", s.prediction.simulated_share, "Expected real difference per simulated difference.");
  std::vector<double> sd_mm;
  for (const double variance : s.prediction.covariance_mm2.diagonal()) sd_mm.push_back(std::sqrt(variance));
  v.derived("residual_mm", s.prediction.residual_mm,
            "Expected photographed error minus that of the first tissue, by sector from the start direction on.");
  v.derived("sd_mm", sd_mm, "Scale of Student's distribution of one photograph about residual_mm.");
  v.derived("degrees", s.prediction.degrees, "Degrees of freedom of that distribution.");
  v.derived("unlike", std::vector<std::string>(s.prediction.unlike.begin(), s.prediction.unlike.end()),
            "Covariates, except the outline, outside the photographs' 10th to 90th percentile.");
  v("tissues", s.tissues, "Tissues that were simulated; the first is the expected one.");
  v("settings", s.settings, "Settings with which each tissue was simulated.");
  v.end();
}

void describe(Visitor& v, RobustCorrection& r) {
  RobustCompensation& chosen = r.compensation;
  v("outcome", chosen.outcome, "Whether the path keeps within max_probability.");
  v("max_probability", r.settings.max_probability,
    "Greatest allowed probability of less tissue than the close margin.");
  v({"close_margin_mm", "Clinical cut-off of the tissue left beside the tumour.", "mm"},
    r.settings.region.close_margin_mm);
  v.derived("contour", ContourKind::InnerEdge, "Contour that is measured.");
  v("intended", chosen.intended, "Risk of the intended path.");
  v("corrected", chosen.corrected, "Risk of the corrected path.");
  v("robust", chosen.robust, "Risk of the robust path.");
  v("simulations", chosen.simulations, "Number of simulated cuts: scenarios times paths.");
  describe_scenarios(v, r.scenarios);
  v.bulk("corrected_offset_mm", r.corrected_offset_mm, "Offset of each waypoint of the corrected path.");
}

}  // namespace incise
