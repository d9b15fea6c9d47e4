#include "power_output.hpp"

#include <incise/core/described_json.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_text.hpp>
#include <incise/report/line_plot.hpp>
#include <incise/storage/bench_files.hpp>
#include <incise/storage/power_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace incise::cli {
namespace {

using PowerJson = nlohmann::ordered_json;

constexpr const char* kVirtualCuts = "Cuts of incise's virtual bench: no real tissue.";

/// One measure of all cuts against power or speed: a mark for each cut, the greatest as a line, and the limit.
struct MeasurePlot {
  const char* file;
  const char* title;
  const char* x_label;
  const char* y_label;
  double PowerCut::*x;
  std::optional<double> PowerCut::*y;
  double limit_mm;
};

/// @returns whether there was anything to draw.
bool write_plot(const std::filesystem::path& folder, const MeasurePlot& what, const std::vector<PowerCut>& cuts) {
  LineSeries marks{"each specimen", {}, {}, false};
  LineSeries line{"greatest", {}, {}, true};
  std::map<double, double> greatest;
  for (const PowerCut& cut : cuts) {
    const std::optional<double>& y = cut.*what.y;
    if (!y) continue;
    marks.x.push_back(cut.*what.x);
    marks.y.push_back(*y);
    const auto [at, is_first] = greatest.emplace(cut.*what.x, *y);
    if (!is_first) at->second = std::max(at->second, *y);
  }
  if (marks.x.empty()) return false;
  for (const auto& [x, y] : greatest) {
    line.x.push_back(x);
    line.y.push_back(y);
  }
  const double first = greatest.begin()->first;
  const double last = greatest.rbegin()->first;
  const double beside = first < last ? 0.0 : 0.1 * first;  // one place alone: the limit is still a line
  const LineSeries limit{"limit", {first - beside, last + beside}, {what.limit_mm, what.limit_mm}, true};
  const LinePlot plot{
      .title = what.title, .x_label = what.x_label, .y_label = what.y_label, .series = {marks, line, limit}};
  write_atomically(folder / what.file, line_plot_svg(plot));
  return true;
}

void write_figures(const std::filesystem::path& folder, const PowerResult& result) {
  const PowerLimits& limits = result.request.limits;
  constexpr const char* kBulge = "height of skin ahead of the tool, mm";
  constexpr const char* kPower = "power of the generator, W";
  std::vector<std::pair<MeasurePlot, const std::vector<PowerCut>*>> plots;
  plots.push_back({{"bulge.svg", "Bulge against power (virtual specimens)", kPower, kBulge, &PowerCut::power_w,
                    &PowerCut::bulge_mm, limits.bulge_limit_mm},
                   &result.series.cuts});
  plots.push_back(
      {{"heat.svg", "Thermal damage against power (virtual specimens)", kPower, "width of 60 °C beside the axis, mm",
        &PowerCut::power_w, &PowerCut::thermal_width_mm, limits.damage_limit_mm},
       &result.series.cuts});
  plots.push_back(
      {{"speed.svg", "Bulge against speed at the chosen power (virtual specimens)", "speed of the tool, mm/s", kBulge,
        &PowerCut::speed_mm_s, &PowerCut::bulge_mm, limits.bulge_limit_mm},
       &result.series.speed_cuts});
  for (const auto& [plot, cuts] : plots) {
    if (!write_plot(folder, plot, *cuts)) std::filesystem::remove(folder / plot.file);  // none of an earlier run stays
  }
}

/// All that was asked for, defaults included.
std::string settings_of_power(const PowerResult& result) {
  PowerJson json = to_json(result.request);
  for (const PowerSubject& subject : result.subjects) json["specimens"][subject.name] = specimen_json(subject.specimen);
  return json.dump();
}

std::string mm_or_dash(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : std::string("-");
}

}  // namespace

PowerJson json_of(const PowerResult& result) {
  PowerJson json;
  json["schema"] = "incise.power/1";
  json["virtual"] = true;
  json["note"] = kVirtualCuts;
  json.update(to_json(result.series));
  json["speed_estimate"] = result.speed ? to_json(*result.speed) : PowerJson(nullptr);
  json["cuts_made"] = result.series.made;
  json["wall_s"] = result.wall_s;
  return json;
}

void write_power(const std::filesystem::path& folder, const PowerResult& result,
                 const std::vector<std::filesystem::path>& inputs, const CommonOptions& options) {
  const std::string table = csv_text(power_table(result.series));
  write_atomically(folder / "power.csv", table);
  write_figures(folder, result);
  write_manifest(folder, laboratory::manifest_of(options.context(), settings_of_power(result), inputs, result.wall_s));
  write_json(folder / "power.json", json_of(result));
}

void print_power(const CommonOptions& options, const PowerResult& result, const std::filesystem::path& folder) {
  if (options.json) return print_result(options, json_of(result));
  if (result.speed) print_speed(*result.speed);
  fmt::print("{}\n{:>8} {:>12} {:>12}\n", kVirtualCuts, "W", "bulge, mm", "heat, mm");
  for (const PowerVerdict& verdict : result.series.choice.powers) {
    const std::string against = verdict.reasons.empty() ? "fits" : verdict.reasons.front();
    fmt::print("{:>8} {:>12} {:>12}   {}\n", verdict.power_w, mm_or_dash(verdict.greatest_bulge_mm),
               mm_or_dash(verdict.greatest_thermal_width_mm), against);
    for (std::size_t i = 1; i < verdict.reasons.size(); ++i) fmt::print("{:>36}{}\n", "", verdict.reasons[i]);
  }
  if (result.series.choice.chosen_w)
    fmt::print("chosen: {} W at {} mm/s\n", *result.series.choice.chosen_w, result.request.speed_mm_s);
  else
    fmt::print("no power fits\n");
  for (const PowerCut& cut : result.series.speed_cuts) {
    fmt::print("{:>8} mm/s   {}: bulge {} mm, heat {} mm, error {} mm, {}\n", cut.speed_mm_s, cut.specimen,
               mm_or_dash(cut.bulge_mm), mm_or_dash(cut.thermal_width_mm), mm_or_dash(cut.mean_abs_error_mm),
               to_string(cut.outcome));
  }
  fmt::print("everything: {}\n", (folder / "power.json").string());
}

void print_speed(const SpeedEstimate& speed) {
  fmt::print("{} timed cuts: {:.2f} mm/s, sd {:.2f} (n) or {} (n - 1), {:.2f} to {:.2f}; recommended {} mm/s\n",
             speed.cuts, speed.mean_mm_s, speed.population_sd_mm_s, mm_or_dash(speed.sample_sd_mm_s), speed.min_mm_s,
             speed.max_mm_s, speed.recommended_mm_s);
}

}  // namespace incise::cli
