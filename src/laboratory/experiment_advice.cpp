#include "laboratory/experiment_advice.hpp"

#include <incise/evaluation/forecast_skill.hpp>
#include <incise/imaging/photo_contours.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/report/line_plot.hpp>
#include <incise/workflow/case.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <ostream>

namespace incise::laboratory {
namespace {

using AdviceJson = nlohmann::ordered_json;

/// What really happened in one cut.
struct TrueCut {
  std::optional<double> mean_abs_error_mm;  ///< absent: the ring stayed open
  double least_margin_mm = 0.0;             ///< of a closed one
};

/// Nothing where this run made no such cut, whatever an earlier one left there.
std::optional<TrueCut> true_cut(const std::filesystem::path& truth, const Trial& trial, const TrialCut& cut,
                                const char* name) {
  if (!cut.is_made) return std::nullopt;
  const std::filesystem::path file = truth / fmt::format("{}_{}", trial.name, name) / "cut_truth.json";
  const AdviceJson json = read_json(file);
  TrueCut result;
  if (!json.contains("mean_abs_error_mm")) return result;
  result.mean_abs_error_mm = json.at("mean_abs_error_mm").get<double>();
  const auto errors = json.at("signed_errors_mm").get<std::vector<double>>();
  result.least_margin_mm = json.at("target_mm").get<double>() + *std::min_element(errors.begin(), errors.end());
  return result;
}

/// A specimen that was advised on and cut twice.
struct AdvisedSpecimen {
  const Trial* trial = nullptr;
  TrueCut planned, corrected;
  std::optional<TrueCut> withheld;  ///< corrected without the pull; absent: not asked for, or refused
};

std::optional<double> gain_mm(const TrueCut& planned, const TrueCut& again) {
  if (!planned.mean_abs_error_mm || !again.mean_abs_error_mm) return std::nullopt;
  return *planned.mean_abs_error_mm - *again.mean_abs_error_mm;
}

std::optional<bool> is_worse(const TrueCut& planned, const TrueCut& again) {
  return is_second_worse(planned.mean_abs_error_mm, again.mean_abs_error_mm);
}

bool is_advice(const AdviceJson& assessment) {
  return assessment.is_object() && assessment.contains("advice");
}

/// One of the probabilities of `assess`. Where nothing could be predicted, either cut may be the worse one, and the
/// calibration says nothing.
double stated(const AdviceJson& assessment, const char* key) {
  constexpr double kNothingKnown = 0.5;
  return assessment.contains(key) && assessment.at(key).is_number() ? assessment.at(key).get<double>() : kNothingKnown;
}

std::vector<Forecast> forecasts_with_pull(const std::vector<AdvisedSpecimen>& specimens, bool is_outside_alone,
                                          const char* key = "p_worse") {
  std::vector<Forecast> forecasts;
  for (const AdvisedSpecimen& specimen : specimens) {
    if (is_outside_alone && specimen.trial->role != TrialRole::Outside) continue;
    const std::optional<bool> worse = is_worse(specimen.planned, specimen.corrected);
    if (worse) forecasts.push_back({stated(specimen.trial->assessment, key), *worse});
  }
  return forecasts;
}

std::vector<Forecast> forecasts_without_pull(const std::vector<AdvisedSpecimen>& specimens) {
  std::vector<Forecast> forecasts;
  for (const AdvisedSpecimen& specimen : specimens) {
    const AdviceJson& said = specimen.trial->assessment_without_pull;
    if (!is_advice(said) || !specimen.withheld) continue;
    const std::optional<bool> worse = is_worse(specimen.planned, *specimen.withheld);
    if (worse) forecasts.push_back({stated(said, "p_worse"), *worse});
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
    for (const auto& [path, cut] :
         {std::pair("intended", &specimen.planned), std::pair("corrected", &specimen.corrected)}) {
      const AdviceJson& stated = specimen.trial->assessment.value("p_close_margin", AdviceJson());
      if (!cut->mean_abs_error_mm || !stated.is_object() || !stated.at(path).is_number()) continue;
      forecasts.push_back({stated.at(path).get<double>(), cut->least_margin_mm < limit_mm});
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

/// What a photograph shows of one thing that was foretold; nothing: it was not measured.
using Shown = std::optional<double> (*)(const Trial&);
struct ForetoldInterval {
  const char* of;
  Shown shown;
  const char* middle_80;  ///< where an assessment has it
  const char* middle_95;
};
constexpr ForetoldInterval kForetold[] = {
    {"planned", [](const Trial& trial) { return mean_error_mm(trial.planned); }, "/intended/abs_error_80_mm",
     "/intended/abs_error_95_mm"},
    {"corrected", [](const Trial& trial) { return mean_error_mm(trial.corrected); }, "/corrected/abs_error_80_mm",
     "/corrected/abs_error_95_mm"},
    {"gain",
     [](const Trial& trial) -> std::optional<double> {
       const auto before = mean_error_mm(trial.planned), after = mean_error_mm(trial.corrected);
       return before && after ? std::optional(*before - *after) : std::nullopt;
     },
     "/expected_gain_mm/middle_80", "/expected_gain_mm/middle_95"}};

/// How often intervals of `assess` hold what photographs then show.
AdviceJson intervals_json(const std::vector<AdvisedSpecimen>& specimens) {
  AdviceJson list = AdviceJson::array();
  for (const ForetoldInterval& foretold : kForetold) {
    for (const auto& [level, pointer] : {std::pair(0.80, foretold.middle_80), std::pair(0.95, foretold.middle_95)}) {
      std::vector<Forecast> held;
      for (const AdvisedSpecimen& specimen : specimens) {
        const std::optional<double> shown = foretold.shown(*specimen.trial);
        const AdviceJson ends = specimen.trial->assessment.value(AdviceJson::json_pointer(pointer), AdviceJson());
        if (!shown || !ends.is_array()) continue;
        held.push_back({level, *shown >= ends.at(0).get<double>() && *shown <= ends.at(1).get<double>()});
      }
      if (held.empty()) continue;
      const ReliabilityBin all = reliability(held, 1).bins.front();
      list.push_back({{"of", foretold.of},
                      {"level", level},
                      {"cuts", all.forecasts},
                      {"held", all.happened},
                      {"share", all.share},
                      {"low", all.confidence.low},
                      {"high", all.confidence.high}});
    }
  }
  return list;
}

AdviceJson specimen_json(const AdvisedSpecimen& specimen) {
  const auto or_null = [](const auto& value) { return value ? AdviceJson(*value) : AdviceJson(nullptr); };
  const AdviceJson& said = specimen.trial->assessment;
  AdviceJson json{{"specimen", specimen.trial->name},
                  {"role", to_string(specimen.trial->role)},
                  {"kind", specimen.trial->kind},
                  {"advice", said.value("advice", AdviceJson())},
                  {"expected_gain_mm", said.value("expected_gain_mm", AdviceJson())},
                  {"p_worse", said.value("p_worse", AdviceJson())},
                  {"p_worse_if_alike", said.value("p_worse_if_alike", AdviceJson())},
                  {"p_worse_if_unlike", said.value("p_worse_if_unlike", AdviceJson())},
                  {"p_unlike", said.value("p_unlike", AdviceJson())},
                  {"true_planned_mm", or_null(specimen.planned.mean_abs_error_mm)},
                  {"true_corrected_mm", or_null(specimen.corrected.mean_abs_error_mm)},
                  {"true_gain_mm", or_null(gain_mm(specimen.planned, specimen.corrected))},
                  {"is_worse", or_null(is_worse(specimen.planned, specimen.corrected))}};
  if (is_advice(specimen.trial->assessment_without_pull) && specimen.withheld) {
    json["p_worse_without_pull"] = specimen.trial->assessment_without_pull.value("p_worse", AdviceJson());
    json["true_withheld_mm"] = or_null(specimen.withheld->mean_abs_error_mm);
    json["is_worse_without_pull"] = or_null(is_worse(specimen.planned, *specimen.withheld));
  }
  return json;
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
      series.x.push_back(point.at(0).get<double>());
      series.y.push_back(point.at(1).get<double>());
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
    seen.x.push_back(bin.at("stated").get<double>());
    seen.y.push_back(bin.at("seen").get<double>());
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

void write_svg(const std::filesystem::path& file, const LinePlot& plot) {
  const std::string svg = line_plot_svg(plot);
  write_atomically(file, [&svg](std::ostream& out) { out << svg; });
}

}  // namespace

AdviceJson hold_advice_against_truth(const std::vector<Trial>& trials, const std::filesystem::path& truth) {
  std::vector<AdvisedSpecimen> specimens;
  AdviceJson skipped = AdviceJson::array();
  for (const Trial& trial : trials) {
    if (trial.role == TrialRole::Calibrate) continue;
    const std::optional<TrueCut> planned = true_cut(truth, trial, trial.planned, "planned"),
                                 corrected = true_cut(truth, trial, trial.corrected, "corrected");
    if (is_advice(trial.assessment) && planned && corrected)
      specimens.push_back({&trial, *planned, *corrected, true_cut(truth, trial, trial.withheld, "withheld")});
    else
      skipped.push_back({{"specimen", trial.name}, {"kind", trial.kind}, {"ended_at", refusals_of(trial)}});
  }
  if (specimens.empty()) return nullptr;
  AdviceJson json;
  json["specimen_is"] = "virtual";
  json["advised"] = specimens.size();
  json["worse"] = std::count_if(specimens.begin(), specimens.end(), [](const AdvisedSpecimen& s) {
    return is_worse(s.planned, s.corrected).value_or(false);
  });
  json["auc"] = auc_json(forecasts_with_pull(specimens, false));
  json["auc_outside_alone"] = auc_json(forecasts_with_pull(specimens, true));
  for (const char* part :
       {"p_worse_if_alike", "p_worse_if_unlike", "p_unlike"}) {  // what p_worse is made of, each for itself
    json["auc_of"][part] = auc_json(forecasts_with_pull(specimens, false, part));
    json["auc_of_outside_alone"][part] = auc_json(forecasts_with_pull(specimens, true, part));
  }
  json["auc_without_pull"] = auc_json(forecasts_without_pull(specimens));
  json["close_margin"] = close_margin_json(specimens);
  json["intervals"] = intervals_json(specimens);
  json["specimens"] = AdviceJson::array();
  for (const AdvisedSpecimen& specimen : specimens) json["specimens"].push_back(specimen_json(specimen));
  json["skipped"] = std::move(skipped);
  return json;
}

void write_advice(const std::filesystem::path& folder, const AdviceJson& advice) {
  write_json(folder / "advice.json", advice);
  if (advice.at("auc").is_object()) write_svg(folder / "roc.svg", roc_plot(advice));
  if (advice.at("close_margin").is_object())
    write_svg(folder / "reliability.svg", reliability_plot(advice.at("close_margin")));
}

}  // namespace incise::laboratory
