#include "laboratory/experiment_advice.hpp"

#include <incise/core/described_json.hpp>
#include <incise/evaluation/forecast_skill.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/report/line_plot.hpp>
#include <incise/workflow/case.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace incise::laboratory {
namespace {

using AdviceJson = nlohmann::ordered_json;

bool is_advice(const AdviceJson& assessment) {
  return assessment.is_object() && assessment.contains("advice");
}

std::optional<double> number_at(const AdviceJson& assessment, const char* pointer) {
  const AdviceJson found = json_part(assessment, pointer);
  return found.is_number() ? std::optional(found.get<double>()) : std::nullopt;
}

std::optional<Interval> interval_at(const AdviceJson& assessment, const std::string& pointer) {
  const AdviceJson ends = json_part(assessment, pointer.c_str());
  if (!ends.is_array()) return std::nullopt;
  return Interval{ends.at(0).get<double>(), ends.at(1).get<double>()};
}

/// @param path  name of the cut in an assessment: intended or corrected.
AdvisedCut advised_cut(const AdviceJson& assessment, const std::string& path, const TrialCut& cut,
                       const TrueCut& known) {
  AdvisedCut result;
  result.p_close_margin = number_at(assessment, ("/p_close_margin/" + path).c_str());
  result.error_80 = interval_at(assessment, "/" + path + "/abs_error_80_mm");
  result.error_95 = interval_at(assessment, "/" + path + "/abs_error_95_mm");
  result.photographed_mm = mean_error_mm(cut);
  result.true_mm = known.mean_abs_error_mm;
  if (known.mean_abs_error_mm) result.least_margin_mm = known.least_margin_mm;
  return result;
}

/// Without a prediction, either cut may be the worse one: the calibration says nothing.
double stated(const std::optional<double>& probability) {
  constexpr double kNothingKnown = 0.5;
  return probability.value_or(kNothingKnown);
}

using StatedProbability = std::optional<double> AdvisedSpecimen::*;
using WhetherWorse = std::optional<bool> (AdvisedSpecimen::*)() const;

std::vector<Forecast> forecasts_of(const std::vector<AdvisedSpecimen>& specimens, bool is_outside_alone,
                                   StatedProbability key = &AdvisedSpecimen::p_worse,
                                   WhetherWorse is_worse = &AdvisedSpecimen::is_worse) {
  std::vector<Forecast> forecasts;
  for (const AdvisedSpecimen& specimen : specimens) {
    if (is_outside_alone && specimen.role != TrialRole::Outside) continue;
    if (const std::optional<bool> worse = (specimen.*is_worse)())
      forecasts.push_back({stated(specimen.*key), *worse, specimen.series});
  }
  return forecasts;
}

AdviceJson auc_json(const std::vector<Forecast>& forecasts) {
  const auto worse = std::count_if(forecasts.begin(), forecasts.end(), [](const Forecast& f) { return f.happened; });
  if (worse == 0 || worse == static_cast<std::ptrdiff_t>(forecasts.size())) return nullptr;
  const RocCurve curve = roc_curve(forecasts);
  AdviceJson points = AdviceJson::array();
  for (const RocPoint& point : curve.points) points.push_back({point.false_alarms, point.caught});
  return {{"area", curve.area},
          {"low", curve.confidence.low},
          {"high", curve.confidence.high},
          {"level", BootstrapSettings{}.level},
          {"worse", curve.happened},
          {"not_worse", curve.did_not},
          {"points", std::move(points)}};
}

AdviceJson close_margin_json(const std::vector<AdvisedSpecimen>& specimens) {
  const double limit_mm = Case{}.close_margin_mm;
  std::vector<Forecast> forecasts;
  for (const AdvisedSpecimen& specimen : specimens) {
    for (const AdvisedCut* cut : {&specimen.planned, &specimen.corrected}) {
      if (cut->p_close_margin && cut->least_margin_mm)
        forecasts.push_back({*cut->p_close_margin, *cut->least_margin_mm < limit_mm, specimen.series});
    }
  }
  if (forecasts.empty()) return nullptr;
  const Reliability found = reliability(forecasts);
  AdviceJson bins = AdviceJson::array();
  for (const ReliabilityBin& bin : found.bins) {
    bins.push_back({{"cuts", bin.forecasts},
                    {"happened", bin.happened},
                    {"stated", bin.mean_said},
                    {"seen", bin.share},
                    {"low", bin.confidence.low},
                    {"high", bin.confidence.high}});
  }
  return {{"close_margin_mm", limit_mm},
          {"cuts", forecasts.size()},
          {"brier_score", found.brier_score},
          {"bins", std::move(bins)}};
}

/// A predicted interval and the photographed value; absent: not predicted, or not measured.
struct Foretold {
  const char* of;
  double level;
  std::optional<Interval> interval;
  std::optional<double> shown;
};

std::array<Foretold, 6> foretold_of(const AdvisedSpecimen& s) {
  std::optional<double> gain;
  if (s.planned.photographed_mm && s.corrected.photographed_mm)
    gain = *s.planned.photographed_mm - *s.corrected.photographed_mm;
  return {{{"planned", 0.80, s.planned.error_80, s.planned.photographed_mm},
           {"planned", 0.95, s.planned.error_95, s.planned.photographed_mm},
           {"corrected", 0.80, s.corrected.error_80, s.corrected.photographed_mm},
           {"corrected", 0.95, s.corrected.error_95, s.corrected.photographed_mm},
           {"gain", 0.80, s.gain_80, gain},
           {"gain", 0.95, s.gain_95, gain}}};
}

/// Returns how often intervals of `assess` contain the photographed values. @pre at least one specimen.
AdviceJson intervals_json(const std::vector<AdvisedSpecimen>& specimens) {
  AdviceJson list = AdviceJson::array();
  const std::array<Foretold, 6> kinds = foretold_of(specimens.front());
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    std::vector<Forecast> held;
    for (const AdvisedSpecimen& specimen : specimens) {
      const Foretold found = foretold_of(specimen)[k];
      if (!found.interval || !found.shown) continue;
      const bool is_held = *found.shown >= found.interval->low && *found.shown <= found.interval->high;
      held.push_back({found.level, is_held, specimen.series});
    }
    if (held.empty()) continue;
    const ReliabilityBin all = reliability(held, 1).bins.front();
    list.push_back({{"of", kinds[k].of},
                    {"level", kinds[k].level},
                    {"cuts", all.forecasts},
                    {"held", all.happened},
                    {"share", all.share},
                    {"low", all.confidence.low},
                    {"high", all.confidence.high}});
  }
  return list;
}

