#include <incise/calibration/calibration.hpp>
#include <incise/calibration/ring_profiles.hpp>
#include <incise/mechanics/material.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr double kWeightTolerance = 1e-6;
constexpr Range kForceN{1e-6, 1e6};

/// Figures of one specimen in a row.
struct RunFigures {
  const std::string& name;
  const CalibrationRun& run;
};
std::optional<double> mean_of(const std::optional<Summary>& summary) {
  return summary ? std::optional(summary->mean) : std::nullopt;
}
void describe(Visitor& v, RunFigures& f) {
  const std::optional<Summary>& errors = f.run.paper_abs_error_mm;
  v.derived("name", f.name, "Name of the specimen.");
  v.derived("outcome", f.run.outcome, "How the cut ended.");
  v.derived("failure", f.run.is_failure(), "Whether the cut failed in the paper's sense.");
  if (!f.run.problem.empty()) v.derived("problem", f.run.problem, "Why the cut could not be carried out.");
  v.derived("stiffness_of_case", f.run.setting.stiffness_of_case, "Young's modulus over that of the case.");
  v.derived("mean_abs_mm", mean_of(errors), "Mean |error| as the paper takes it.");
  v.derived("sd_abs_mm", errors ? std::optional(errors->sd) : std::nullopt, "Standard deviation of that |error|.");
  v.derived("max_abs_mm", errors ? std::optional(errors->max) : std::nullopt, "Greatest value of that |error|.");
  v.derived("mean_signed_mm", mean_of(f.run.signed_error_mm), "Mean signed error of the mid-line.");
  v.derived("mean_inner_signed_mm", mean_of(f.run.inner_signed_error_mm), "Mean signed error of the inner edge.");
  v.derived("tets", f.run.tets, "Number of tets before the cut.");
  v.derived("wall_s", f.run.wall_s, "Time that the simulation took.");
}

/// A row of the table, specimen by specimen.
struct RowFigures {
  const Calibration& calibration;
  const ScoreRow& row;
};
void describe(Visitor& v, RowFigures& f) {
  const ScoreRow& row = f.row;
  const RunSetting& setting = row.setting;
  v.derived("speed_mm_s", setting.speed_mm_s, "Speed of the simulated tool.");
  v.derived("dullness", setting.dullness, "Contact needed before a tet is removed, in reference steps.");
  v.derived("drag_length_mm", setting.speed_mm_s * setting.dullness * f.calibration.reference_step_s,
            "Speed times dwell: how far the tool travels while it holds a tet.");
  v.derived("failure", row.is_failure, "Whether at least one specimen failed.");
  v.derived("mean_abs_mm", row.mean_abs_mm, "Mean of the specimens' mean |error|.");
  v.derived("sd_abs_mm", row.sd_abs_mm, "Mean of their standard deviations.");
  v.derived("max_abs_mm", row.max_abs_mm, "Greatest |error| of any specimen that did not fail.");
  v.derived("mean_signed_mm", row.mean_signed_mm, "Mean signed error of the mid-lines.");
  v.derived("mean_inner_signed_mm", row.mean_inner_signed_mm, "Mean signed error of the inner edges.");
  v.derived("score_percent", row.percent, "Score in per cent of the baseline; 0 for a failure.");
  v.derived("inner_edge_score_percent", row.inner_percent,
            "Score of the inner edges against those of the photographs.");
  v.derived("inner_edge_specimens", row.inner_specimens, "Number of specimens whose inner edges count.");
  v.begin_list({"specimens"}, f.calibration.specimens.size(), 1);
  for (const CalibratedSpecimen& specimen : f.calibration.specimens) {
    RunFigures run{specimen.name, specimen.runs[row.run]};
    v(Field{}, run);
  }
  v.end_list();
}

void describe_parameter(Visitor& v, const Field& field, ParameterEstimate& estimate, ParameterVerdict& verdict) {
  v.begin(field);
  describe(v, estimate);
  describe(v, verdict);
  v.end();
}

