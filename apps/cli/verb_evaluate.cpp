#include "camera_options.hpp"
#include "evaluation_figure.hpp"
#include "figure_file.hpp"
#include "option_checks.hpp"
#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/core/problem_text.hpp>
#include <incise/evaluation/evaluation.hpp>
#include <incise/geometry/contour_checks.hpp>
#include <incise/imaging/photo_contours.hpp>
#include <incise/imaging/photo_doubts.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/described_json.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/storage/evaluation_file.hpp>
#include <incise/storage/result_json.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <ostream>

namespace incise::cli {
namespace {

struct EvaluateArguments {
  std::filesystem::path photo;
  std::filesystem::path incision;
  std::filesystem::path tumor;
  std::filesystem::path line;
  std::filesystem::path figure;
  std::string specimen_id;
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
void require_usable(const Contour& contour, const std::string& what, double largest_mm, const Vec3& approach,
                    const std::filesystem::path& file) {
  if (const auto problem = size_problem(contour, what, largest_mm)) {
    throw DataError(file, "", problem->found, problem->expected, "Are its numbers in mm?");
  }
  if (const auto at = first_crossing_in_view(contour, approach)) {
    throw DataError(file, "",
                    fmt::format("a contour that crosses itself, seen along the approach, at {:.2f}, {:.2f}, {:.2f} mm",
                                at->x(), at->y(), at->z()),
                    contour.is_closed ? "one simple ring" : "one simple curve");
  }
}

/// A photograph shows the inner edge unless told otherwise, contour files hold the mid-line.
EvaluationSettings settings_of(const EvaluateArguments& arguments) {
  EvaluationSettings settings = arguments.settings;
  settings.contour = !arguments.contour.empty() ? value_named<ContourKind>(arguments.contour)
                     : arguments.photo.empty()  ? ContourKind::Centerline
                                                : ContourKind::InnerEdge;
  if (arguments.target_mm > 0.0) settings.target_mm = arguments.target_mm;
  if (!arguments.approach.empty()) settings.approach = Vec3(arguments.approach.data());
  if (!arguments.twelve.empty()) settings.twelve_o_clock = Vec3(arguments.twelve.data());
  require_valid(validate(settings));
  return settings;
}

void require_one_source(const EvaluateArguments& arguments) {
  const bool has_files = !arguments.incision.empty() || !arguments.tumor.empty() || !arguments.line.empty();
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
  const bool has_line = !arguments.line.empty();
  if (arguments.incision.empty() || arguments.tumor.empty() != has_line)
    refuse("PHOTO", has_line && !arguments.tumor.empty() ? "--line and --tumor" : "no input",
           "a photograph, or --incision with either --tumor or --line");
  if (has_line && arguments.target_mm > 0.0)
    refuse("--target-mm", "a distance", "none: a cut along a line is to lie on the line");
  if (has_line && !arguments.twelve.empty()) refuse("--twelve-o-clock", "a direction", "none: there is no ring");
  if (has_line && !arguments.figure.empty())
    refuse("--figure", "a file", "none: the figure shows an incision round a tumour");
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

/// What was measured, point by point and with the edge that it was measured against, for those who compare it place by
/// place.
void add_contours(nlohmann::ordered_json& json, const Evaluation& evaluation, const Contour& tumor_edge,
                  const Vec3& approach) {
  json["points"] = points_json(evaluation);
  const double step_mm = EvaluationSettings{}.step_mm;
  json["tumor_edge"] = contour_json(resample_by_step(tumor_edge, step_mm));
  json["approach"] = {approach.x() + 0.0, approach.y() + 0.0, approach.z() + 0.0};  // no minus before a zero
}

struct Measured {
  Evaluation evaluation;
  nlohmann::ordered_json json;
  std::vector<std::string> warnings;
  Verdict verdict;  ///< of the measurement: whether its numbers can be trusted
};

/// What `measure` finds, in JSON too. The settings are known to be valid here, so what it refuses is the fault of the
/// contours in `file`.
template <typename Measure>
Measured measured(const std::filesystem::path& file, const Measure& measure) {
  try {
    Measured result{measure(), {}, {}, {}};
    result.json = to_json(result.evaluation);
    result.json["points"] = points_json(result.evaluation);
    return result;
  } catch (const InvalidArgument& error) {
    throw fault_of_file(file, "", error, "contours that can be measured");
  }
}

nlohmann::ordered_json marks_json(const std::vector<PhotoMark>& marks) {
  auto json = nlohmann::ordered_json::array();
  for (const PhotoMark& mark : marks)
    json.push_back({{"u_px", mark.at_px.x()}, {"v_px", mark.at_px.y()}, {"longest_mm", mark.longest_mm}});
  return json;
}

/// Red in the tumour may be blood or a cut that went astray, green beside its edge a part of it: no number shows such
/// marks, so a warning does.
void tell(const std::vector<PhotoMark>& marks, const char* mark, const char* place, const char* question,
          std::vector<std::string>& warnings) {
  if (marks.empty()) return;
  const bool is_one = marks.size() == 1;
  warnings.push_back(fmt::format(
      "{} {}{} {} the tumour's edge, the largest {:.2f} mm, at pixel {:.0f}, {:.0f}: {} {} part of no measure",
      marks.size(), mark, is_one ? "" : "s", place, marks.front().longest_mm, marks.front().at_px.x(),
      marks.front().at_px.y(), question, is_one ? "It is" : "They are"));
}

Measured from_photo(const EvaluateArguments& arguments, const EvaluationSettings& settings) {
  const ColorPicture picture = decode_picture(read_text(arguments.photo), arguments.photo);
  const FoundScale scale = scale_of(arguments.scale, picture, arguments.photo);
  // The mid-line of a painted band is the middle of a line.
  const bool wants_border = arguments.red == to_string(RedLine::Kerf) && settings.contour == ContourKind::InnerEdge;
  const PhotoSettings photo{.red = wants_border ? RedLine::Kerf : RedLine::Annotation,
                            .max_gap_mm = arguments.max_gap_mm};
  const PhotoContours found = find_photo_contours(picture, scale.scale, photo, arguments.photo);
  Measured result = measured(arguments.photo, [&] { return evaluate(found.incision, found.tumor_edge, settings); });
  add_contours(result.json, result.evaluation, found.tumor_edge, settings.approach);
  result.json["photo"] = arguments.photo.string();
  result.json["mm_per_pixel"] = found.mm_per_pixel;
  result.json["scale"] = scale.summary;
  result.json["red"] = arguments.red;
  result.json["red_line"] = line_json(found.red);
  result.json["green_line"] = line_json(found.green);
  result.json["red_in_tumor"] = marks_json(found.red_in_tumor);
  result.json["green_beside"] = marks_json(found.green_beside);
  tell(found.red_in_tumor, "red spot", "inside", "blood, or a cut?", result.warnings);
  tell(found.green_beside, "green mark", "beside", "a second tumour?", result.warnings);
  if (scale.ruler) add_ruler_doubts(*scale.ruler, result.verdict);
  add_ring_doubts(found, photo.max_gap_mm, result.verdict);
  for (const VerdictReason& reason : result.verdict.reasons()) {
    result.warnings.push_back(fmt::format("{}: {}: {}", to_string(reason.severity), reason.id, reason.message));
  }
  result.json["warnings"] = result.warnings;
  result.json["verdict"] = to_json(result.verdict);
  if (!arguments.figure.empty()) {
    const std::string png = encode_png(draw_found(picture, {&found.green, &found.red}, scale.marks_px));
    write_atomically(arguments.figure, png);
    result.json["figure"] = arguments.figure.string();
  }
  return result;
}

/// An open cut against the line that it was to follow.
Measured from_line(const EvaluateArguments& arguments, const EvaluationSettings& settings) {
  const Contour incision = read_contour(arguments.incision, false);
  const Contour line = read_contour(arguments.line, false);
  require_usable(incision, "a cut", kLargestIncisionMm, settings.approach, arguments.incision);
  require_usable(line, "a line", kLargestIncisionMm, settings.approach, arguments.line);
  return measured(arguments.line, [&] { return evaluate_line(incision, line, settings); });
}

Measured from_files(const EvaluateArguments& arguments, const EvaluationSettings& settings) {
  if (!arguments.line.empty()) return from_line(arguments, settings);
  const Contour incision = read_contour(arguments.incision, !arguments.is_open);
  const Contour tumor_edge = read_contour(arguments.tumor, true);
  require_usable(incision, "an incision", kLargestIncisionMm, settings.approach, arguments.incision);
  require_usable(tumor_edge, "a tumour", kLargestTumorMm, settings.approach, arguments.tumor);
  Measured result = measured(arguments.tumor, [&] { return evaluate(incision, tumor_edge, settings); });
  add_contours(result.json, result.evaluation, tumor_edge, settings.approach);
  if (!arguments.figure.empty()) {
    const auto colors = value_named<ErrorColors>(arguments.colors);
    const std::string name = arguments.incision.stem().string();
    write_figure(arguments.figure, evaluation_figure_svg(result.evaluation, tumor_edge, settings, name, colors));
    result.json["figure"] = arguments.figure.string();
  }
  return result;
}

/// @throws CaseError where the option says another specimen than the files.
std::string specimen_of(const EvaluateArguments& arguments, const std::vector<std::filesystem::path>& inputs) {
  std::string stated = common_specimen_id(inputs);
  if (arguments.specimen_id.empty()) return stated;
  if (!are_of_different_specimens(arguments.specimen_id, stated)) return arguments.specimen_id;
  throw CaseError("command line", "--specimen-id", arguments.specimen_id, stated + ", which the files state");
}

int run(const EvaluateArguments& arguments, const CommonOptions& options) {
  require_one_source(arguments);
  const std::vector<std::filesystem::path> inputs{arguments.photo, arguments.incision, arguments.tumor, arguments.line};
  refuse_input_as_output("-o", options.output, inputs);
  refuse_input_as_output("--figure", arguments.figure, inputs);
  refuse_same_output("-o", options.output, "--figure", arguments.figure);
  const EvaluationSettings settings = settings_of(arguments);
  const std::string specimen_id = specimen_of(arguments, inputs);
  Measured result = arguments.photo.empty() ? from_files(arguments, settings) : from_photo(arguments, settings);
  if (!specimen_id.empty()) result.json["specimen_id"] = specimen_id;
  if (!options.output.empty()) write_json(options.output, result.json);
  Console console(options.level());
  for (const std::string& warning : result.warnings) console.message(Severity::Warning, warning);
  print_result(options, result.json);
  if (result.verdict.status() == VerdictStatus::Refused) return kNotAcceptable;
  return status_of(result.evaluation.outcome);
}

}  // namespace

void add_evaluate(Application& application) {
  auto [verb, a] = application.add_verb<EvaluateArguments>(
      "evaluate", "", "incise evaluate cut.jpg --mm-per-pixel 0.03 --red annotation --figure found.png --json", run);
  verb->add_option("photo", a.photo, "Top view of the cut (.png, .jpg, .tif): red incision, green tumour edge");
  verb->add_option("--specimen-id", a.specimen_id,
                   "Whose cut it is, as its case says: calibrate refuses another specimen's")
      ->check(CLI::Validator(
          [](const std::string& text) { return is_specimen_id(text) ? std::string() : std::string(kSpecimenIdForm); },
          "ID"));
  verb->add_option("--incision", a.incision, "The incision: .csv (x_mm,y_mm,z_mm), .vtp or .mrk.json");
  verb->add_option("--tumor", a.tumor, "The tumour edge, same formats and frame");
  verb->add_option(
      "--line", a.line,
      "Instead of --tumor, for an open cut: the line that --incision was to follow, same formats and frame");
  verb->add_option("--contour", a.contour,
                   "What was measured; default: inner_edge in a photograph, centerline in files")
      ->check(name_of_any<ContourKind>());
  verb->add_option("--red", a.red, "What the red line is: a thin line along the inner edge, or the painted kerf")
      ->check(name_of_any<RedLine>());
  add_scale_options(*verb, a.scale);
  verb->add_option("--max-gap-mm", a.max_gap_mm,
                   "A red or green ring with a gap clearly longer (0.18 mm and 2 pixels) is open; of a red one "
                   "slightly longer, the "
                   "verdict says so")
      ->check(between("--max-gap-mm", 0.0, 10.0));
  verb->add_option("--target-mm", a.target_mm, "Distance aimed at; default: 5.0 for a mid-line, 4.5 for an inner edge")
      ->check(above_zero("--target-mm"));
  verb->add_option("--close-margin-mm", a.settings.close_margin_mm, "Clinical cut-off");
  verb->add_option("--approach", a.approach, "Direction in which the camera looks")->expected(3);
  verb->add_option("--twelve-o-clock", a.twelve, "Direction of 12 o'clock in by_clock; default: up in the picture")
      ->expected(3);
  verb->add_option(
      "--figure", a.figure,
      "The photograph with what was found drawn over it (.png); of contours: the signed error in colour (.svg, .png)");
  verb->add_option("--colors", a.colors, "Of the figure: told apart with any colour vision, or as in the paper")
      ->check(name_of_any<ErrorColors>());
  verb->add_flag("--open", a.is_open, "The incision round the tumour is an open curve");
}

}  // namespace incise::cli
