#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/geometry/contour_checks.hpp>
#include <incise/imaging/photo_doubts.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/picture_io.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/report/svg_png.hpp>
#include <incise/steps/cut_steps.hpp>
#include <incise/storage/evaluation_file.hpp>
#include <incise/storage/result_json.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise::steps {
namespace {

using Json = nlohmann::ordered_json;

// In the demo, contours lie 0.1 to 1.4 mm off the edges that belong to them, and 2.4 to 3.5 mm off the case's own.
constexpr double kDoubtfulHeightMm = 2.0;

Json shape_json(const RulerShape& shape) {
  const auto figure = [](const RulerFigure& f) { return Json{{"value", f.value}, {"standard_error", f.error}}; };
  return {{"spacing_change", figure(shape.spacing_change)},
          {"convergence_deg", figure(shape.convergence_deg)},
          {"skew_deg", figure(shape.skew_deg)},
          {"end_stretch", figure(shape.end_stretch)},
          {"bow", figure(shape.bow)}};
}

/// The contours of one evaluation with the signed error in colour, as in the paper's Fig. 6 c, d.
std::string evaluation_figure_svg(const Evaluation& evaluation, const Contour& tumor_edge,
                                  const EvaluationSettings& settings, const std::string& name, ErrorColors colors) {
  ReportIncision incision;
  incision.name = name;
  incision.outcome = evaluation.outcome;
  incision.closed_loop = evaluation.closed_loop;
  incision.negative_margin = evaluation.negative_margin;
  incision.mean_abs_error_mm = evaluation.abs_error_mm->mean;
  incision.target_mm = evaluation.target_mm;
  incision.close_margin_mm = settings.close_margin_mm;
  incision.kerf_allowance_mm = settings.contour == ContourKind::Centerline ? settings.electrode_radius_mm : 0.0;
  incision.measured_contour = settings.contour == ContourKind::Centerline ? "kerf mid-line" : "kerf's inner edge";
  incision.tumor_edge = tumor_edge;
  incision.incision = evaluation.errors.points;
  incision.signed_error_mm = evaluation.errors.signed_error_mm;
  return contour_figure_svg(incision, {.colors = colors, .approach = settings.approach});
}

void write_figure(const std::filesystem::path& path, const std::string& svg) {
  const std::string bytes = path.extension() == ".png" ? png_of_svg(svg) : svg;
  write_atomically(path, bytes);
}

/// Refuses a contour whose measures would be meaningless, and names it.
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

/// Adds the measured points, and the edge that they were measured against, for comparisons place by place.
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
  std::vector<std::string> warnings;  ///< beside the verdict
  Verdict verdict;  ///< of the measurement: whether its numbers can be trusted
  FoundPixels pixels;  ///< of a photograph
};

/// Returns the result of `measure`, also as JSON. The settings are valid here, so a refusal is due to the contours in
/// `file`.
template <typename Measure>
Measured measured(const std::filesystem::path& file, const Measure& measure) {
  try {
    Measured result{measure(), {}, {}, {}, {}};
    result.json = to_json(result.evaluation);
    result.json["points"] = points_json(result.evaluation);
    return result;
  } catch (const InvalidArgument& error) {
    throw DataError(file, "", error);
  }
}

nlohmann::ordered_json marks_json(const std::vector<PhotoMark>& marks) {
  auto json = nlohmann::ordered_json::array();
  for (const PhotoMark& mark : marks)
    json.push_back({{"u_px", mark.at_px.x()}, {"v_px", mark.at_px.y()}, {"longest_mm", mark.longest_mm}});
  return json;
}

/// Red in the tumour may be blood or a cut that went astray, green beside its edge a part of it. No measure shows such
/// marks, so a warning reports them.
void tell(const std::vector<PhotoMark>& marks, const char* mark, const char* place, const char* question,
          std::vector<std::string>& warnings) {
  if (marks.empty()) return;
  const bool is_one = marks.size() == 1;
  warnings.push_back(fmt::format(
      "{} {}{} {} the tumour's edge, the largest {:.2f} mm, at pixel {:.0f}, {:.0f}: {} {} not part of any measure",
      marks.size(), mark, is_one ? "" : "s", place, marks.front().longest_mm, marks.front().at_px.x(),
      marks.front().at_px.y(), question, is_one ? "It is" : "They are"));
}

/// Refuses, before anything is computed, a figure that is neither .svg nor .png, or cannot be written.
void require_figure_file(const std::filesystem::path& path) {
  const std::string ending = path.extension().string();
  if (ending != ".svg" && ending != ".png") {
    throw CaseError("command line", "--figure", fmt::format("'{}'", path.string()), "a name that ends in .svg or .png");
  }
  require_writable(path);
}

