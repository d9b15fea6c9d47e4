#include "camera_options.hpp"
#include "evaluation_figure.hpp"
#include "figure_file.hpp"
#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/core/problem_text.hpp>
#include <incise/evaluation/evaluation.hpp>
#include <incise/imaging/photo_contours.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/json_text.hpp>
#include <incise/storage/evaluation_file.hpp>
#include <incise/storage/result_json.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <ostream>

namespace incise::cli {
namespace {

struct EvaluateArguments {
  std::filesystem::path photo;
  std::filesystem::path incision;
  std::filesystem::path tumor;
  std::filesystem::path figure;
  std::string contour;
  std::string red = "annotation";
  double target_mm = 0.0;
  double max_gap_mm = PhotoSettings{}.max_gap_mm;
  EvaluationSettings settings;
  ScaleOptions scale;
  bool is_open = false;
  std::vector<double> approach;
  std::vector<double> twelve;
  std::string colors = "safe";
};

/// Refuses what `evaluate` would measure without a sense: each contour by its own name.
void require_usable(const Contour& contour, const Vec3& approach, const std::filesystem::path& file) {
  constexpr double kSmallestMm = 2.0;
  constexpr double kLargestMm = 200.0;
  Box3 box;
  for (const Vec3& p : contour.points) box.extend(p);
  const double extent = box.sizes().maxCoeff();
  if (!(extent >= kSmallestMm && extent <= kLargestMm)) {
    throw DataError(file, "", fmt::format("a contour {:.4g} mm across", extent),
                    fmt::format("{} to {} mm", kSmallestMm, kLargestMm), "Are its numbers in mm?");
  }
  if (contour.is_closed && crosses_itself_in_view(contour, approach)) {
    throw DataError(file, "", "a contour that crosses itself, seen along the approach", "one simple ring");
  }
}

/// The settings are known to be valid here, so what `evaluate` refuses is the contours' fault.
Evaluation measured(const Contour& incision, const Contour& tumor_edge, const EvaluationSettings& settings,
                    const std::filesystem::path& file) {
  try {
    return evaluate(incision, tumor_edge, settings);
  } catch (const InvalidArgument& error) {
    throw fault_of_file(file, "", error, "contours that can be measured");
  }
}

/// A photograph shows the inner edge unless told otherwise, contour files hold the mid-line.
EvaluationSettings settings_of(const EvaluateArguments& arguments) {
  EvaluationSettings settings = arguments.settings;
  const std::string fallback = arguments.photo.empty() ? "centerline" : "inner_edge";
  settings.contour = (arguments.contour.empty() ? fallback : arguments.contour) == "centerline"
                         ? ContourKind::Centerline
                         : ContourKind::InnerEdge;
  if (arguments.target_mm > 0.0) settings.target_mm = arguments.target_mm;
  if (!arguments.approach.empty()) settings.approach = Vec3(arguments.approach.data());
  if (!arguments.twelve.empty()) settings.twelve_o_clock = Vec3(arguments.twelve.data());
  if (const auto violations = validate(settings); !violations.empty()) {
    throw broken_options(violations.front());
  }
  return settings;
}

void require_one_source(const EvaluateArguments& arguments) {
  const bool has_files = !arguments.incision.empty() || !arguments.tumor.empty();
  const auto refuse = [](const char* field, const char* found, const char* expected) {
    throw CaseError("command line", field, found, expected);
  };
  if (!arguments.photo.empty() && has_files) refuse("PHOTO", "a photograph and contour files", "one of the two");
  if (!arguments.photo.empty()) {
    if (arguments.is_open)
      refuse("--open", "an open cut in a photograph",
             "a ring round the tumour; what was cut of one is measured as it is");
    if (!arguments.approach.empty())
      refuse("--approach", "a direction for a photograph", "none: a photograph is seen from above");
    if (!arguments.figure.empty() && arguments.figure.extension() != ".png")
      refuse("--figure", "another kind of file", "a name that ends in .png: the photograph is drawn over");
    return;
  }
  if (arguments.incision.empty() || arguments.tumor.empty())
    refuse("PHOTO", "no input", "a photograph, or --incision and --tumor");
  if (arguments.scale.is_given()) refuse("scale", "a scale for contour files", "none: they are in mm");
  if (!arguments.figure.empty()) require_figure_file(arguments.figure, "--figure");
}

nlohmann::ordered_json line_json(const MarkedLine& line) {
  nlohmann::ordered_json json;
  json["width_px"] = line.width_px;
  json["contrast"] = line.contrast;
  json["closed"] = line.is_closed;
  json["gaps"] = line.gaps.size();
  json["max_gap_mm"] = line.max_gap_mm();
  const auto widest =
      std::find_if(line.gaps.begin(), line.gaps.end(), [](const LineGap& gap) { return !gap.is_hidden; });
  json["max_gap_is_highlight"] = widest != line.gaps.end() && widest->is_glare;
  return json;
}

struct Measured {
  Evaluation evaluation;
  nlohmann::ordered_json json;
};

Measured from_photo(const EvaluateArguments& arguments, const EvaluationSettings& settings) {
  const ColorPicture picture = decode_picture(read_text(arguments.photo), arguments.photo);
  const FoundScale scale = scale_of(arguments.scale, picture, arguments.photo);
  // The mid-line of a painted band is the middle of a line.
  const bool wants_border = arguments.red == "kerf" && settings.contour == ContourKind::InnerEdge;
  const PhotoSettings photo{.red = wants_border ? RedLine::Kerf : RedLine::Annotation,
                            .max_gap_mm = arguments.max_gap_mm};
  const PhotoContours found = find_photo_contours(picture, scale.scale, photo, arguments.photo);
  Measured result{measured(found.incision, found.tumor_edge, settings, arguments.photo), {}};
  result.json = to_json(result.evaluation);
  result.json["points"] = points_json(result.evaluation);
  result.json["photo"] = arguments.photo.string();
  result.json["mm_per_pixel"] = found.mm_per_pixel;
  result.json["scale"] = scale.summary;
  result.json["red"] = arguments.red;
  result.json["red_line"] = line_json(found.red);
  result.json["green_line"] = line_json(found.green);
  if (!arguments.figure.empty()) {
    const std::string png = encode_png(draw_found(picture, {&found.green, &found.red}, scale.marks_px));
    write_atomically(arguments.figure, [&](std::ostream& out) { out << png; });
    result.json["figure"] = arguments.figure.string();
  }
  return result;
}

Measured from_files(const EvaluateArguments& arguments, const EvaluationSettings& settings) {
  const Contour incision = read_contour(arguments.incision, !arguments.is_open);
  const Contour tumor_edge = read_contour(arguments.tumor, true);
  require_usable(incision, settings.approach, arguments.incision);
  require_usable(tumor_edge, settings.approach, arguments.tumor);
  Measured result{measured(incision, tumor_edge, settings, arguments.tumor), {}};
  result.json = to_json(result.evaluation);
  result.json["points"] = points_json(result.evaluation);
  if (!arguments.figure.empty()) {
    const ErrorColors colors = arguments.colors == "jet" ? ErrorColors::Jet : ErrorColors::Safe;
    const std::string name = arguments.incision.stem().string();
    write_figure(arguments.figure, evaluation_figure_svg(result.evaluation, tumor_edge, settings, name, colors));
    result.json["figure"] = arguments.figure.string();
  }
  return result;
}

}  // namespace

void add_evaluate(Application& application) {
  auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* verb =
      application.add_verb("evaluate", "Measure an incision against the tumour edge, in a photograph or as contours",
                           "incise evaluate cut.jpg --mm-per-pixel 0.03 --red annotation --figure found.png --json",
                           [arguments](const CommonOptions& options) {
                             require_one_source(*arguments);
                             const std::vector<std::filesystem::path> inputs{arguments->photo, arguments->incision, arguments->tumor};
                             refuse_input_as_output("-o", options.output, inputs);
                             refuse_input_as_output("--figure", arguments->figure, inputs);
                             const EvaluationSettings settings = settings_of(*arguments);
                             const Measured result = arguments->photo.empty() ? from_files(*arguments, settings)
                                                                              : from_photo(*arguments, settings);
                             if (!options.output.empty()) write_json(options.output, result.json);
                             print_result(options, result.json);
                             return status_of(result.evaluation.outcome);
                           });
  verb->add_option("photo", arguments->photo,
                   "Top view of the cut (.png, .jpg, .tif): red incision, green tumour edge");
  verb->add_option("--incision", arguments->incision, "The incision: .csv (x_mm,y_mm,z_mm), .vtp or .mrk.json");
  verb->add_option("--tumor", arguments->tumor, "The tumour edge, same formats and frame");
  verb->add_option("--contour", arguments->contour,
                   "What was measured; default: inner_edge in a photograph, centerline in files")
      ->check(CLI::IsMember({"centerline", "inner_edge"}));
  verb->add_option("--red", arguments->red,
                   "What the red line is: a thin line along the inner edge, or the painted kerf")
      ->check(CLI::IsMember({"annotation", "kerf"}));
  add_scale_options(*verb, arguments->scale);
  verb->add_option("--max-gap-mm", arguments->max_gap_mm, "A red or green ring with a longer gap is open")
      ->check(CLI::Range(0.0, 10.0));
  verb->add_option("--target-mm", arguments->target_mm,
                   "Distance aimed at; default: 5.0 for a mid-line, 4.5 for an inner edge")
      ->check(CLI::PositiveNumber);
  verb->add_option("--close-margin-mm", arguments->settings.close_margin_mm, "Clinical cut-off");
  verb->add_option("--approach", arguments->approach, "Direction in which the camera looks")->expected(3);
  verb->add_option("--twelve-o-clock", arguments->twelve,
                   "Direction of 12 o'clock in by_clock; default: up in the picture")
      ->expected(3);
  verb->add_option(
      "--figure", arguments->figure,
      "The photograph with what was found drawn over it (.png); of contours: the signed error in colour (.svg, .png)");
  verb->add_option("--colors", arguments->colors,
                   "Of the figure: told apart with any colour vision, or as in the paper")
      ->check(CLI::IsMember({"safe", "jet"}));
  verb->add_flag("--open", arguments->is_open, "The incision is an open curve");
}

}  // namespace incise::cli
