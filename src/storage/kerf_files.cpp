#include "kerf_files.hpp"

#include <incise/io/contour_io.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/table_io.hpp>

#include <fmt/format.h>

namespace incise {
namespace {

const std::vector<std::string> kDepthColumns{"x_mm", "y_mm", "z_mm", "arclength_mm", "depth_mm", "planned_mm"};
const std::vector<std::string> kLagColumns{"time_s", "arclength_mm", "lag_mm", "drift_mm"};

std::string layer_file(double depth_mm) {
  return fmt::format("centerline_{}mm.csv", depth_mm);
}

void write_if_there(const std::filesystem::path& file, const std::optional<Contour>& contour) {
  if (contour) write_contour_csv(file, *contour);
}

}  // namespace

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