std::string with_area(const char* name, const AdviceJson& area) {
  return fmt::format("{}: {:.2f} ({:.2f} to {:.2f})", name, area.at("area").get<double>(), area.at("low").get<double>(),
                     area.at("high").get<double>());
}

LinePlot roc_plot(const AdviceJson& advice) {
  LinePlot plot;
  const AdviceJson& area = advice.at("auc");
  plot.title =
      fmt::format("Virtual specimens: {} of {} made worse by their correction; area under the curve with 95 % interval",
                  area.at("worse").get<std::size_t>(),
                  area.at("worse").get<std::size_t>() + area.at("not_worse").get<std::size_t>());
  plot.x_label = "false alarms: share of the others at or above a stated probability";
  plot.y_label = "share of the worse ones at or above it";
  const auto add = [&plot](std::string name, const AdviceJson& points) {
    LineSeries series{std::move(name), {}, {}, true};
    for (const AdviceJson& point : points) {
      series.add(point.at(0).get<double>(), point.at(1).get<double>());
    }
    plot.series.push_back(std::move(series));
  };
  add(with_area("pull measured", area), area.at("points"));
  const AdviceJson& withheld = advice.at("auc_without_pull");
  if (withheld.is_object()) add(with_area("pull withheld", withheld), withheld.at("points"));
  plot.series.push_back({"chance", {0.0, 1.0}, {0.0, 1.0}, true});
  return plot;
}

