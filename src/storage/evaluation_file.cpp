#include <incise/core/error.hpp>
#include <incise/io/json_text.hpp>
#include <incise/storage/evaluation_file.hpp>
#include <incise/storage/result_json.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kEvaluationHint = "Write the file with `incise evaluate … -o FILE.json`";

/// A file, and where in it one is.
struct Place {
  const std::filesystem::path& path;
  const Json& object;
  std::string prefix;

  [[noreturn]] void refuse(const std::string& key, const std::string& found, const std::string& expected) const {
    throw DataError(path, prefix + key, found, expected, kEvaluationHint);
  }
  [[nodiscard]] const Json& at(const std::string& key, const char* expected) const {
    const auto found = object.find(key);
    if (found == object.end()) refuse(key, "no such key", expected);
    return *found;
  }
  [[nodiscard]] double number(const std::string& key) const {
    const Json& value = at(key, "a number");
    if (!value.is_number()) refuse(key, value.dump().substr(0, 40), "a number");
    return value.get<double>();
  }
  [[nodiscard]] std::string text(const std::string& key) const {
    const Json& value = at(key, "text");
    if (!value.is_string()) refuse(key, value.dump().substr(0, 40), "text");
    return value.get<std::string>();
  }
  [[nodiscard]] std::optional<double> number_or_null(const std::string& key) const {
    return at(key, "a number or null").is_null() ? std::nullopt : std::optional(number(key));
  }
  [[nodiscard]] std::optional<bool> flag_or_null(const std::string& key) const {
    const Json& value = at(key, "true, false or null");
    if (value.is_null()) return std::nullopt;
    if (!value.is_boolean()) refuse(key, value.dump().substr(0, 40), "true, false or null");
    return value.get<bool>();
  }
  [[nodiscard]] std::vector<double> numbers(const std::string& key) const {
    const Json& list = at(key, "a list of numbers");
    if (!list.is_array()) refuse(key, list.dump().substr(0, 40), "a list of numbers");
    std::vector<double> values;
    for (const Json& item : list) {
      if (!item.is_number()) {
        refuse(fmt::format("{}[{}]", key, values.size()), item.dump().substr(0, 40), "a number");
      }
      values.push_back(item.get<double>());
    }
    return values;
  }
  [[nodiscard]] Place inside(const std::string& key) const {
    const Json& value = at(key, "an object");
    if (!value.is_object()) refuse(key, value.is_null() ? "null" : "no object", "an object");
    return {path, value, prefix + key + "."};
  }
};

std::optional<double> zone_border(const Place& zones, const char* name) {
  return zones.at(name, "a zone or null").is_null() ? std::nullopt
                                                    : std::optional(zones.inside(name).number("at_or_below_mm"));
}

void read_points(const Place& file, EvaluationFile& result) {
  const double count = file.number("n_points");
  if (count == 0.0) return;  // no incision was found: a result, without errors
  const Place points = file.inside("points");
  std::vector<double>& errors = result.specimen.signed_error_mm;
  errors = points.numbers("signed_error_mm");
  if (static_cast<double>(errors.size()) != count) {
    points.refuse("signed_error_mm", fmt::format("{} numbers", errors.size()), fmt::format("n_points = {}", count));
  }
  if (errors.size() < 3) points.refuse("signed_error_mm", fmt::format("{} numbers", errors.size()), "at least 3");
  if (!points.object.contains("clock_h")) return;
  result.clock_h = points.numbers("clock_h");
  if (result.clock_h.size() != errors.size()) {
    points.refuse("clock_h", fmt::format("{} numbers", result.clock_h.size()), fmt::format("n_points = {}", count));
  }
  for (const double hour : result.clock_h) {
    if (!(hour >= 0.0 && hour < 12.0)) points.refuse("clock_h", fmt::format("{}", hour), "hours in [0, 12)");
  }
}

}  // namespace

Json points_json(const Evaluation& evaluation) {
  Json json;
  const Points& points = evaluation.errors.points.points;
  const std::array<const char*, 3> names{"x_mm", "y_mm", "z_mm"};
  for (int axis = 0; axis < 3; ++axis) {
    Json list = Json::array();
    for (const Vec3& p : points) list.push_back(p[axis]);
    json[names[static_cast<std::size_t>(axis)]] = std::move(list);
  }
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
  const Place file{path, json, ""};
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
  result.target_mm = file.number("target_mm");
  result.hu_score = file.number_or_null("hu_score");
  result.hu_score_ideal = file.number_or_null("hu_score_ideal");
  result.centroid_shift_mm = file.number_or_null("centroid_shift_mm");
  const Place zones = file.inside("zones");
  result.positive_at_mm = zone_border(zones, "positive_margin");
  result.too_close_at_mm = zone_border(zones, "too_close");
  read_points(file, result);
  return result;
}

}  // namespace incise