void describe_parameters(Visitor& v, DragFit& fit, Identifiability& told) {
  describe_parameter(v, {"drag_length_mm", "Speed times dwell: how far the tool travels while it holds a tet.", "mm"},
                     fit.drag_length_mm, told.parameters[0]);
  describe_parameter(v, {"ln_stiffness_factor", "Logarithm of the stiffness over the reference."}, fit.ln_stiffness,
                     told.parameters[1]);
  describe_parameter(v, {"bias_mm", "To be added to simulated signed errors.", "mm"}, fit.bias_mm, told.parameters[2]);
  v.derived("stiffness_varied", fit.knows_stiffness, "Whether a second stiffness was cut for every specimen.");
  v.derived("correlation", fit.correlation, "Correlations of the three, in this order.");
}

/// A reader needs the samples, the residual and, to forecast the next ring, the fitted errors.
void describe_fit(Visitor& v, DragFit& fit, Identifiability& told) {
  v.begin({"posterior"});
  if (!v.sets()) describe_parameters(v, fit, told);
  v("samples", fit.samples, "Samples of the posterior.");
  double sum = 0.0;
  for (const PosteriorSample& sample : fit.samples) sum += sample.weight;
  if (v.sets() && (fit.samples.empty() || std::abs(sum - 1.0) > kWeightTolerance))
    v.refuse({"samples"}, fmt::format("weights that add up to {}", sum), "weights that add up to 1");
  v.end();
  v("residual", fit.residual, "Difference between photograph and simulation that the fit leaves.");
  std::optional<std::vector<SpecimenFit>> fitted = fit.specimens;
  v("fitted", fitted, "The fit, specimen by specimen.");
  if (v.sets()) fit.specimens = fitted.value_or(std::vector<SpecimenFit>{});
  v.derived("identifiability", told.sentences, "Which parameters the data identify, in sentences.");
  if (v.sets() || fit.specimens.empty()) return;  // a file of version 0.1.0 has none
  v.derived("photographed_profile", photographed_profile(fit.specimens),
            "Forecast of the next cut from photographs alone.");
  v.derived("residual_profile", residual_profile(fit), "What photographs show beyond the simulation and its bias.");
}
/// The fitted specimens of a file must be those of the calibration, with errors that a photograph can have.
void require_fitted_specimens(const Visitor& v, const Calibration& calibration) {
  const std::vector<SpecimenFit>& fitted = calibration.fit->specimens;
  if (fitted.empty()) return;
  const std::size_t count = calibration.specimens.size();
  if (fitted.size() != count)
    v.refuse({"fitted"}, fmt::format("{} specimens", fitted.size()),
             fmt::format("{}, one for each of specimens", count));
  for (std::size_t i = 0; i < count; ++i) {
    const std::string place = fmt::format("fitted/{}", i);
    const SpecimenFit& one = fitted[i];
    if (one.name != calibration.specimens[i].name)
      v.refuse({place + "/name"}, one.name, calibration.specimens[i].name + ", as in specimens");
    if (one.observed_mm.empty() || one.fitted_mm.size() != one.observed_mm.size())
      v.refuse({place + "/fitted_mm"}, fmt::format("{} numbers", one.fitted_mm.size()),
               fmt::format("as many as observed_mm, {}, and at least one", one.observed_mm.size()));
    if (const double mean = difference_mm(one); !contains(kAnatomyErrorMm, mean))
      v.refuse({place + "/observed_mm"}, fmt::format("a mean difference of {:.3g} mm from fitted_mm", mean),
               "millimetres");
  }
}

}  // namespace

void describe(Visitor& v, CalibratedSpecimen& s) {
  v("name", s.name, "Name of the specimen.");
  v.derived("photographed_mean_abs_mm", s.photographed.mean_mm, "Mean |error| of the photograph.");
  v.derived("photographed_max_abs_mm", s.photographed.max_mm, "Greatest |error| of the photograph.");
  v({"photographed_mean_signed_mm", "Mean signed error of the photograph.", "mm"}, s.signed_mean_mm, kAnatomyErrorMm);
  v({"moved_mean_mm",
     "Mean distance by which the path that was cut lies outside the planned one; none: the planned path was cut.",
     "mm"},
    s.moved_mean_mm, kAnatomyErrorMm);
  v({"youngs_modulus_kpa", "Reference Young's modulus: the case's, or the one that the measured pull implies.", "kPa"},
    s.youngs_modulus_kpa, {kLeastYoungsModulusKpa, kMostYoungsModulusKpa});
  v({"stretch_force_n", "Measured pull.", "N"}, s.stretch_force_n, kForceN);
  v({"simulated_force_n", "Pull of the simulated specimen.", "N"}, s.simulated_force_n, {0.0, kForceN.most});
  std::optional<double> stretch_mm = s.stretch_mm;
  v({"stretch_mm", "How far the specimen's end was displaced.", "mm"}, stretch_mm, {0.0, kAnatomyMm.most});
  s.stretch_mm = stretch_mm.value_or(0.0);
  v("registration", s.registration, "How well the simulated surface lies on the measured one.");
  v("ring", s.ring, "Covariates of the ring, the tissue and the cut.");
  v.derived("picture_turn_deg", s.picture.turn_deg, "Turn of the photograph.");
  v.derived("picture_rms_mm", s.picture.rms_mm, "Root mean square of the distances that remain between the edges.");
  v.bulk("held", s.held, "Digest of the held specimen.");
  v.bulk("runs", s.runs, "Simulated cuts of the specimen.");
  v.derived("read_by_midline", s.read_by_midline, "Runs whose ring closed, but not at the skin.");
}

