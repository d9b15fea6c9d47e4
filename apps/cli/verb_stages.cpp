#include "study_run.hpp"

#include <incise/core/error.hpp>
#include <incise/storage/result_json.hpp>

#include <memory>

namespace incise::cli {
namespace {

constexpr const char* kCaseHelp = "Case file, or a folder with case.yaml";

nlohmann::ordered_json result_of(Stage stage, const Study& study) {
  switch (stage) {
    case Stage::Plan: return plan_summary_json(*study.plan);
    case Stage::Simulate: return to_json(*study.as_planned);
    default: return to_json(*study.stretched);
  }
}

int run_stage(Stage stage, const char* product, const std::filesystem::path& case_path, const CommonOptions& options,
              const CutOptions& cut = {}) {
  Console console(options.level());
  StudyRun run(case_path, output_of(case_path, options), stage, options, cut);
  const Study study = run.study(console);
  const bool is_stretched = study.stretched && study.stretched->outcome == Outcome::Success;
  nlohmann::ordered_json result = is_stretched ? result_of(stage, study) : to_json(*study.stretched);
  result["folder"] = run.folder.folder(product).string();
  result["stages"] = to_json(study.stages);
  print_result(options, result);
  return stage == Stage::Simulate ? status_of(study, study.verdict)
                                  : status_of(study.outcome);  // before a cut there is nothing to judge
}

/// A verb that runs the study up to a stage that cuts nothing.
void add_stage(Application& application, const char* name, const char* what, const char* example, Stage stage,
               const char* product) {
  auto case_path = std::make_shared<std::filesystem::path>();
  CLI::App* verb = application.add_verb(name, what, example, [=](const CommonOptions& options) {
    return run_stage(stage, product, *case_path, options);
  });
  verb->add_option("case", *case_path, kCaseHelp)->required();
}

/// A verb that runs the study up to a stage that cuts.
void add_cutting_stage(Application& application, const char* name, const char* what, const char* example, Stage stage,
                       const char* product) {
  auto case_path = std::make_shared<std::filesystem::path>();
  auto cut = std::make_shared<CutOptions>();
  CLI::App* verb = application.add_verb(name, what, example, [=](const CommonOptions& options) {
    return run_stage(stage, product, *case_path, options, *cut);
  });
  verb->add_option("case", *case_path, kCaseHelp)->required();
  add_cut_options(*verb, *cut);
}

}  // namespace

void add_stages(Application& application) {
  add_stage(application, "deform",
            "Clamp and stretch the tissue: static equilibrium under the case's constraints. Interrupted, it keeps "
            "nothing of the stretch: "
            "run again, it starts over and ends in the same bits",
            "incise deform specimen -o out", Stage::Stretch, "stretched");
  add_stage(application, "plan", "", "incise plan specimen -o out", Stage::Plan, "plan");
  add_cutting_stage(application, "simulate",
                    "Cut along the planned path (or the case's own) and measure what comes out. Interrupted, it leaves "
                    "a checkpoint, from "
                    "which it goes on and ends in the same bits",
                    "incise simulate specimen -o out", Stage::Simulate, "as_planned");
}

}  // namespace incise::cli
