#include "io/number_text.hpp"
#include "io/vtk_xml_reader.hpp"

#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/table_io.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace incise {
namespace {

constexpr std::array<std::string_view, 3> kPointColumns{"x_mm", "y_mm", "z_mm"};

Contour read_csv(const std::filesystem::path& path, bool is_closed) {
  const std::vector<std::vector<double>> columns = read_csv_columns(path, {kPointColumns.begin(), kPointColumns.end()});
  Contour contour{{}, is_closed};
  for (std::size_t i = 0; i < columns[0].size(); ++i)
    contour.points.emplace_back(columns[0][i], columns[1][i], columns[2][i]);
  return contour;
}

[[noreturn]] void refuse_kind(const std::filesystem::path& path, const std::string& place, bool found_closed) {
  throw DataError(path, place, found_closed ? "a closed curve" : "an open curve",
                  found_closed ? "an open curve" : "a closed curve");
}

/// @param says_closed  becomes true where the last index repeats the first.
Contour read_polyline(const std::filesystem::path& path, bool is_closed, bool& says_closed) {
  const io_detail::VtkXmlFile file(path, "PolyData");
  const Points points = file.points();
  if (file.count("NumberOfLines") != 1) {
    throw DataError(path, "<Lines>", fmt::format("{} polylines", file.count("NumberOfLines")), "one polyline");
  }
  std::vector<double> indices = file.array("Lines", "connectivity");
  const bool repeats_first = indices.size() > 2 && indices.front() == indices.back();
  if (repeats_first && !is_closed) refuse_kind(path, "<Lines>", true);
  if (repeats_first) indices.pop_back();
  says_closed = repeats_first;
  Contour contour{{}, is_closed};
  for (const double index : indices) {
    if (!(index >= 0.0 && index < static_cast<double>(points.size()))) {
      throw DataError(path, "<Lines>", fmt::format("point index {}", index),
                      fmt::format("an index below {}", points.size()));
    }
    contour.points.push_back(points[static_cast<std::size_t>(index)]);
  }
  return contour;
}

/// Refuses a closed curve whose ends are much farther apart than neighbouring points.
void require_closing(const Contour& contour, const std::filesystem::path& path) {
  constexpr double kWidestGap = 4.0;  // times the longest distance between neighbours
  if (!contour.is_closed || contour.points.size() < 3) return;
  double longest_mm = 0.0;
  for (std::size_t i = 0; i + 1 < contour.points.size(); ++i) {
    longest_mm = std::max(longest_mm, (contour.points[i + 1] - contour.points[i]).norm());
  }
  const double gap_mm = (contour.points.front() - contour.points.back()).norm();
  if (!(gap_mm > kWidestGap * longest_mm)) return;
  throw DataError(
      path, "",
      fmt::format("ends {:.3g} mm apart, where neighbouring points are at most {:.3g} mm apart", gap_mm, longest_mm),
      "a closed curve", "`incise evaluate --open` takes an open incision");
}

/// The parts of Slicer's markups that are read.
struct ControlPoint {
  Vec3 position = Vec3::Zero();
  std::optional<std::string> status;
};
void describe(Visitor& v, ControlPoint& p) {
  v("position", p.position);
  v("positionStatus", p.status);
  if (p.status && *p.status != "defined") v.refuse({"positionStatus"}, '"' + *p.status + '"', "defined");
}
struct Markup {
  bool is_closed = false, is_ras = false;
  std::vector<ControlPoint> points;
};
void describe(Visitor& v, Markup& m) {
  static constexpr std::array<std::string_view, 2> kTypes{"Curve", "ClosedCurve"};
  std::size_t type = 0;
  v.choice({"type"}, type, kTypes);
  m.is_closed = type == 1;
  static constexpr std::array<std::string_view, 4> kSystems{"RAS", "0", "LPS", "1"};  // numbers in older versions
  std::size_t system = 2;
  if (v.optional({"coordinateSystem"}, true)) v.choice({"coordinateSystem"}, system, kSystems);
  m.is_ras = system < 2;
  std::optional<std::vector<std::string>> units;  // one text, or a list of code, scheme and meaning
  v("coordinateUnits", units);
  if (units && std::find(units->begin(), units->end(), "mm") == units->end())
    v.refuse({"coordinateUnits"}, fmt::format("{}", fmt::join(*units, ", ")), "mm");
  v("controlPoints", m.points);
}
struct Markups {
  std::vector<Markup> markups;
};
void describe(Visitor& v, Markups& m) {
  v("markups", m.markups);
}

/// Unifies what versions of Slicer write in two forms: turns a number into text, and a single unit into a list.
nlohmann::ordered_json in_one_form(nlohmann::ordered_json document) {
  if (!document.is_object() || !document.contains("markups") || !document["markups"].is_array()) return document;
  for (auto& markup : document["markups"]) {
    if (!markup.is_object()) continue;
    if (markup.contains("coordinateSystem") && markup["coordinateSystem"].is_number())
      markup["coordinateSystem"] = fmt::format("{}", markup["coordinateSystem"].get<double>());
    if (markup.contains("coordinateUnits") && markup["coordinateUnits"].is_string())
      markup["coordinateUnits"] = {markup["coordinateUnits"]};
  }
  return document;
}

Contour read_slicer_markup(const std::filesystem::path& path, bool is_closed) {
  const auto file = from_json<Markups>(in_one_form(read_json(path)), path);
  if (file.markups.size() != 1)
    throw DataError(path, "/markups", fmt::format("{} markups", file.markups.size()), "one curve");
  const Markup& markup = file.markups.front();
  if (markup.is_closed != is_closed) refuse_kind(path, "/markups/0/type", !is_closed);
  Contour contour{{}, is_closed};
  for (const ControlPoint& control : markup.points) contour.points.push_back(control.position);
  if (markup.is_ras) io_detail::turn_over(contour.points);
  return contour;
}

}  // namespace

