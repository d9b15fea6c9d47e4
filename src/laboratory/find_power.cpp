#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/entry_folder.hpp>
#include <incise/io/json_file.hpp>
#include <incise/laboratory/bench_files.hpp>
#include <incise/laboratory/bench_steps.hpp>
#include <incise/laboratory/power_file.hpp>
#include <incise/report/line_plot.hpp>
#include <incise/steps/case_steps.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

namespace incise::laboratory {
namespace {

using PowerJson = nlohmann::ordered_json;

constexpr std::uint64_t kPapersTongues = 4;

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
    marks.add(cut.*what.x, *y);
    const auto [at, is_first] = greatest.emplace(cut.*what.x, *y);
    if (!is_first) at->second = std::max(at->second, *y);
  }
  if (marks.x.empty()) return false;
  for (const auto& [x, y] : greatest) {
    line.add(x, y);
  }
  const double first = greatest.begin()->first;
  const double last = greatest.rbegin()->first;
  const double beside = first < last ? 0.0 : 0.1 * first;  // a single x: the limit is still a line
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
    if (!write_plot(folder, plot, *cuts)) std::filesystem::remove(folder / plot.file);  // of an earlier run
  }
}

/// Returns all settings, defaults included.
std::string settings_of_power(const PowerResult& result) {
  PowerJson json = to_json(result.request);
  for (const PowerSubject& subject : result.subjects) json["specimens"][subject.name] = specimen_json(subject.specimen);
  return json.dump();
}

PowerJson json_of(const PowerResult& result) {
  PowerJson json;
  json["schema"] = "incise.power/1";
  json["virtual"] = true;
  json["note"] = kVirtualCuts;
  json.update(to_json(result.series));
  json["speed_estimate"] = to_json(result.speed);
  json["cuts_made"] = result.series.made;
  json["wall_s"] = result.wall_s;
  return json;
}

void write_power(const std::filesystem::path& folder, const PowerResult& result,
                 const std::vector<std::filesystem::path>& inputs, const RunContext& run) {
  const std::string table = csv_text(power_table(result.series));
  write_atomically(folder / "power.csv", table);
  write_figures(folder, result);
  write_manifest(folder, steps::manifest_of(run, settings_of_power(result), inputs, result.wall_s));
  write_json(folder / "power.json", json_of(result));
}

std::vector<PowerSubject> subjects_of(const PowerStepRequest& request, std::uint64_t seed) {
  if (!request.files.empty() && request.specimens) {
    throw CaseError("command line", "--specimens", fmt::format("{} together with specimen files", *request.specimens),
                    "either files or a number of specimens to draw");
  }
  std::vector<PowerSubject> subjects;
  for (const std::filesystem::path& file : request.files) {
    const Specimen specimen = read_specimen(file);
    for (std::size_t i = 0; i < subjects.size(); ++i) {
      if (!(subjects[i].specimen == specimen)) continue;
      throw CaseError("command line", "specimen", fmt::format("{}, the same as {}", file.string(), subjects[i].name),
                      "every specimen once");
    }
    subjects.push_back({file.string(), specimen});
  }
  if (!subjects.empty()) return subjects;
  for (std::uint64_t i = 0; i < request.specimens.value_or(kPapersTongues); ++i)
    subjects.push_back({fmt::format("seed {}", seed + i), draw_specimen(seed + i)});
  return subjects;
}

std::optional<SpeedEstimate> speed_of(const PowerStepRequest& request) {
  if (!request.timed_cuts.empty()) return estimate_speed(read_timed_cuts(request.timed_cuts));
  if (!request.only_speed) return std::nullopt;
  throw CaseError("command line", "--only-speed", "no timed cuts", "--timed-cuts FILE.csv");
}

void make_output(const std::filesystem::path& folder) {
  make_folder(folder);
  steps::require_own_or_empty(folder, {"power.json", "cache"}, "a series");
  require_writable(folder / "power.json");
}

}  // namespace

PowerResult find_power(const PowerStepRequest& asked, const steps::StepContext& context) {
  PowerResult result;
  result.speed = speed_of(asked);
  if (asked.only_speed) {
    result.step.json = {{"verdict", "speed_only"}, {"chosen_w", nullptr}, {"speed_estimate", to_json(*result.speed)}};
    return result;
  }
  result.request = asked.series;
  if (asked.speed_mm_s)
    result.request.speed_mm_s = *asked.speed_mm_s;
  else if (result.speed)
    result.request.speed_mm_s = result.speed->recommended_mm_s;
  const std::vector<Problem> problems = validate(result.request);
  if (!problems.empty()) throw CaseError("power", problems.front());
  result.subjects = subjects_of(asked, context.run.seed);
  std::vector<std::filesystem::path> inputs = asked.files;
  if (!asked.timed_cuts.empty()) inputs.push_back(asked.timed_cuts);
  steps::with_parts_kept(asked.output, [&] {
    make_output(asked.output);
    Cache cuts(std::make_unique<EntryFolder>(asked.output / "cache"));
    result.series = run_power_series(result.subjects, result.request, cuts, context.workers, context.monitor);
    result.wall_s = context.wall_s();
    write_power(asked.output, result, inputs, context.run);
    result.step = {json_of(result), result.series.choice.chosen_w.has_value()};
  });
  return result;
}

}  // namespace incise::laboratory
