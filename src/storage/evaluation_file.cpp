#include "storage/json_place.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/contour_checks.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/io/verdict_json.hpp>
#include <incise/storage/evaluation_file.hpp>
#include <incise/storage/result_json.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 3> kCoordinates{"x_mm", "y_mm", "z_mm"};
constexpr double kFarthestPlaceMm = 1e5;   // from a scan's or a robot's origin
constexpr double kLongestDirection = 1e6;  // and its inverse the shortest
constexpr const char* kEvaluationHint = "Write the file with `incise evaluate … -o FILE.json`";

std::optional<double> zone_border(const JsonPlace& zones, const char* name) {
  return zones.at(name, "a zone or null").is_null() ? std::nullopt
                                                    : std::optional(zones.inside(name).number("at_or_below_mm"));
}

void read_points(const JsonPlace& file, EvaluationFile& result) {
  const double count = file.number("n_points");
  if (count == 0.0) return;  // no incision was found: a result, without errors
  const JsonPlace points = file.inside("points");
  std::vector<double>& errors = result.specimen.signed_error_mm;
  errors = points.numbers("signed_error_mm");
  if (static_cast<double>(errors.size()) != count) {
    points.refuse("signed_error_mm", fmt::format("{} numbers", errors.size()), fmt::format("n_points = {}", count));
  }
  if (errors.size() < 3) points.refuse("signed_error_mm", fmt::format("{} numbers", errors.size()), "at least 3");
  for (const double error : errors) {
    if (std::abs(error) > kLargestBodyMm) points.refuse("signed_error_mm", fmt::format("{:.4g}", error), fmt::format("distances within {} mm", kLargestBodyMm));
  }
  if (!points.object.contains("clock_h")) return;
  result.clock_h = points.numbers("clock_h");
  if (result.clock_h.size() != errors.size()) {
    points.refuse("clock_h", fmt::format("{} numbers", result.clock_h.size()), fmt::format("n_points = {}", count));
  }
  for (const double hour : result.clock_h) {
    if (!(hour >= 0.0 && hour < 12.0)) points.refuse("clock_h", fmt::format("{}", hour), "hours in [0, 12)");
  }
}

/// What a photograph of a cut cannot show is no measurement of one.
void require_size(const JsonPlace& file, const char* key, const Contour& contour, const char* what, double largest_mm) {
  if (const auto problem = size_problem(contour, what, largest_mm)) file.refuse(key, problem->found, problem->expected);
}

Vec3 direction_of(const JsonPlace& file, const char* key) {
  const std::vector<double> numbers = file.numbers(key);
  if (numbers.size() != 3) file.refuse(key, fmt::format("{} numbers", numbers.size()), "3");
  const Vec3 direction(numbers.data());
  const double length = direction.norm();
  if (!(length >= 1.0 / kLongestDirection && length <= kLongestDirection))
    file.refuse(key, fmt::format("a vector of length {:.4g}", length), "a direction");
  return direction / length;
}

/// A photograph whose scale or perspective is wrong has numbers, but none that a comparison or a calibration may use.
void require_not_refused(const Json& json, const std::filesystem::path& path) {
  if (!json.contains("verdict")) return;  // of contours, or of a version before verdicts
  const Verdict verdict = verdict_from_json(json.at("verdict"), path);
  if (verdict.status() != VerdictStatus::Refused) return;
  const VerdictReason& worst = verdict.reasons().front();
  throw DataError(path, "verdict", fmt::format("a refused measurement ({}: {})", worst.id, worst.message),
                  "a measurement that is ok or a caution", "Take the photograph again, or give its scale another way.");
}

}  // namespace

Json contour_json(const Contour& contour) {
  Json json;
  for (int axis = 0; axis < 3; ++axis) {
    Json list = Json::array();
    for (const Vec3& p : contour.points) list.push_back(p[axis]);
    json[kCoordinates[static_cast<std::size_t>(axis)]] = std::move(list);
  }
  return json;
}