Contour read_contour(const std::filesystem::path& path, bool is_closed) {
  const std::string name = io_detail::lower_case(path.filename().string());
  Contour contour;
  bool says_closed = name.ends_with(".mrk.json");
  if (name.ends_with(".csv"))
    contour = read_csv(path, is_closed);
  else if (name.ends_with(".vtp"))
    contour = read_polyline(path, is_closed, says_closed);
  else if (name.ends_with(".mrk.json"))
    contour = read_slicer_markup(path, is_closed);
  else
    throw DataError(path, "", fmt::format("the ending '{}'", path.extension().string()), ".csv, .vtp or .mrk.json");
  Points& points = contour.points;
  const bool repeats_first = points.size() > 1 && points.front() == points.back();
  if (!says_closed && !repeats_first) require_closing(contour, path);
  if (is_closed && repeats_first) points.pop_back();
  const std::size_t least = is_closed ? 3 : 2;
  if (points.size() < least) {
    throw DataError(path, "", fmt::format("{} points", points.size()),
                    fmt::format("at least {} for {} contour", least, is_closed ? "a closed" : "an open"));
  }
  return contour;
}

void write_contour_csv(const std::filesystem::path& path, const Contour& contour,
                       const std::vector<NamedColumn>& columns) {
  std::vector<NamedColumn> all;
  for (std::size_t k = 0; k < 3; ++k) {
    NamedColumn& column = all.emplace_back(kPointColumns[k], std::vector<double>{});
    for (const Vec3& p : contour.points) column.second.push_back(p[static_cast<Eigen::Index>(k)]);
  }
  all.insert(all.end(), columns.begin(), columns.end());
  write_csv_columns(path, all);
}

void write_contour_vtp(const std::filesystem::path& path, const Contour& contour,
                       const std::map<std::string, DataArray>& point_data) {
  write_vtp(path, std::span(&contour, 1), point_data);
}

}  // namespace incise
