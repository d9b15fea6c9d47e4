#include "compensation_figures.hpp"
#include "study_run.hpp"

#include <incise/core/error.hpp>
#include <incise/storage/result_json.hpp>

#include <memory>

namespace incise::cli {
namespace {

struct CompensateOptions {
  std::filesystem::path case_path;
  CutOptions cut;
};

/// What was left of the mean error per pass; one pass of the paper's: after over before.
nlohmann::ordered_json contraction_of(const Study& study) {
  if (!study.correction) return nullptr;
  if (study.correction->iteration) {
    const std::optional<double>& contraction = study.correction->iteration->contraction;
    return contraction ? nlohmann::ordered_json(*contraction) : nlohmann::ordered_json(nullptr);
  }
  if (!study.corrected || !study.corrected->centerline.abs_error_mm) return nullptr;
  return study.corrected->centerline.abs_error_mm->mean / study.as_planned->centerline.abs_error_mm->mean;
}

nlohmann::ordered_json summary_of(const Study& study) {
  nlohmann::ordered_json json;
  if (!study.as_planned) return to_json(*study.stretched);
  const std::size_t simulations = study.correction && study.correction->iteration
                                      ? study.correction->iteration->passes.size()
                                  : study.corrected ? 2
                                                    : 1;
  json["outcome"] = to_string(study.outcome);
  json["accepted"] = study.is_accepted;
  json["passes"] = simulations - 1;
  json["simulations"] = simulations;
  json["contraction"] = contraction_of(study);
  json["compensation_outcome"] = nullptr;
  if (study.correction && study.correction->iteration)
    json["compensation_outcome"] = to_string(study.correction->iteration->outcome);
  json["floor_mm"] = nullptr;
  if (study.correction && study.correction->floor_mm) json["floor_mm"] = *study.correction->floor_mm;
  json["before"] = to_json(*study.as_planned);
  json["after"] = study.corrected ? to_json(*study.corrected) : nlohmann::ordered_json(nullptr);
  json["correction"] = study.correction ? correction_summary_json(*study.correction) : nlohmann::ordered_json(nullptr);
  return json;
}

int compensate(const CompensateOptions& chosen, const CommonOptions& options) {
  Console console(options.level());
  const std::filesystem::path output = output_of(chosen.case_path, options);
  StudyRun run(chosen.case_path, output, Stage::Verify, options, chosen.cut);
  const Study study = run.run(options, console);
  nlohmann::ordered_json result = summary_of(study);
  result["folder"] = run.store.folder(Product::Correction).string();
  if (study.correction) result["path"] = (run.store.folder(Product::Correction) / "path.json").string();
  result["figures"] = nlohmann::ordered_json::array();
  for (const auto& figure : write_compensation_figures(output, output / "figures"))
    result["figures"].push_back(figure.string());
  result["stages"] = to_json(study.stages);
  print_study(options, result);
  if (study.outcome == Outcome::Success && !study.is_accepted) {
    console.message(Severity::Warning,
                    "the correction is not accepted: the mean error has to be below the electrode's radius, and "
                    "smaller than before");
  }
  return study.is_accepted ? kDone : kNotAcceptable;
}

}  // namespace

void add_compensation_method(CLI::App& verb, CutOptions& options) {
  verb.add_option_function<std::string>(
          "--method",
          [&options](const std::string& name) {
            options.method = name == "paper" ? CompensationMethod::Paper : CompensationMethod::Default;
          },
          "default: pass by pass until the cut lies where it was intended, at most 4 cuts in all; paper: each waypoint "
          "moves once by the error "
          "measured there. In place of the case's compensation.method")
      ->check(CLI::IsMember({"default", "paper"}));
}

void add_compensate(Application& application) {
  auto chosen = std::make_shared<CompensateOptions>();
  CLI::App* verb =
      application.add_verb("compensate", "Correct the path by the simulated error and verify it by cutting again",
                           "incise compensate specimen -o out",
                           [chosen](const CommonOptions& options) { return compensate(*chosen, options); });
  verb->add_option("case", chosen->case_path, "Case file, or a folder with case.yaml")->required();
  add_cut_options(*verb, chosen->cut);
  add_compensation_method(*verb, chosen->cut);
}

}  // namespace incise::cli