Contour contour_of(const JsonPlace& place) {
  const std::vector<double> x = place.numbers("x_mm");
  const std::vector<double> y = place.numbers("y_mm");
  const std::vector<double> z = place.numbers("z_mm");
  if (x.size() < 3) place.refuse("x_mm", fmt::format("{} numbers", x.size()), "at least 3");
  if (y.size() != x.size()) place.refuse("y_mm", fmt::format("{} numbers", y.size()), fmt::format("{} as x_mm", x.size()));
  if (z.size() != x.size()) place.refuse("z_mm", fmt::format("{} numbers", z.size()), fmt::format("{} as x_mm", x.size()));
  Contour contour;
  for (std::size_t i = 0; i < x.size(); ++i) {
    contour.points.emplace_back(x[i], y[i], z[i]);
    for (std::size_t axis = 0; axis < kCoordinates.size(); ++axis) {
      const double coordinate = contour.points.back()[static_cast<Eigen::Index>(axis)];
      if (std::abs(coordinate) <= kFarthestPlaceMm) continue;
      place.refuse(fmt::format("{}[{}]", kCoordinates[axis], i), fmt::format("{:.4g}", coordinate),
                   fmt::format("a place within {} mm of the origin", kFarthestPlaceMm));
    }
  }
  return contour;
}

Json points_json(const Evaluation& evaluation) {
  const Points& points = evaluation.errors.points.points;
  Json json = contour_json(evaluation.errors.points);
  Json arclengths = Json::array();
  double arclength = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0) arclength += (points[i] - points[i - 1]).norm();
    arclengths.push_back(arclength);
  }
  json["arclength_mm"] = std::move(arclengths);
  json["signed_error_mm"] = evaluation.errors.signed_error_mm;
  if (!evaluation.clock_h.empty()) json["clock_h"] = evaluation.clock_h;
  return json;
}

EvaluationFile read_evaluation_file(const std::filesystem::path& path) {
  const Json json = read_json(path);
  if (!json.is_object()) throw DataError(path, "", "no object", "the result of an evaluation", kEvaluationHint);
  const JsonPlace file{path, json, "", kEvaluationHint};
  require_not_refused(json, path);
  EvaluationFile result;
  result.specimen.name = path.stem().string();
  static_cast<void>(file.text("outcome"));
  result.outcome = read_outcome(json, "outcome", path);
  result.specimen.is_ring = file.flag_or_null("closed_loop").value_or(false);
  result.negative_margin = file.flag_or_null("negative_margin");
  result.contour = file.text("contour");
  if (result.contour != to_string(ContourKind::Centerline) && result.contour != to_string(ContourKind::InnerEdge)) {
    file.refuse("contour", result.contour.substr(0, 40), "centerline or inner_edge");
  }
  result.target_mm = file.number_between("target_mm", -kLargestBodyMm, kLargestBodyMm);
  result.hu_score = file.number_or_null("hu_score");
  result.hu_score_ideal = file.number_or_null("hu_score_ideal");
  result.centroid_shift_mm = file.number_or_null("centroid_shift_mm");
  const JsonPlace zones = file.inside("zones");
  result.positive_at_mm = zone_border(zones, "positive_margin");
  result.too_close_at_mm = zone_border(zones, "too_close");
  read_points(file, result);
  return result;
}

PhotographedCut read_photographed_cut(const std::filesystem::path& path) {
  const EvaluationFile evaluation = read_evaluation_file(path);
  const Json json = read_json(path);
  const JsonPlace file{path, json, "", kEvaluationHint};
  if (!file.flag_or_null("closed_loop").value_or(false)) {
    file.refuse("closed_loop", file.at("closed_loop", "true").dump(), "true: an incision is compared all round");
  }
  if (evaluation.contour != to_string(ContourKind::InnerEdge)) {
    file.refuse("contour", evaluation.contour, "inner_edge, as a photograph shows it");
  }
  PhotographedCut cut;
  cut.name = evaluation.specimen.name;
  cut.incision = contour_of(file.inside("points"));
  cut.tumor_edge = contour_of(file.inside("tumor_edge"));
  require_size(file, "points", cut.incision, "an incision", kLargestIncisionMm);
  require_size(file, "tumor_edge", cut.tumor_edge, "a tumour", kLargestTumorMm);
  Contour both = cut.incision;
  both.points.insert(both.points.end(), cut.tumor_edge.points.begin(), cut.tumor_edge.points.end());
  require_size(file, "tumor_edge", both, "an incision with its tumour", kLargestIncisionMm);
  cut.approach = direction_of(file, "approach");
  return cut;
}

}  // namespace incise