LinePlot reliability_plot(const AdviceJson& margin) {
  LinePlot plot;
  LineSeries seen{"seen, with 95 % interval", {}, {}, false};
  std::string counts;
  for (const AdviceJson& bin : margin.at("bins")) {
    seen.add(bin.at("stated").get<double>(), bin.at("seen").get<double>());
    seen.low.push_back(bin.at("low").get<double>());
    seen.high.push_back(bin.at("high").get<double>());
    counts += fmt::format("{}{} of {}", counts.empty() ? "" : ", ", bin.at("happened").get<std::size_t>(),
                          bin.at("cuts").get<std::size_t>());
  }
  plot.title =
      fmt::format("Virtual cuts: P(margin below {} mm somewhere), Brier score {:.3f}; from left to right seen in {}",
                  margin.at("close_margin_mm").get<double>(), margin.at("brier_score").get<double>(), counts);
  plot.x_label = "stated probability";
  plot.y_label = "share in which it happened";
  plot.series = {std::move(seen), {"as stated", {0.0, 1.0}, {0.0, 1.0}, true}};
  return plot;
}

/// Returns the trials that were assessed and cut twice. Only the bench's truth, never the way a specimen was drawn,
/// decides whether a corrected cut was worse and whether a margin fell below the clinical cut-off.
/// @param truth  folder with the truth of each cut: NAME_planned/cut_truth.json, NAME_corrected, NAME_withheld.
std::vector<AdvisedSpecimen> advised_specimens(const std::vector<Trial>& trials, const std::filesystem::path& truth) {
  std::vector<AdvisedSpecimen> specimens;
  for (const Trial& trial : trials) {
    if (trial.role == TrialRole::Calibrate) continue;
    const std::optional<TrueCut> planned = true_cut(truth, trial, trial.planned, "planned"),
                                 corrected = true_cut(truth, trial, trial.corrected, "corrected");
    const AdviceJson& said = trial.assessment;
    if (!is_advice(said) || !planned || !corrected) continue;
    AdvisedSpecimen specimen{.name = trial.name,
                             .role = trial.role,
                             .kind = trial.kind,
                             .advice = said.at("advice").get<std::string>(),
                             .expected_gain_mm = number_at(said, "/expected_gain_mm/mean"),
                             .gain_80 = interval_at(said, "/expected_gain_mm/middle_80"),
                             .gain_95 = interval_at(said, "/expected_gain_mm/middle_95"),
                             .p_worse = number_at(said, "/p_worse"),
                             .p_worse_if_alike = number_at(said, "/p_worse_if_alike"),
                             .p_worse_if_unlike = number_at(said, "/p_worse_if_unlike"),
                             .p_unlike = number_at(said, "/p_unlike"),
                             .planned = advised_cut(said, "intended", trial.planned, *planned),
                             .corrected = advised_cut(said, "corrected", trial.corrected, *corrected),
                             .p_worse_without_pull = {},
                             .withheld = {}};
    const AdviceJson& without = trial.assessment_without_pull;
    const std::optional<TrueCut> withheld = true_cut(truth, trial, trial.withheld, "withheld");
    if (is_advice(without) && withheld) {
      specimen.p_worse_without_pull = number_at(without, "/p_worse");
      specimen.withheld = advised_cut(without, "corrected", trial.withheld, *withheld);
    }
    specimens.push_back(std::move(specimen));
  }
  return specimens;
}

}  // namespace

std::optional<bool> AdvisedSpecimen::is_worse() const {
  return is_second_worse(planned.true_mm, corrected.true_mm);
}

std::optional<bool> AdvisedSpecimen::is_worse_without_pull() const {
  return withheld ? is_second_worse(planned.true_mm, withheld->true_mm) : std::nullopt;
}

