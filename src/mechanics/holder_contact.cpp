#include "mechanics/holder_contact.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace incise {
namespace {

/// A barycentric weight below this counts as 0: the point is on the opposite edge.
constexpr double kOnEdge = 1e-9;
/// A point nearer to the surface than this takes the surface's normal: its offset has no reliable direction.
constexpr double kOnSurfaceMm = 1e-9;
/// Sine of the angle between offset and normal up to which a point at the rim still counts as behind the sheet.
constexpr double kLeanOverRim = 1e-6;

/// The result for a point that touches nothing.
SupportGap clear_of_surface() {
  return {std::numeric_limits<double>::infinity(), Vec3::UnitZ()};
}

Vec3 area_normal(const TriMesh& surface, const Triangle& t) {
  const Vec3& a = vertex(surface.vertices, t[0]);
  return (vertex(surface.vertices, t[1]) - a).cross(vertex(surface.vertices, t[2]) - a);
}

}  // namespace

HolderContact::HolderContact(const TriMesh& surface) : query_(surface), triangles_(surface.triangles) {
  find_edges(surface);
  find_normals(surface);
  box_ = bounding_box(surface.vertices);
  const auto crossing = find_self_crossing(surface);
  INCISE_REQUIRE(!crossing, fmt::format("expected a surface that does not pass through itself, found that triangles {} and {} cross",
                                        (*crossing)[0].value, (*crossing)[1].value));
  INCISE_REQUIRE(!is_closed_ || enclosed_volume_mm3(surface) > 0.0,
                 "expected a closed surface with outward normals, found one that is inside out");
}

void HolderContact::find_edges(const TriMesh& surface) {
  struct Use {
    std::size_t triangle;
    std::size_t opposite;
    bool is_upwards;
  };
  std::map<std::pair<std::size_t, std::size_t>, std::vector<Use>> edges;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    INCISE_REQUIRE(area_normal(surface, triangles_[t]).norm() > 0.0, fmt::format("triangle {} has no area", t));
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t from = triangles_[t][(c + 1) % 3].index();
      const std::size_t to = triangles_[t][(c + 2) % 3].index();
      edges[std::minmax(from, to)].push_back({t, c, from < to});
    }
  }
  edge_normals_.resize(triangles_.size());
  is_rim_edge_.assign(triangles_.size(), {false, false, false});
  is_rim_vertex_.assign(surface.vertices.size(), false);
  for (const auto& [ends, uses] : edges) {
    const auto name = [&ends = ends] { return fmt::format("the edge of vertices {} and {}", ends.first, ends.second); };
    INCISE_REQUIRE(uses.size() <= 2,
                   fmt::format("expected at most 2 triangles on each edge, found {} on {}", uses.size(), name()));
    INCISE_REQUIRE(uses.size() == 1 || uses[0].is_upwards != uses[1].is_upwards,
                   fmt::format("expected neighbours with the same orientation, found two that differ at {}", name()));
    Vec3 sum = Vec3::Zero();
    for (const Use& use : uses) sum += area_normal(surface, triangles_[use.triangle]).normalized();
    // Two triangles folded flat onto each other have no mean normal; either one's will do.
    if (sum.norm() < kOnEdge) sum = area_normal(surface, triangles_[uses.front().triangle]);
    for (const Use& use : uses) {
      edge_normals_[use.triangle][use.opposite] = sum.normalized();
      is_rim_edge_[use.triangle][use.opposite] = uses.size() == 1;
    }
    if (uses.size() > 1) continue;
    is_closed_ = false;
    is_rim_vertex_[ends.first] = is_rim_vertex_[ends.second] = true;
  }
}

void HolderContact::find_normals(const TriMesh& surface) {
  vertex_normals_.assign(surface.vertices.size(), Vec3::Zero());
  for (const Triangle& t : triangles_) {
    const Vec3 normal = area_normal(surface, t).normalized();
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3& corner = vertex(surface.vertices, t[c]);
      const Vec3 one = vertex(surface.vertices, t[(c + 1) % 3]) - corner;
      const Vec3 other = vertex(surface.vertices, t[(c + 2) % 3]) - corner;
      vertex_normals_[t[c].index()] += std::atan2(one.cross(other).norm(), one.dot(other)) * normal;
    }
  }
  for (const Triangle& t : triangles_) {
    for (const VertexId corner : t) {
      Vec3& normal = vertex_normals_[corner.index()];
      INCISE_REQUIRE(normal.norm() > kOnEdge, fmt::format("expected an outside at every vertex, found that the "
                                                          "triangles round vertex {} face each other",
                                                          corner.value));
      normal.normalize();
    }
  }
}

SupportGap HolderContact::gap(const Vec3& p) const {
  if (!p.allFinite()) return clear_of_surface();  // a diverged state is detected by its residual, not here
  if (is_closed_ && !box_.contains(p)) return clear_of_surface();
  const SurfacePoint near = query_.nearest(p);
  const Triangle& corners = triangles_[near.triangle.index()];
  Vec3 normal = near.normal;
  bool is_on_rim = false;
  int zeros = 0;
  std::size_t zero = 0;   // the last corner without weight
  std::size_t whole = 0;  // the corner with the largest weight
  for (std::size_t c = 0; c < 3; ++c) {
    const auto i = static_cast<int>(c);
    if (near.barycentric[i] < kOnEdge) {
      ++zeros;
      zero = c;
    }
    if (near.barycentric[i] > near.barycentric[static_cast<int>(whole)]) whole = c;
  }
  if (zeros == 1) {
    normal = edge_normals_[near.triangle.index()][zero];
    is_on_rim = is_rim_edge_[near.triangle.index()][zero];
  } else if (zeros == 2) {
    normal = vertex_normals_[corners[whole].index()];
    is_on_rim = is_rim_vertex_[corners[whole].index()];
  }
  const Vec3 way = p - near.position_mm;
  const double distance = way.norm();
  if (distance < kOnSurfaceMm) return {0.0, normal};
  if (is_on_rim && way.cross(normal).norm() > kLeanOverRim * distance) return clear_of_surface();
  const double sign = way.dot(normal) < 0.0 ? -1.0 : 1.0;
  return {sign * distance, sign / distance * way};
}

}  // namespace incise