void require_one_source(const EvaluateRequest& request) {
  const bool has_files = !request.incision.empty() || !request.tumor.empty() || !request.line.empty();
  const auto refuse = [](const char* field, const char* found, const char* expected) {
    throw CaseError("command line", field, found, expected);
  };
  if (!request.photo.empty() && has_files) refuse("PHOTO", "a photograph and contour files", "only one of the two");
  if (!request.photo.empty()) {
    if (request.is_open)
      refuse("--open", "an open cut in a photograph", "a ring round the tumour; an unfinished ring is measured, too");
    if (request.approach) refuse("--approach", "a direction for a photograph", "none: a photograph is seen from above");
    if (!request.figure.empty() && request.figure.extension() != ".png")
      refuse("--figure", "another kind of file", "a name that ends in .png: the figure is drawn over the photograph");
    return;
  }
  const bool has_line = !request.line.empty();
  if (request.incision.empty() || request.tumor.empty() != has_line)
    refuse("PHOTO", has_line && !request.tumor.empty() ? "--line and --tumor" : "no input",
           "a photograph, or --incision with either --tumor or --line");
  if (has_line && request.settings.target_mm)
    refuse("--target-mm", "a distance", "none: a cut along a line should lie on the line");
  if (has_line && request.settings.twelve_o_clock) refuse("--twelve-o-clock", "a direction", "none: there is no ring");
  if (has_line && !request.figure.empty())
    refuse("--figure", "a file", "none: the figure shows an incision round a tumour");
  if (request.scale.ways() > 0) refuse("scale", "a scale for contour files", "none: they are in mm");
  if (!request.figure.empty()) require_figure_file(request.figure);
}

/// Completes a request with its defaults. @throws CaseError for parts that do not go together.
EvaluateRequest completed(EvaluateRequest request) {
  require_one_source(request);
  request.settings.contour =
      request.contour.value_or(request.photo.empty() ? ContourKind::Centerline : ContourKind::InnerEdge);
  if (request.approach) request.settings.approach = *request.approach;
  const std::vector<Problem> problems = validate(request.settings);
  if (!problems.empty()) throw CaseError("evaluate", problems.front());
  return request;
}

Measured from_photo(const EvaluateRequest& request) {
  const EvaluationSettings& settings = request.settings;
  const ColorPicture picture = decode_picture(read_text(request.photo), request.photo);
  const FoundScale scale = find_scale(request.scale, picture, request.photo);
  // The mid-line of a painted band is the middle of a line.
  const bool wants_border = request.red == RedLine::Kerf && settings.contour == ContourKind::InnerEdge;
  const PhotoSettings photo{.red = wants_border ? RedLine::Kerf : RedLine::Annotation,
                            .max_gap_mm = request.max_gap_mm};
  const PhotoContours found = find_photo_contours(picture, scale.scale, photo, request.photo);
  Measured result = measured(request.photo, [&] { return evaluate(found.incision, found.tumor_edge, settings); });
  add_contours(result.json, result.evaluation, found.tumor_edge, settings.approach);
  result.json["photo"] = request.photo.string();
  result.json["mm_per_pixel"] = found.mm_per_pixel;
  result.json["scale"] = scale.summary;
  result.json["red"] = to_string(request.red);
  result.json["red_line"] = line_json(found.red);
  result.json["green_line"] = line_json(found.green);
  result.json["red_in_tumor"] = marks_json(found.red_in_tumor);
  result.json["green_beside"] = marks_json(found.green_beside);
  tell(found.red_in_tumor, "red spot", "inside", "blood, or a cut?", result.warnings);
  tell(found.green_beside, "green mark", "beside", "a second tumour?", result.warnings);
  if (scale.ruler) add_ruler_doubts(*scale.ruler, result.verdict);
  add_ring_doubts(found, photo.max_gap_mm, result.verdict);
  result.json["verdict"] = to_json(result.verdict);
  if (!request.figure.empty()) {
    const std::string png = encode_png(draw_found(picture, {&found.green, &found.red}, scale.marks_px));
    write_atomically(request.figure, png);
    result.json["figure"] = request.figure.string();
  }
  result.pixels = {scale.marks_px, found.red.points_px, found.red.is_closed, found.green.points_px};
  return result;
}

