#include "described_options.hpp"
#include "option_checks.hpp"
#include "options.hpp"

#include <incise/io/specimen_id.hpp>
#include <incise/steps/cut_steps.hpp>

namespace incise::cli {
namespace {

int run_evaluate(steps::EvaluateRequest request, const CommonOptions& options) {
  request.output = options.output;
  const std::vector<std::filesystem::path> inputs{request.photo, request.incision, request.tumor, request.line};
  refuse_input_as_output("-o", request.output, inputs);
  refuse_input_as_output("--figure", request.figure, inputs);
  refuse_same_output("-o", request.output, "--figure", request.figure);
  require_valid(validate(request.settings));
  return run_step(options, [&](const auto& context) { return steps::evaluate_cut(request, context); });
}

}  // namespace

void add_evaluate(Application& application) {
  auto [verb, a] = application.add_verb<steps::EvaluateRequest>(
      "evaluate", "", "incise evaluate cut.jpg --mm-per-pixel 0.03 --red annotation --figure found.png --json",
      run_evaluate);
  describe_output(*verb, kNothingByDefault);
  verb->add_option("photo", a.photo, "Top view of the cut (.png, .jpg, .tif): red incision, green tumour edge");
  add_options_of(*verb, a, "specimen_id", "incision", "tumor", "line", "contour", "red", "mm_per_pixel", "ruler",
                 "ruler_mm");
  // An empty id, as of a shell variable that is not set, is not the same as none.
  verb->get_option("--specimen-id")
      ->check(CLI::Validator(
          [](std::string& id) {
            if (id.empty()) refuse_value("--specimen-id", id, std::string(kSpecimenIdForm));
            return std::string();
          },
          ""));
  verb->add_option("--two-points", a.scale.two_points, "Scale from two pixels and their distance: U V U V MM")
      ->expected(5)
      ->default_str("");
  verb->add_option("--rectangle", a.scale.rectangle,
                   "Scale and perspective from the corners of a rectangle: lower left, lower right, upper right, upper "
                   "left, as U V pairs")
      ->expected(8)
      ->default_str("");
  verb->add_option("--rectangle-mm", a.scale.rectangle_mm, "Width and height of the rectangle")
      ->expected(2)
      ->default_str("");
  add_options_of(*verb, a.settings, "target_mm", "close_margin_mm", "twelve_o_clock");
  add_options_of(*verb, a, "max_gap_mm", "figure", "colors", "open");
  verb->add_option_function<std::vector<double>>(
          "--approach",
          [&request = a](const std::vector<double>& numbers) {
            request.approach = direction_of(numbers, "--approach");
          },
          "Direction in which the camera looks")
      ->expected(3);
}

}  // namespace incise::cli
