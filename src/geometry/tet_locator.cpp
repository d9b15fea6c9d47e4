#include "geometry/box_tree.hpp"
#include "geometry/triangle_distance.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/surface_query.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace incise {
namespace {

/// A point is inside a tet if no barycentric coordinate is below minus this, so that a point on a shared face is inside
/// one of the two tets.
constexpr double kInsideSlack = 1e-12;

using TetCorners = std::array<Vec3, 4>;

/// Returns the barycentric coordinates of p; nullopt for a tet without volume.
std::optional<std::array<double, 4>> barycentric_of(const TetCorners& c, const Vec3& p) {
  const double volume = signed_volume(c[0], c[1], c[2], c[3]);
  if (volume == 0.0) return std::nullopt;
  std::array<double, 4> weights{};
  weights[0] = signed_volume(p, c[1], c[2], c[3]) / volume;
  weights[1] = signed_volume(c[0], p, c[2], c[3]) / volume;
  weights[2] = signed_volume(c[0], c[1], p, c[3]) / volume;
  weights[3] = 1.0 - weights[0] - weights[1] - weights[2];
  return weights;
}

double squared_distance_to_faces(const TetCorners& c, const Vec3& p) {
  constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{{{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};
  double best = std::numeric_limits<double>::infinity();
  for (const auto& [i, j, k] : kFaces) {
    const Vec3 w = nearest_barycentric(c[i], c[j], c[k], p);
    best = std::min(best, (w[0] * c[i] + w[1] * c[j] + w[2] * c[k] - p).squaredNorm());
  }
  return best;
}

}  // namespace

struct TetLocator::Tree {
  std::vector<TetCorners> corners;
  BoxTree boxes;
};

TetLocator::TetLocator(const TetMesh& mesh, std::span<const Vec3> positions) : tree_(std::make_shared<Tree>()) {
  INCISE_REQUIRE(!mesh.tets.empty(), "expected a mesh with at least 1 tet, found none");
  INCISE_REQUIRE(
      positions.size() == mesh.vertices.size(),
      fmt::format("expected a position for each of {} vertices, found {}", mesh.vertices.size(), positions.size()));
  std::vector<Box3> boxes;
  boxes.reserve(mesh.tets.size());
  tree_->corners.reserve(mesh.tets.size());
  for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
    for (const VertexId id : mesh.tets[i]) {
      INCISE_REQUIRE(id.is_valid() && id.index() < positions.size(),
                     fmt::format("tet {} names vertex {}, expected one of {}", i, id.value, positions.size()));
      INCISE_REQUIRE(vertex(positions, id).allFinite(),
                     fmt::format("the position of vertex {} is not finite", id.value));
    }
    tree_->corners.push_back(corners_of(positions, mesh.tets[i]));
    boxes.push_back(bounding_box(tree_->corners.back()));
  }
  tree_->boxes = BoxTree(boxes);
}

std::optional<EmbeddedPoint> TetLocator::locate(const Vec3& p, double tolerance_mm) const {
  INCISE_REQUIRE(p.allFinite(), "the query point is not finite");
  INCISE_REQUIRE(tolerance_mm >= 0.0, fmt::format("expected a tolerance of 0 mm or more, found {}", tolerance_mm));
  // Inside tets (squared distance 0), take the tet in which p is deepest; outside, the nearest; of equals, the first.
  double best_squared = tolerance_mm * tolerance_mm;
  double best_depth = -std::numeric_limits<double>::infinity();
  std::optional<EmbeddedPoint> best;
  const auto squared_distance = [&](const Box3& box) { return box.squaredExteriorDistance(p); };
  const auto visit = [&](std::uint32_t tet) {
    const TetCorners& corners = tree_->corners[tet];
    const std::optional<std::array<double, 4>> weights = barycentric_of(corners, p);
    if (!weights) return;
    const double depth = *std::min_element(weights->begin(), weights->end());
    const double squared = depth >= -kInsideSlack ? 0.0 : squared_distance_to_faces(corners, p);
    if (squared > best_squared) return;
    if (best && squared == best_squared) {
      if (depth < best_depth) return;
      if (depth == best_depth && tet > best->tet.index()) return;
    }
    best_squared = squared;
    best_depth = depth;
    best = EmbeddedPoint{TetId{tet}, *weights};
  };
  tree_->boxes.traverse([&](const Box3& box) { return squared_distance(box) <= best_squared; }, squared_distance,
                        visit);
  return best;
}

Vec3 position_of(const EmbeddedPoint& point, const TetMesh& mesh, std::span<const Vec3> positions) {
  INCISE_REQUIRE(point.tet.is_valid() && point.tet.index() < mesh.tets.size(),
                 fmt::format("expected one of {} tets, found {}", mesh.tets.size(), point.tet.value));
  const TetCorners corners = corners_of(positions, mesh.tets[point.tet.index()]);
  Vec3 position = Vec3::Zero();
  for (std::size_t c = 0; c < 4; ++c) position += point.barycentric[c] * corners[c];
  return position;
}

}  // namespace incise
