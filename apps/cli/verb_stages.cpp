#include "study_run.hpp"

#include <memory>

namespace incise::cli {
namespace {

constexpr const char* kCaseHelp = "Case file, or a folder with case.yaml";

int run_stage(Stage stage, const std::filesystem::path& case_path, const CommonOptions& options,
              const CutOptions& cut = {}) {
  return run_step(options, [&](const auto& context) {
    return steps::run_stages(case_request(case_path, stage, options, cut), context);
  });
}

/// Adds a verb that runs the loop up to a stage that cuts nothing.
void add_stage(Application& application, const char* name, const char* what, const char* example, Stage stage) {
  auto case_path = std::make_shared<std::filesystem::path>();
  CLI::App* verb = application.add_verb(
      name, what, example, [=](const CommonOptions& options) { return run_stage(stage, *case_path, options); });
  verb->add_option("case", *case_path, kCaseHelp)->required();
}

/// Adds a verb that runs the loop up to a stage that cuts.
void add_cutting_stage(Application& application, const char* name, const char* what, const char* example, Stage stage) {
  auto case_path = std::make_shared<std::filesystem::path>();
  auto cut = std::make_shared<CutOptions>();
  CLI::App* verb = application.add_verb(
      name, what, example, [=](const CommonOptions& options) { return run_stage(stage, *case_path, options, *cut); });
  verb->add_option("case", *case_path, kCaseHelp)->required();
  add_cut_options(*verb, *cut);
}

}  // namespace

void add_stages(Application& application) {
  add_stage(application, "deform",
            "Clamp and stretch the tissue: static equilibrium under the case's constraints. An interrupted stretch is "
            "not kept: run again, it starts over and gives the same result, bit for bit",
            "incise deform specimen -o out", Stage::Stretch);
  add_stage(application, "plan", "", "incise plan specimen -o out", Stage::Plan);
  add_cutting_stage(application, "simulate",
                    "Cut along the planned path (or the case's own) and measure the result. If interrupted, it leaves "
                    "a checkpoint; run again, it continues from there and gives the same result, bit for bit",
                    "incise simulate specimen -o out", Stage::Simulate);
}

}  // namespace incise::cli
