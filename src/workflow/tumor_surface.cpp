#include <incise/core/error.hpp>
#include <incise/geometry/surface_query.hpp>
#include <incise/workflow/study.hpp>

#include <fmt/format.h>

namespace incise {
namespace {

/// Returns the move of each point of the drawn edge along the approach onto the skin, mm.
std::vector<double> moves_of_edge(const Contour& edge, const SurfaceQuery& skin, const Vec3& approach) {
  std::vector<double> moves;
  for (std::size_t i = 0; i < edge.points.size(); ++i) {
    const Vec3& p = edge.points[i];
    const std::optional<SurfacePoint> seen = skin.seen_at(p, approach);
    if (!seen) {
      throw CaseError("tumor", "contour", fmt::format("point {} at ({:.2f}, {:.2f}, {:.2f}) mm, beside the tissue", i, p.x(), p.y(), p.z()),
                      "an edge on the skin, seen along the approach: the tumour's surface is placed with it");
    }
    moves.push_back(seen->distance_mm);
  }
  return moves;
}

/// Moves a surface along the approach with the edge: by the mean of the edge's moves, weighted by the inverse square of
/// the distance in the picture. A vertex on the edge moves with the edge.
void place_with_edge(TriMesh& surface, const Contour& edge, const SurfaceQuery& skin, const Vec3& approach) {
  constexpr double kSamePlaceMm2 = 1e-12;
  const std::vector<double> moves = moves_of_edge(edge, skin, approach);
  for (Vec3& p : surface.vertices) {
    double sum = 0.0;
    double weights = 0.0;
    for (std::size_t i = 0; i < edge.points.size(); ++i) {
      const Vec3 apart = edge.points[i] - p;
      const double weight = 1.0 / ((apart - apart.dot(approach) * approach).squaredNorm() + kSamePlaceMm2);
      sum += weight * moves[i];
      weights += weight;
    }
    p += sum / weights * approach;
  }
}

}  // namespace

TriMesh tumor_in_stretched(const Case& settings, const TissueModel& model, std::span<const Vec3> stretched,
                           TriMesh surface, const std::optional<Contour>& drawn_edge) {
  const bool is_at_rest = settings.tumor_configuration == TumorConfiguration::Rest;
  const std::span<const Vec3> positions = is_at_rest ? std::span<const Vec3>(model.mesh.vertices) : stretched;
  if (drawn_edge) {
    place_with_edge(surface, *drawn_edge, SurfaceQuery(skin_of(model.mesh, positions)),
                    settings.plan.approach.normalized());
  }
  const TetLocator locator(model.mesh, positions);
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    Vec3& p = surface.vertices[i];
    const std::optional<EmbeddedPoint> point = locator.locate(p, settings.surface_tolerance_mm);
    if (!point) {
      throw CaseError(
          "tumor", "surface",
          fmt::format("vertex {} at ({:.2f}, {:.2f}, {:.2f}) mm, outside the tissue", i, p.x(), p.y(), p.z()),
          fmt::format("every vertex within {} mm of the tissue", settings.surface_tolerance_mm),
          "Is it in mm and LPS, and drawn in the configuration (rest or stretched) that the case states?");
    }
    if (is_at_rest) p = position_of(*point, model.mesh, stretched);
  }
  return surface;
}

}  // namespace incise