/// Measures an open cut against the line that it should follow.
Measured from_line(const EvaluateRequest& request) {
  const EvaluationSettings& settings = request.settings;
  const Contour incision = read_contour(request.incision, false);
  const Contour line = read_contour(request.line, false);
  require_usable(incision, "a cut", kLargestIncisionMm, settings.approach, request.incision);
  require_usable(line, "a line", kLargestIncisionMm, settings.approach, request.line);
  return measured(request.line, [&] { return evaluate_line(incision, line, settings); });
}

/// Returns how far the incision lies above the tumour's edge, mm, on average over its points: each against the point of
/// the edge that is nearest to it seen along the approach.
double mean_height_mm(const Contour& incision, const Contour& edge, const Vec3& approach) {
  const ViewFrame view = view_along(approach);
  const Contour flat = flat_in_view(edge, view);
  double sum = 0.0;
  for (const Vec3& p : incision.points) {
    const Vec3 seen = view.to_view(p);
    const ContourPoint nearest = nearest_on(flat, Vec3(seen.x(), seen.y(), 0.0));
    const Vec3& from = edge.points[nearest.segment];
    const Vec3& to = edge.points[(nearest.segment + 1) % edge.points.size()];
    sum += seen.z() - view.to_view(from + nearest.fraction * (to - from)).z();
  }
  return sum / static_cast<double>(incision.points.size());
}

Measured from_files(const EvaluateRequest& request) {
  const EvaluationSettings& settings = request.settings;
  if (!request.line.empty()) return from_line(request);
  const Contour incision = read_contour(request.incision, !request.is_open);
  const Contour tumor_edge = read_contour(request.tumor, true);
  require_usable(incision, "an incision", kLargestIncisionMm, settings.approach, request.incision);
  require_usable(tumor_edge, "a tumour", kLargestTumorMm, settings.approach, request.tumor);
  Measured result = measured(request.tumor, [&] { return evaluate(incision, tumor_edge, settings); });
  add_contours(result.json, result.evaluation, tumor_edge, settings.approach);
  const double height_mm = mean_height_mm(incision, tumor_edge, settings.approach);
  if (std::abs(height_mm) > kDoubtfulHeightMm) {
    result.warnings.push_back(fmt::format(
        "the incision lies {:.1f} mm {} the tumour's edge on average, seen along {} {} {}, and distances are "
        "measured in space. Do both belong to the same tissue: stretched, or after the cut? The edge of "
        "a run's mid-line is plan/tumor_edge.csv, that of its inner edge tumor_edge_final.csv",
        std::abs(height_mm), height_mm < 0.0 ? "below" : "above", settings.approach.x() + 0.0,
        settings.approach.y() + 0.0, settings.approach.z() + 0.0));
  }
  if (!request.figure.empty()) {
    const std::string name = request.incision.stem().string();
    write_figure(request.figure, evaluation_figure_svg(result.evaluation, tumor_edge, settings, name, request.colors));
    result.json["figure"] = request.figure.string();
  }
  return result;
}

/// @throws CaseError if the option names no specimen, or another than the files.
std::string specimen_of(const EvaluateRequest& request, const std::vector<std::filesystem::path>& inputs) {
  if (!request.specimen_id.empty() && !is_specimen_id(request.specimen_id))
    throw CaseError("command line", "--specimen-id", fmt::format("'{}'", request.specimen_id),
                    std::string(kSpecimenIdForm));
  std::string stated = common_specimen_id(inputs);
  if (request.specimen_id.empty()) return stated;
  if (!are_of_different_specimens(request.specimen_id, stated)) return request.specimen_id;
  throw CaseError("command line", "--specimen-id", request.specimen_id, stated + ", which the files state");
}

}  // namespace

void describe(Visitor& v, EvaluateRequest& r) {
  v("specimen_id", r.specimen_id, "Id of the specimen that was cut, as in its case: calibrate refuses any other.");
  v("incision", r.incision, "The incision: .csv (x_mm,y_mm,z_mm), .vtp or .mrk.json.");
  v("tumor", r.tumor, "The tumour edge, in the same formats and frame.");
  v("line", r.line,
    "Instead of --tumor, for an open cut: the line that --incision was to follow, same formats and frame.");
  v("contour", r.contour, "What was measured; default: inner_edge in a photograph, centerline in files.");
  v("red", r.red, "What the red line is: a thin line along the inner edge, or the painted kerf.");
  v("mm_per_pixel", r.scale.mm_per_pixel, "Scale of the photograph.", kPositive);
  v("ruler", r.scale.ruler, "Find the scale in the photograph: a ruler's ticks, or a solid scale bar.");
  v("ruler_mm", r.scale.ruler_mm,
    "Distance between neighbouring finest ticks of the ruler, by default 1 mm; for a bar: its length.", kPositive);
  v("max_gap_mm", r.max_gap_mm,
    "A red or green ring with a clearly longer gap (by 0.18 mm and 2 pixels) is open; if the gap of a red ring is "
    "slightly longer, the verdict says so.",
    {0.0, 10.0});
  v("figure", r.figure,
    "Figure to write: the photograph with the contours found in it (.png); for contour files: the signed error in "
    "colour (.svg, .png).");
  v("colors", r.colors, "Colours of the figure: safe for any colour vision, or as in the paper.");
  v("open", r.is_open, "The incision round the tumour is an open curve.");
}

