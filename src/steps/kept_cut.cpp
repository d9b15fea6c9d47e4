#include "kept_cut.hpp"

#include <incise/core/described_json.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/json_file.hpp>

namespace incise::steps {
namespace {

namespace fs = std::filesystem;

/// The errors of a line of the cut, if it was found.
ContourErrors errors_of(const fs::path& line, const Contour& edge, double target_mm, const Vec3& approach) {
  return fs::exists(line) ? contour_errors(read_contour(line, true), edge, target_mm, approach) : ContourErrors{};
}

}  // namespace

SimulatedCut read_kept_cut(const fs::path& folder, const Case& settings, const ToolPath& plan) {
  const fs::path file = folder / "incision.json";
  const nlohmann::ordered_json json = read_json(file);
  auto cut = from_json<SimulatedCut>(json, file);
  for (const nlohmann::ordered_json& layer : json.at("layers")) {
    cut.incision.kerf.layers.push_back(from_json<KerfLayer>(layer, file, "/layers"));
    cut.layers.push_back(from_json<LayerErrors>(layer, file, "/layers"));
  }
  if (!plan.is_closed) return cut;
  const Vec3& approach = settings.plan.approach;
  cut.centerline.errors = errors_of(folder / "centerline.csv", plan.tumor_edge, cut.centerline.target_mm, approach);
  if (json.at("inner_edge").is_null()) return cut;
  cut.inner_edge = from_json<Evaluation>(json.at("inner_edge"), file, "/inner_edge");
  if (!fs::exists(folder / "inner_edge.csv")) return cut;
  const Contour edge = read_contour(folder / "tumor_edge_final.csv", true);
  cut.inner_edge.errors = errors_of(folder / "inner_edge.csv", edge, cut.inner_edge.target_mm, approach);
  return cut;
}

}  // namespace incise::steps
