#include "option_checks.hpp"
#include "options.hpp"

#include <incise/io/specimen_id.hpp>
#include <incise/steps/cut_steps.hpp>

namespace incise::cli {
namespace {

struct EvaluateArguments {
  steps::EvaluateRequest request;
  std::string contour;
  std::string red = "annotation";
  std::string ruler;
  double target_mm = 0.0;
  std::vector<double> approach;
  std::vector<double> twelve;
  std::string colors = "safe";
};

void add_scale_options(CLI::App& verb, steps::ScaleRequest& options, std::string& ruler) {
  verb.add_option("--mm-per-pixel", options.mm_per_pixel, "Scale of the photograph")
      ->check(above_zero("--mm-per-pixel"));
  verb.add_option("--ruler", ruler, "Find the scale in the photograph: a ruler's ticks, or a solid scale bar")
      ->check(name_of_any<RulerKind>());
  verb.add_option("--ruler-mm", options.ruler_mm,
                  "Distance between neighbouring finest ticks of the ruler, by default 1 mm; for a bar: its length")
      ->check(above_zero("--ruler-mm"));
  verb.add_option("--two-points", options.two_points, "Scale from two pixels and their distance: U V U V MM")
      ->expected(5);
  verb.add_option("--rectangle", options.rectangle,
                  "Scale and perspective from the corners of a rectangle: lower left, lower right, upper right, upper "
                  "left, as U V pairs")
      ->expected(8);
  verb.add_option("--rectangle-mm", options.rectangle_mm, "Width and height of the rectangle")->expected(2);
}

/// Returns the options as a request of the library.
steps::EvaluateRequest request_of(const EvaluateArguments& arguments) {
  steps::EvaluateRequest request = arguments.request;
  if (!arguments.contour.empty()) request.contour = value_named<ContourKind>(arguments.contour);
  if (arguments.target_mm > 0.0) request.settings.target_mm = arguments.target_mm;
  if (!arguments.approach.empty()) request.approach = direction_of(arguments.approach, "--approach");
  if (!arguments.twelve.empty()) request.settings.twelve_o_clock = Vec3(arguments.twelve.data());
  request.red = value_named<RedLine>(arguments.red);
  request.colors = value_named<ErrorColors>(arguments.colors);
  if (!arguments.ruler.empty()) request.scale.ruler = value_named<RulerKind>(arguments.ruler);
  return request;
}

int run(const EvaluateArguments& arguments, const CommonOptions& options) {
  steps::EvaluateRequest request = request_of(arguments);
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
  auto [verb, a] = application.add_verb<EvaluateArguments>(
      "evaluate", "", "incise evaluate cut.jpg --mm-per-pixel 0.03 --red annotation --figure found.png --json", run);
  describe_output(*verb, kNothingByDefault);
  verb->add_option("photo", a.request.photo, "Top view of the cut (.png, .jpg, .tif): red incision, green tumour edge");
  verb->add_option("--specimen-id", a.request.specimen_id,
                   "Id of the specimen that was cut, as in its case: calibrate refuses any other")
      ->check(CLI::Validator(
          [](const std::string& text) { return is_specimen_id(text) ? std::string() : std::string(kSpecimenIdForm); },
          "ID"));
  verb->add_option("--incision", a.request.incision, "The incision: .csv (x_mm,y_mm,z_mm), .vtp or .mrk.json");
  verb->add_option("--tumor", a.request.tumor, "The tumour edge, in the same formats and frame");
  verb->add_option(
      "--line", a.request.line,
      "Instead of --tumor, for an open cut: the line that --incision was to follow, same formats and frame");
  verb->add_option("--contour", a.contour,
                   "What was measured; default: inner_edge in a photograph, centerline in files")
      ->check(name_of_any<ContourKind>());
  verb->add_option("--red", a.red, "What the red line is: a thin line along the inner edge, or the painted kerf")
      ->check(name_of_any<RedLine>());
  add_scale_options(*verb, a.request.scale, a.ruler);
  verb->add_option("--max-gap-mm", a.request.max_gap_mm,
                   "A red or green ring with a clearly longer gap (by 0.18 mm and 2 pixels) is open; if the gap of a "
                   "red ring is slightly longer, the verdict says so")
      ->check(between("--max-gap-mm", 0.0, 10.0));
  verb->add_option("--target-mm", a.target_mm, "Target distance; default: 5.0 for a mid-line, 4.5 for an inner edge")
      ->check(above_zero("--target-mm"));
  verb->add_option("--close-margin-mm", a.request.settings.close_margin_mm,
                   "Clinical cut-off: less tissue than this beside the tumour is too close");
  verb->add_option("--approach", a.approach, "Direction in which the camera looks")->expected(3);
  verb->add_option("--twelve-o-clock", a.twelve, "Direction of 12 o'clock in by_clock; default: up in the picture")
      ->expected(3);
  verb->add_option(
      "--figure", a.request.figure,
      "Figure to write: the photograph with the contours found in it (.png); for contour files: the signed error in "
      "colour (.svg, .png)");
  verb->add_option("--colors", a.colors, "Colours of the figure: safe for any colour vision, or as in the paper")
      ->check(name_of_any<ErrorColors>());
  verb->add_flag("--open", a.request.is_open, "The incision round the tumour is an open curve");
}

}  // namespace incise::cli
