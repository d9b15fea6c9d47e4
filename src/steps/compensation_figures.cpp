#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/table_io.hpp>
#include <incise/report/number_text.hpp>
#include <incise/steps/compensation_figures.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>

namespace incise::steps {
namespace {

using Json = nlohmann::ordered_json;

/// Returns compensate.json if it is of a correction with passes, else null.
Json correction_record(const std::filesystem::path& root) {
  const std::filesystem::path file = root / "correction" / "compensate.json";
  if (!std::filesystem::exists(file)) return nullptr;
  Json json = read_json(file);
  return json.contains("history") ? json : Json(nullptr);
}

std::string name_of_pass(std::size_t pass) {
  return pass == 0 ? std::string("as planned") : fmt::format("pass {}", pass);
}

LinePlot errors_along(const std::filesystem::path& root) {
  LinePlot plot{.title = "Error along the path, pass by pass (simulated)",
                .x_label = "distance along the intended path, mm",
                .y_label = "signed error, mm (positive: farther from the tumour)",
                .series = {}};
  const std::filesystem::path file = root / "correction" / "errors.csv";
  const auto columns = read_csv_columns(file, {"pass", "along_mm", "signed_error_mm"});
  struct Point {
    double pass, along, error;
  };
  std::vector<Point> points;
  for (std::size_t i = 0; i < columns[0].size(); ++i) points.push_back({columns[0][i], columns[1][i], columns[2][i]});
  std::stable_sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
    return a.pass < b.pass || (a.pass == b.pass && a.along < b.along);
  });
  double last = -1.0;
  for (const Point& point : points) {
    if (point.pass != last) plot.series.push_back({name_of_pass(static_cast<std::size_t>(point.pass)), {}, {}, true});
    last = point.pass;
    plot.series.back().add(point.along, point.error);
  }
  return plot;
}

LinePlot convergence(const Json& record) {
  LinePlot plot{
      .title = "Mean error by pass (simulated)", .x_label = "pass (0: as planned)", .y_label = "mm", .series = {}};
  LineSeries mean{"mean |error|", {}, {}, true};
  LineSeries smooth{"mean |error| averaged along the path", {}, {}, true};
  const Json& history = record.at("history");
  for (std::size_t k = 0; k < history.size(); ++k) {
    if (history[k].at("mean_abs_error_mm").is_null()) continue;
    mean.add(static_cast<double>(k), history[k].at("mean_abs_error_mm"));
    smooth.add(static_cast<double>(k), history[k].at("smooth_error_mm"));
  }
  plot.series = {mean, smooth};
  if (record.at("floor_mm").is_number()) {
    const double floor = record.at("floor_mm");
    plot.series.push_back({"mesh resolution", {0.0, static_cast<double>(history.size() - 1)}, {floor, floor}, true});
  }
  return plot;
}

/// How far each waypoint of the corrected and of the robust path lies from its intended place.
std::optional<CompensationFigure> robust_offsets(const std::filesystem::path& root) {
  const std::filesystem::path file = root / "robust" / "robust.json";
  if (!std::filesystem::exists(file)) return std::nullopt;
  const Json json = read_json(file);
  LinePlot plot{.title = "Offset of the waypoints from the path as planned (simulated)",
                .x_label = "waypoint",
                .y_label = "offset, mm (positive: away from the tumour)",
                .series = {}};
  for (const auto& [key, name] : {std::pair{"corrected_offset_mm", "corrected"}, std::pair{"offset_mm", "robust"}}) {
    if (!json.is_object() || !json.contains(key) || !json.at(key).is_array())
      throw DataError(file, key, "no list of numbers", "a list of numbers, as `incise compensate --robust` writes it");
    LineSeries series{name, {}, json.at(key).get<std::vector<double>>(), true};
    for (std::size_t i = 0; i < series.y.size(); ++i) series.x.push_back(static_cast<double>(i));
    plot.series.push_back(std::move(series));
  }
  return CompensationFigure{"compensation_robust.svg", std::move(plot)};
}

std::string cell_of(const Json& number) {
  return number.is_null() ? std::string("–") : measure_text(number.get<double>(), "mm");
}

}  // namespace

std::vector<CompensationFigure> compensation_figures(const std::filesystem::path& root) {
  const Json record = correction_record(root);
  if (record.is_null() || record.at("history").at(0).at("mean_abs_error_mm").is_null()) return {};
  std::vector<CompensationFigure> figures{{"compensation_errors.svg", errors_along(root)},
                                          {"compensation_convergence.svg", convergence(record)}};
  if (std::optional<CompensationFigure> robust = robust_offsets(root)) figures.push_back(std::move(*robust));
  return figures;
}

ReportTable compensation_table(const std::filesystem::path& root) {
  ReportTable table{"Correction, pass by pass (simulated)",
                    {"cut", "mean |error|, mm", "greatest, mm", "averaged along the path, mm", "greatest move, mm",
                     "ended in success", "kept"},
                    {}};
  const Json record = correction_record(root);
  if (record.is_null()) return table;
  const Json& history = record.at("history");
  for (std::size_t k = 0; k < history.size(); ++k) {
    const Json& pass = history[k];
    table.rows.push_back({name_of_pass(k), cell_of(pass.at("mean_abs_error_mm")), cell_of(pass.at("max_abs_error_mm")),
                          cell_of(pass.at("smooth_error_mm")), cell_of(pass.at("max_move_mm")),
                          pass.at("success").get<bool>() ? "yes" : "no",
                          record.at("best_pass").get<std::size_t>() == k ? "kept" : ""});
  }
  if (record.at("floor_mm").is_number()) {
    table.rows.push_back({"mesh-resolution limit: fixed tissue", cell_of(record.at("floor_mm")), "", "", "", "", ""});
  }
  return table;
}

std::vector<std::filesystem::path> write_compensation_figures(const std::filesystem::path& root,
                                                              const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> written;
  for (const CompensationFigure& figure : compensation_figures(root)) {
    make_folder(folder);
    const std::string svg = line_plot_svg(figure.plot);
    written.push_back(folder / figure.file);
    write_atomically(written.back(), svg);
  }
  return written;
}

}  // namespace incise::steps