void describe(Visitor& v, AdvisedSpecimen& s) {
  v("specimen", s.name, "Name of the specimen.");
  v.derived("series", s.series,
            "Intervals draw the specimens of one series together; 0: they are taken as independent.");
  v("role", s.role, "Role of the specimen: test or outside.");
  v("kind", s.kind, "Kind of a specimen outside the calibrated range; else empty.");
  v("advice", s.advice, "Advice of `incise assess`.");
  v({"expected_gain_mm", "Expected mean absolute error as planned minus that corrected.", "mm"}, s.expected_gain_mm);
  describe_interval(v, {"gain_80_mm", "Stated middle 80 % of the gain.", "mm"}, s.gain_80);
  describe_interval(v, {"gain_95_mm", "Stated middle 95 % of the gain.", "mm"}, s.gain_95);
  v("p_worse", s.p_worse, "Stated probability that the corrected cut is the worse one.", {0.0, 1.0});
  v("p_worse_if_alike", s.p_worse_if_alike, "p_worse if the calibration holds, by the simulation.", {0.0, 1.0});
  v("p_worse_if_unlike", s.p_worse_if_unlike, "p_worse if the calibration does not hold, by the move alone.",
    {0.0, 1.0});
  v("p_unlike", s.p_unlike, "Probability that the calibration does not hold.", {0.0, 1.0});
  v("planned", s.planned, "The cut as planned.");
  v("corrected", s.corrected, "The corrected cut.");
  v.derived("is_worse", s.is_worse(),
            "Whether the corrected cut is the worse one, by the truth; absent: two open rings.");
  v("p_worse_without_pull", s.p_worse_without_pull, "p_worse if the pull had not been measured.", {0.0, 1.0});
  v("withheld", s.withheld, "The cut corrected without the pull.");
  v.derived("is_worse_without_pull", s.is_worse_without_pull(), "is_worse of the cut corrected without the pull.");
}

AdviceJson advice_scores(const std::vector<AdvisedSpecimen>& specimens) {
  if (specimens.empty()) return nullptr;
  AdviceJson json;
  json["specimen_is"] = "virtual";
  json["advised"] = specimens.size();
  json["worse"] = std::count_if(specimens.begin(), specimens.end(),
                                [](const AdvisedSpecimen& s) { return s.is_worse().value_or(false); });
  json["auc"] = auc_json(forecasts_of(specimens, false));
  json["auc_outside_alone"] = auc_json(forecasts_of(specimens, true));
  for (const auto& [name, part] : {std::pair{"p_worse_if_alike", &AdvisedSpecimen::p_worse_if_alike},
                                   std::pair{"p_worse_if_unlike", &AdvisedSpecimen::p_worse_if_unlike},
                                   std::pair{"p_unlike", &AdvisedSpecimen::p_unlike}}) {
    json["auc_of"][name] = auc_json(forecasts_of(specimens, false, part));
    json["auc_of_outside_alone"][name] = auc_json(forecasts_of(specimens, true, part));
  }
  json["auc_without_pull"] = auc_json(
      forecasts_of(specimens, false, &AdvisedSpecimen::p_worse_without_pull, &AdvisedSpecimen::is_worse_without_pull));
  json["close_margin"] = close_margin_json(specimens);
  json["intervals"] = intervals_json(specimens);
  json["specimens"] = to_json(specimens);
  return json;
}

AdviceJson hold_advice_against_truth(const std::vector<Trial>& trials, const std::filesystem::path& truth) {
  const std::vector<AdvisedSpecimen> specimens = advised_specimens(trials, truth);
  AdviceJson json = advice_scores(specimens);
  if (json.is_null()) return json;
  json["skipped"] = AdviceJson::array();
  for (const Trial& trial : trials) {
    const bool is_advised = std::any_of(specimens.begin(), specimens.end(),
                                        [&trial](const AdvisedSpecimen& s) { return s.name == trial.name; });
    if (trial.role != TrialRole::Calibrate && !is_advised)
      json["skipped"].push_back({{"specimen", trial.name}, {"kind", trial.kind}, {"ended_at", refusals_of(trial)}});
  }
  return json;
}

void draw_advice(const std::filesystem::path& folder, const AdviceJson& advice) {
  if (advice.at("auc").is_object()) write_atomically(folder / "roc.svg", line_plot_svg(roc_plot(advice)));
  if (advice.at("close_margin").is_object())
    write_atomically(folder / "reliability.svg", line_plot_svg(reliability_plot(advice.at("close_margin"))));
}

}  // namespace incise::laboratory
