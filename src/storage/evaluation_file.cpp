#include <incise/core/described_json.hpp>
#include <incise/core/direction.hpp>
#include <incise/core/error.hpp>
#include <incise/geometry/contour_checks.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/storage/evaluation_file.hpp>

#include <fmt/format.h>

namespace incise {
namespace {

constexpr Range kPlaceMm{-1e5, 1e5};  // from a scan's or a robot's origin
constexpr Range kDistanceMm{-kLargestBodyMm, kLargestBodyMm};
constexpr double kMostPoints = 1e5;  // at 0.25 mm: 25 m of contour; the comparison's bootstrap draws them many times
constexpr const char* kEvaluationHint = "Write the file with `incise evaluate … -o FILE.json`";

void require_all(const Visitor& v, std::string_view name, const std::vector<double>& values, const Range& range) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (v.sets() && !contains(range, values[i]))
      v.refuse({fmt::format("{}/{}", name, i)}, fmt::format("{:.4g}", values[i]), describe(range));
}

void require_size(const Visitor& v, const char* name, const std::vector<double>& values, std::size_t size) {
  if (values.size() != size) v.refuse({name}, fmt::format("{} numbers", values.size()), fmt::format("{}", size));
}

/// A contour in the form of an evaluation's file: equally long lists of coordinates.
struct CoordinateLists {
  Contour contour;
};
void describe(Visitor& v, CoordinateLists& c) {
  constexpr std::array<const char*, 3> kNames{"x_mm", "y_mm", "z_mm"};
  std::array<std::vector<double>, 3> lists;
  for (const Vec3& p : c.contour.points)
    for (int axis = 0; axis < 3; ++axis) lists[static_cast<std::size_t>(axis)].push_back(p[axis]);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    v({kNames[axis], "Coordinates of the points.", "mm"}, lists[axis]);
    require_all(v, kNames[axis], lists[axis], kPlaceMm);
    if (v.sets()) require_size(v, kNames[axis], lists[axis], lists[0].size());
  }
  if (!v.sets()) return;
  if (lists[0].size() < 3) v.refuse({kNames[0]}, fmt::format("{} numbers", lists[0].size()), "at least 3");
  c.contour = Contour{};
  for (std::size_t i = 0; i < lists[0].size(); ++i)
    c.contour.points.emplace_back(lists[0][i], lists[1][i], lists[2][i]);
}

/// The points of an evaluation, without their coordinates.
struct PointErrors {
  std::vector<double> signed_error_mm, clock_h;
};
void describe(Visitor& v, PointErrors& p) {
  v({"signed_error_mm", "Signed error of each point; positive: farther from the tumour than intended.", "mm"},
    p.signed_error_mm);
  std::optional<std::vector<double>> clock_h = p.clock_h.empty() ? std::nullopt : std::optional(p.clock_h);
  if (v.sets() || clock_h) v({"clock_h", "Clock position of each point over the tumour.", "h"}, clock_h);
  if (!v.sets()) return;
  p.clock_h = clock_h.value_or(std::vector<double>{});
  if (p.signed_error_mm.size() < 3)
    v.refuse({"signed_error_mm"}, fmt::format("{} numbers", p.signed_error_mm.size()), "at least 3");
  require_all(v, "signed_error_mm", p.signed_error_mm, kDistanceMm);
  require_all(v, "clock_h", p.clock_h, {0.0, 12.0, false, true});
}

/// The part of a zone that is read.
struct ZoneBorder {
  double at_or_below_mm = 0.0;
};
void describe(Visitor& v, ZoneBorder& z) {
  v({"at_or_below_mm", "Upper border of the zone.", "mm"}, z.at_or_below_mm, kDistanceMm);
}

/// Refuses a refused measurement: if a photograph's scale or perspective is wrong, its numbers must not be used.
void require_not_refused(const std::optional<Verdict>& verdict, const std::filesystem::path& path) {
  if (!verdict || verdict->status() != VerdictStatus::Refused) return;
  const VerdictReason& worst = verdict->reasons().front();
  throw DataError(path, "/verdict", fmt::format("a refused measurement ({}: {})", worst.id, worst.message),
                  "a measurement that is ok or a caution", "Take the photograph again, or give its scale another way.");
}

/// The contours of a photographed cut.
struct PhotographedContours {
  CoordinateLists points, tumor_edge;
  Vec3 approach = Vec3::Zero();
};
void describe(Visitor& v, PhotographedContours& c) {
  v("points", c.points, "Contour of the incision.");
  v("tumor_edge", c.tumor_edge, "Edge of the tumour.");
  v("approach", c.approach, "Direction in which the camera looked.");
  if (v.sets() && !is_direction(std::span<const double, 3>(c.approach.data(), 3)))
    v.refuse({"approach"}, fmt::format("a vector of length {:.4g}", c.approach.norm()), kDirectionText);
}

