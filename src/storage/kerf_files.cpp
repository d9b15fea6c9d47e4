#include "kerf_files.hpp"

#include "json_values.hpp"

#include <incise/io/contour_io.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/table_io.hpp>

#include <fmt/format.h>

namespace incise {
namespace {

using Json = nlohmann::ordered_json;

const std::vector<std::string> kDepthColumns{"x_mm", "y_mm", "z_mm", "arclength_mm", "depth_mm", "planned_mm"};
const std::vector<std::string> kLagColumns{"time_s", "arclength_mm", "lag_mm", "drift_mm"};

Json spread_json(const Spread& spread) {
  return {{"mean", spread.mean}, {"min", spread.min}, {"max", spread.max}};
}

Json manifoldness_json(const Manifoldness& found) {
  return {{"triangles", found.triangles},
          {"open_edges", found.open_edges},
          {"nonmanifold_edges", found.nonmanifold_edges},
          {"pinched_vertices", found.pinched_vertices}};
}

Json layer_json(const KerfLayer& layer, const LayerErrors& errors) {
  Json json;
  json["depth_mm"] = layer.depth_mm;
  json["within_plan"] = layer.is_within_plan;
  json["closed_loop"] = or_null(layer.is_closed);
  json["gap_mm"] = or_null(layer.gap_mm);
  json["kerf_width_mm"] = layer.width_mm;
  json["signed_error_mm"] = summary_json(errors.signed_error_mm);
  json["abs_error_mm"] = summary_json(errors.abs_error_mm);
  return json;
}

Json deep_margin_json(const DeepMargin& margin) {
  Json json;
  json["nearest"] = margin.nearest_mm;
  json["beside"] = or_null(margin.beside_mm);
  json["beneath"] = or_null(margin.beneath_mm);
  json["floor_below"] = spread_json(margin.floor_below_mm);
  return json;
}

std::string layer_file(double depth_mm) {
  return fmt::format("centerline_{}mm.csv", depth_mm);
}

void write_if_there(const std::filesystem::path& file, const std::optional<Contour>& contour) {
  if (contour) write_contour_csv(file, *contour);
}

}  // namespace

void add_kerf_json(Json& json, const SimulatedCut& cut) {
  const KerfMeasures& kerf = cut.incision.kerf;
  json["kerf"] = manifoldness_json(kerf.body.boundary);
  json["kerf"]["volume_mm3"] = kerf.body.volume_mm3;
  json["live_skin"] = manifoldness_json(kerf.body.live_skin);
  json["layers"] = Json::array();
  for (std::size_t i = 0; i < kerf.layers.size(); ++i)
    json["layers"].push_back(layer_json(kerf.layers[i], cut.layers.at(i)));
  json["depth_reached_mm"] = spread_json(kerf.depth.depth_mm);
  json["depth_reached_mm"]["planned"] = kerf.depth.planned_mm;
  json["lag_mm"] = kerf.drag ? spread_json(kerf.drag->lag) : Json(nullptr);
  json["drift_mm"] = kerf.drag ? spread_json(kerf.drag->drift) : Json(nullptr);
  json["deep_margin_mm"] = kerf.deep_margin ? deep_margin_json(*kerf.deep_margin) : Json(nullptr);
  if (kerf.deep_margin) return;
  json["deep_margin_unknown"] = cut.incision.record.removals.empty()
                                    ? "nothing was cut"
                                    : "the case names no tumor.surface: an edge does not tell how deep the tumour goes";
}

void write_kerf_files(const std::filesystem::path& folder, const KerfMeasures& kerf) {
  if (!kerf.body.surface.triangles.empty()) write_vtp(folder / "kerf.vtp", kerf.body.surface);
  for (const KerfLayer& layer : kerf.layers) write_if_there(folder / layer_file(layer.depth_mm), layer.centerline);
  write_contour_csv(
      folder / "depth.csv", kerf.depth.profile.course,
      {{kDepthColumns[3], kerf.depth.profile.arclength_mm},
       {kDepthColumns[4], kerf.depth.profile.depth_mm},
       {kDepthColumns[5], kerf.depth.planned_at_mm}});
  if (kerf.drag) {
    write_csv_columns(folder / "lag.csv", {{kLagColumns[0], kerf.drag->time_s},
                                           {kLagColumns[1], kerf.drag->arclength_mm},
                                           {kLagColumns[2], kerf.drag->lag_mm},
                                           {kLagColumns[3], kerf.drag->drift_mm}});
  }
  write_if_there(folder / "centerline_final.csv", kerf.final_centerline);
  write_if_there(folder / "inner_edge_reference.csv", kerf.inner_edge_reference);
}

}  // namespace incise