void describe(Visitor& v, Calibration& c) {
  constant(v, {"schema", "Format and version of this file."}, "incise.calibration/1");
  v("method", c.method, "Method of the calibration.");
  v("virtual", c.is_virtual, "Whether at least one specimen is virtual.");
  const bool has_chosen = v.optional({"chosen"}, c.chosen.has_value());
  if (v.sets()) c.chosen = has_chosen ? std::optional(RunSetting{}) : std::nullopt;
  if (has_chosen) {
    v.begin({"chosen", "Settings with which a simulated ring matches the photographed one."});
    describe(v, *c.chosen);
    v.derived("drag_length_mm", c.chosen->speed_mm_s * c.chosen->dullness * c.reference_step_s,
              "Speed times dwell: how far the tool travels while it holds a tet.");
    v.end();
  }
  v("score_percent", c.score_percent, "Score of the chosen settings.");
  v({"baseline_mm", "0.75 mean + 0.25 max of the photographed errors.", "mm"}, c.table.baseline_mm, kAnatomyMm);
  v({"reference_step_s", "The time that one unit of dullness represents.", "s"}, c.reference_step_s, {1e-6, 1.0});
  v("cut_rule", c.cut_rule, "Rule of the simulated cuts (cut.rule).");
  v.derived("simulations", c.simulations, "Number of simulations.");
  v.derived("verdict", c.verdict, "Verdict on the photographs.");
  v("specimens", c.specimens, "Specimens to which the simulation is calibrated.");
  v.derived("left_out", c.left_out, "Specimens that the fit could not use.");
  const bool has_fit = v.optional({"posterior"}, c.fit.has_value());
  if (v.sets()) {
    c.fit = has_fit ? std::optional(DragFit{}) : std::nullopt;
    c.identifiability = has_fit ? std::optional(Identifiability{}) : std::nullopt;
  }
  if (has_fit) {
    describe_fit(v, *c.fit, *c.identifiability);
    if (v.sets()) require_fitted_specimens(v, c);
  }
  if (v.sets()) {
    const bool is_fit = c.method == CalibrationMethod::Fit;
    if (is_fit && !has_fit) v.refuse({"posterior"}, "null", "the posterior of a fit");
    return;
  }
  v.begin_list({"rows", "The table, setting by setting."}, c.table.rows.size(), 1);
  for (const ScoreRow& row : c.table.rows) {
    RowFigures figures{c, row};
    v(Field{}, figures);
  }
  v.end_list();
}

double difference_mm(const SpecimenFit& fitted) {
  double sum = 0.0;
  for (std::size_t i = 0; i < fitted.observed_mm.size(); ++i) sum += fitted.observed_mm[i] - fitted.fitted_mm[i];
  return sum / static_cast<double>(fitted.observed_mm.size());
}

bool is_usable(const Calibration& calibration) {
  if (!calibration.fit) return calibration.score_percent.value_or(0.0) > 0.0;
  const std::vector<SpecimenFit>& specimens = calibration.fit->specimens;
  const auto closed =
      std::count_if(specimens.begin(), specimens.end(), [](const SpecimenFit& s) { return !s.simulated_mm.empty(); });
  return 2 * closed > static_cast<std::ptrdiff_t>(specimens.size() + calibration.left_out.size());
}

}  // namespace incise
