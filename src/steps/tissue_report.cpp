#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/manifest.hpp>
#include <incise/report/number_text.hpp>
#include <incise/robot/player.hpp>
#include <incise/steps/run_report.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>

namespace incise::steps {
namespace {

using Json = nlohmann::ordered_json;

using Shown = std::array<const char*, 3>;  // key, name, unit

std::string words(const Json& value, std::string_view unit) {
  if (value.is_number_float()) return measure_text(value.get<double>(), unit);
  if (value.is_string()) return value.get<std::string>();
  return value.is_null() ? "-" : value.dump();
}

Json results_in(const std::filesystem::path& folder, const char* name, const char* verb) {
  const std::filesystem::path file = folder / name;
  if (!std::filesystem::exists(file))
    throw DataError(folder, "", fmt::format("no {}", name), fmt::format("a folder made by `incise {}`", verb));
  return read_json(file);
}

template <std::size_t kCount>
ReportPicture picture_of(const std::filesystem::path& folder, const char* stem, const char* verb,
                         const std::array<Shown, kCount>& shown) {
  const Json results = results_in(folder, fmt::format("{}.json", stem).c_str(), verb);
  ReportPicture picture;
  for (const auto& [key, name, unit] : shown) {
    if (results.contains(key)) picture.values.push_back({name, words(results.at(key), unit), unit});
  }
  picture.svgs.push_back(read_text(folder / fmt::format("{}.svg", stem)));
  return picture;
}

void add_provenance(const std::filesystem::path& folder, const char* what, ReportData& data) {
  if (!std::filesystem::exists(folder / "manifest.json")) return;
  const Manifest manifest = read_manifest(folder);
  data.provenance.push_back({fmt::format("{}: command", what), manifest.command, ""});
  data.provenance.push_back(
      {fmt::format("{}: incise", what), fmt::format("{} {}", manifest.version, manifest.commit), ""});
  for (const ManifestInput& input : manifest.inputs)
    data.provenance.push_back({fmt::format("{}: SHA-256 of {}", what, input.path), input.sha256, ""});
}

/// Tip against path, in a sentence.
std::string tip_against_path(const Json& replay) {
  const auto number = [&replay](const char* key) {
    return replay.contains(key) && replay.at(key).is_number() ? replay.at(key).get<double>() : -1.0;
  };
  const double most_mm = number("max_cut_deviation_mm"), mean_mm = number("mean_deviation_mm");
  std::string text = replay.value("outcome", "") == to_string(ReplayOutcome::Completed)
                         ? ""
                         : "The program does not run to completion. ";
  if (most_mm >= 0.0 && mean_mm >= 0.0)
    text += fmt::format("Tip against path, in the cut: at most {:.2f} mm, mean {:.2f} mm. ", most_mm, mean_mm);
  return text + "The player ran the program with incise's own kinematics and a model of the controller, not on an arm.";
}

}  // namespace

void add_on_tissue(const std::filesystem::path& registration, const std::filesystem::path& replay, ReportData& data) {
  static constexpr std::array<Shown, 7> kRegistration{
      {{"outcome", "outcome", ""},
       {"scale", "scale", ""},
       {"rmse_mm", "residual, root mean square", "mm"},
       {"inlier_fraction", "share of points that fit", ""},
       {"fit_fraction", "share of the points above the tissue that fit", ""},
       {"settled_max_mm", "settling found, greatest", "mm"},
       {"rotation_deg", "rotation", "°"}}};
  static constexpr std::array<Shown, 6> kReplay{
      {{"outcome", "outcome", ""},
       {"max_cut_deviation_mm", "deviation from the intended path in the cut, greatest", "mm"},
       {"mean_deviation_mm", "deviation from the intended path, mean", "mm"},
       {"max_deviation_mm", "deviation with the ways in and out, greatest", "mm"},
       {"duration_s", "duration", "s"},
       {"model", "model", ""}}};
  // The program comes first: readers want to know where the tip goes.
  if (!replay.empty()) {
    ReportPicture picture = picture_of(replay, "replay", "replay", kReplay);
    picture.title = "The program";
    picture.lead = tip_against_path(results_in(replay, "replay.json", "replay"));
    add_provenance(replay, "replay", data);
    data.on_tissue.push_back(std::move(picture));
  }
  if (!registration.empty()) {
    ReportPicture picture = picture_of(registration, "registration", "register", kRegistration);
    picture.title = "Simulation and measured tissue";
    add_provenance(registration, "registration", data);
    data.on_tissue.push_back(std::move(picture));
  }
}

}  // namespace incise::steps