int ScaleRequest::ways() const {
  return (mm_per_pixel > 0.0) + ruler.has_value() + !two_points.empty() + !rectangle.empty();
}

FoundScale find_scale(const ScaleRequest& request, const ColorPicture& picture, const std::filesystem::path& name) {
  const int ways = request.ways();
  if (ways != 1) {
    throw CaseError("command line", "scale", ways == 0 ? "no scale" : fmt::format("{} scales", ways),
                    "one of --mm-per-pixel, --ruler, --two-points, --rectangle");
  }
  if (request.ruler == RulerKind::Bar && !request.ruler_mm)
    throw CaseError("command line", "--ruler bar", "no length", "the bar's length: --ruler-mm");
  FoundScale found;
  try {
    if (request.mm_per_pixel > 0.0) {
      found.scale = scale_from_mm_per_pixel(request.mm_per_pixel, picture.height);
      found.summary["source"] = "mm_per_pixel";
    } else if (!request.two_points.empty()) {
      const auto& p = request.two_points;
      found.marks_px = {{p[0], p[1]}, {p[2], p[3]}};
      found.scale = scale_from_two_points(found.marks_px[0], found.marks_px[1], p[4], picture.height);
      found.summary["source"] = "two_points";
    } else if (!request.rectangle.empty()) {
      if (request.rectangle_mm.size() != 2)
        throw CaseError("command line", "--rectangle-mm", "nothing", "the rectangle's width and height");
      for (std::size_t i = 0; i < 4; ++i)
        found.marks_px.emplace_back(request.rectangle[2 * i], request.rectangle[2 * i + 1]);
      found.scale = scale_from_rectangle({found.marks_px[0], found.marks_px[1], found.marks_px[2], found.marks_px[3]},
                                         request.rectangle_mm[0], request.rectangle_mm[1]);
      found.summary["source"] = "rectangle";
    }
  } catch (const InvalidArgument& error) {
    throw CaseError("command line", "scale", "points or lengths that give no scale",
                    "points and lengths that give a scale", error.as_hint());
  }
  if (!request.ruler) return found;
  const Ruler ruler = find_ruler(picture, *request.ruler, request.ruler_mm, name);
  found.scale = scale_from_mm_per_pixel(ruler.mm_per_pixel, picture.height);
  found.marks_px = ruler.marks_px;
  found.summary = {{"source", "ruler"}, {"marks", ruler.marks_px.size()}, {"error_percent", ruler.error_percent}};
  found.summary["shape"] = ruler.shape ? shape_json(*ruler.shape) : Json(nullptr);
  found.ruler = ruler;
  return found;
}

EvaluatedCut evaluate_in_pixels(const EvaluateRequest& asked, const StepContext& context) {
  const EvaluateRequest request = completed(asked);
  const std::vector<std::filesystem::path> inputs{request.photo, request.incision, request.tumor, request.line};
  const std::string specimen_id = specimen_of(request, inputs);
  Measured found = request.photo.empty() ? from_files(request) : from_photo(request);
  found.json["warnings"] = found.warnings;
  if (!specimen_id.empty()) found.json["specimen_id"] = specimen_id;
  if (!request.output.empty()) write_json(request.output, found.json);
  for (const std::string& warning : found.warnings) context.monitor.message(Severity::Warning, warning);
  report_reasons(found.verdict, context.monitor);
  const bool is_refused = found.verdict.status() == VerdictStatus::Refused;
  const bool is_acceptable = found.evaluation.outcome == Outcome::Success && !is_refused;
  return {{std::move(found.json), is_acceptable}, std::move(found.pixels)};
}

StepResult evaluate_cut(const EvaluateRequest& request, const StepContext& context) {
  return evaluate_in_pixels(request, context).step;
}

}  // namespace incise::steps
