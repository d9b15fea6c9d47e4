#include "laboratory/tested_specimen.hpp"

#include <incise/calibration/ring_covariates.hpp>
#include <incise/core/error.hpp>
#include <incise/io/json_file.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise::laboratory {
namespace {

PathCut path_cut(const Trial& trial, std::string_view path, const TrialCut& cut, const std::filesystem::path& truth,
                 std::string_view tag) {
  PathCut result{.path = std::string(path), .mean_abs_error_mm = mean_error_mm(cut)};
  result.end = cut.measured ? PathEnd::Measured : cut.is_made ? PathEnd::Open : PathEnd::NotCut;
  const std::optional<TrueCut> known = true_cut(truth, trial, cut, tag);
  if (known && known->mean_abs_error_mm) result.least_margin_mm = known->least_margin_mm;
  return result;
}

}  // namespace

std::optional<TrueCut> true_cut(const std::filesystem::path& truth, const Trial& trial, const TrialCut& cut,
                                std::string_view tag) {
  if (!cut.is_made) return std::nullopt;
  const std::filesystem::path file = truth / fmt::format("{}_{}", trial.name, tag) / "cut_truth.json";
  const nlohmann::ordered_json json = read_json(file);
  TrueCut result;
  if (json.is_object() && !json.contains("mean_abs_error_mm")) return result;
  try {
    result.mean_abs_error_mm = json.at("mean_abs_error_mm").get<double>();
    const auto errors = json.at("signed_errors_mm").get<std::vector<double>>();
    if (errors.empty()) throw DataError(file, "signed_errors_mm", "no errors", "those of a closed ring");
    result.least_margin_mm = json.at("target_mm").get<double>() + *std::min_element(errors.begin(), errors.end());
  } catch (const nlohmann::json::exception& error) {
    throw DataError(file, "", error.what(), "the truth of a cut, as `incise bench cut` writes it");
  }
  return result;
}

const PathCut* TestedSpecimen::find(std::string_view path) const {
  const auto place = std::find_if(cuts.begin(), cuts.end(), [path](const PathCut& cut) { return cut.path == path; });
  return place != cuts.end() ? &*place : nullptr;
}

bool is_path_without_simulation(std::string_view name) {
  if (name == kAsPlannedPath) return true;
  if (name == kIncisePath) return false;
  const std::optional<RivalPath> path = value_of<RivalPath>(name);
  INCISE_REQUIRE(path.has_value(), fmt::format("expected the name of a path, found {}", name));
  return is_without_simulation(*path);
}

std::vector<TestedSpecimen> tested_specimens(const std::vector<Trial>& trials, const std::filesystem::path& truth) {
  std::vector<TestedSpecimen> tested;
  for (const Trial& trial : trials) {
    if (trial.role != TrialRole::Test || !trial.planned.measured) continue;
    TestedSpecimen specimen{.name = trial.name, .unlike = {}, .cuts = {}, .learning = {}};
    if (trial.unlike) specimen.unlike = trial.unlike->size();
    const auto add = [&](std::string_view path, const TrialCut& cut, std::string_view tag) {
      specimen.cuts.push_back(path_cut(trial, path, cut, truth, tag));
    };
    add(kAsPlannedPath, trial.planned, "planned");
    bool is_incise_added = false;
    const auto add_incise = [&] {
      if (!is_incise_added) add(kIncisePath, trial.corrected, "corrected");
      is_incise_added = true;
    };
    for (const RivalCut& rival : trial.rivals) {
      if (rival.path >= RivalPath::Hybrid) add_incise();
      add(to_string(rival.path), rival.cut, to_string(rival.path));
    }
    add_incise();
    for (const LearningCut& learning : trial.learning)
      specimen.learning.push_back({learning.photographs, path_cut(trial, to_string(learning.path), learning.cut, truth,
                                                                  learning_name(learning.path, learning.photographs))});
    tested.push_back(std::move(specimen));
  }
  return tested;
}

std::vector<TestedSpecimen> of_likeness(const std::vector<TestedSpecimen>& specimens, bool is_unlike) {
  std::vector<TestedSpecimen> chosen;
  for (const TestedSpecimen& specimen : specimens)
    if (specimen.unlike && (*specimen.unlike >= kUnlikeFrom) == is_unlike) chosen.push_back(specimen);
  return chosen;
}

}  // namespace incise::laboratory