/// Refuses a contour of a size that a photograph of a cut cannot show.
void require_size(const Contour& contour, const char* what, double largest_mm, const std::filesystem::path& path,
                  const char* place) {
  if (const auto problem = size_problem(contour, what, largest_mm))
    throw DataError(path, place, problem->found, problem->expected, kEvaluationHint);
}

}  // namespace

nlohmann::ordered_json contour_json(const Contour& contour) {
  return to_json(CoordinateLists{contour});
}

nlohmann::ordered_json points_json(const Evaluation& evaluation) {
  nlohmann::ordered_json json = contour_json(evaluation.errors.points);
  json["arclength_mm"] = arclengths_mm(evaluation.errors.points.points);
  json.update(to_json(PointErrors{evaluation.errors.signed_error_mm, evaluation.clock_h}));
  return json;
}

void describe(Visitor& v, EvaluationFile& f) {
  v("outcome", f.outcome, "How the cut ended.");
  std::optional<bool> closed_loop = f.specimen.is_ring;
  v("closed_loop", closed_loop, "Whether the ring closed.");
  f.specimen.is_ring = closed_loop.value_or(false);
  v("negative_margin", f.negative_margin, "Whether tissue remains all round the tumour edge.");
  v("contour", f.contour, "Which line of the cut was measured.");
  v({"target_mm", "Intended distance of that line from the tumour edge.", "mm"}, f.target_mm, kDistanceMm);
  v("hu_score", f.hu_score, "Hu score of tumour edge and incision.", kNotNegative);
  v("hu_score_ideal", f.hu_score_ideal, "Hu score that the ideal offset would have.", kNotNegative);
  v({"centroid_shift_mm", "Distance between the centres of the two filled shapes.", "mm"}, f.centroid_shift_mm,
    {0.0, kLargestBodyMm});
  std::optional<ZoneBorder> positive, too_close;
  v.begin({"zones"});
  v("positive_margin", positive, "Zone in which no tissue is left.");
  v("too_close", too_close, "Zone in which too little tissue is left.");
  v.end();
  if (positive) f.positive_at_mm = positive->at_or_below_mm;
  if (too_close) f.too_close_at_mm = too_close->at_or_below_mm;
  std::size_t count = f.specimen.signed_error_mm.size();
  v("n_points", count, "Number of points at which the error was measured.", {0.0, kMostPoints});
  v("verdict", f.verdict, "Verdict on the measurement.");
  if (count == 0 && f.outcome == Outcome::Success && v.sets())
    v.refuse({"n_points"}, "0 with the outcome success", "the points of the incision");
  if (f.outcome == Outcome::Success && closed_loop == false && v.sets())
    v.refuse({"closed_loop"}, "false with the outcome success", "true, or null for an open cut");
  if (count == 0) return;  // no incision was found: a result, without errors
  PointErrors points{f.specimen.signed_error_mm, f.clock_h};
  v("points", points, "Errors, point by point.");
  require_size(v, "points/signed_error_mm", points.signed_error_mm, count);
  if (!points.clock_h.empty()) require_size(v, "points/clock_h", points.clock_h, count);
  f.specimen.signed_error_mm = std::move(points.signed_error_mm);
  f.clock_h = std::move(points.clock_h);
}

EvaluationFile read_evaluation_file(const std::filesystem::path& path) {
  EvaluationFile result = from_json<EvaluationFile>(read_json(path), path, {}, kEvaluationHint);
  require_not_refused(result.verdict, path);
  result.specimen.name = path.stem().string();
  return result;
}

PhotographedCut read_photographed_cut(const std::filesystem::path& path) {
  const EvaluationFile evaluation = read_evaluation_file(path);
  if (!evaluation.specimen.is_ring)
    throw DataError(path, "/closed_loop", "no closed ring", "true: an incision is compared all round", kEvaluationHint);
  if (evaluation.contour != ContourKind::InnerEdge)
    throw DataError(path, "/contour", std::string(to_string(evaluation.contour)),
                    "inner_edge, as a photograph shows it", kEvaluationHint);
  const auto contours = from_json<PhotographedContours>(read_json(path), path, {}, kEvaluationHint);
  PhotographedCut cut;
  cut.name = evaluation.specimen.name;
  cut.incision = contours.points.contour;
  cut.tumor_edge = contours.tumor_edge.contour;
  cut.approach = contours.approach.normalized();
  require_size(cut.incision, "an incision", kLargestIncisionMm, path, "/points");
  require_size(cut.tumor_edge, "a tumour", kLargestTumorMm, path, "/tumor_edge");
  Contour both = cut.incision;
  both.points.insert(both.points.end(), cut.tumor_edge.points.begin(), cut.tumor_edge.points.end());
  require_size(both, "an incision with its tumour", kLargestIncisionMm, path, "/tumor_edge");
  return cut;
}

}  // namespace incise
