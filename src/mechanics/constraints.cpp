#include <incise/core/error.hpp>
#include <incise/mechanics/constraints.hpp>

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace incise {
namespace {

template <class Predicate>
std::vector<VertexId> vertices_where(const TetMesh& mesh, const Predicate& is_inside) {
  std::vector<VertexId> found;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (is_inside(v)) found.emplace_back(v);
  }
  return found;
}

std::vector<VertexId> select_region(const TetMesh& mesh, const BoxRegion& region) {
  const Box3& box = region.box_mm;
  INCISE_REQUIRE(box.min().allFinite() && box.max().allFinite() && !box.isEmpty(),
                 "expected a box with finite corners, the first not above the second");
  return vertices_where(mesh, [&](std::size_t v) { return box.contains(mesh.vertices[v]); });
}

std::vector<VertexId> select_region(const TetMesh& mesh, const SphereRegion& region) {
  INCISE_REQUIRE(
      region.center_mm.allFinite() && std::isfinite(region.radius_mm) && region.radius_mm >= 0.0,
      fmt::format("expected a finite centre and a radius of at least 0 mm, found radius {}", region.radius_mm));
  const double limit = region.radius_mm * region.radius_mm;
  return vertices_where(mesh,
                        [&](std::size_t v) { return (mesh.vertices[v] - region.center_mm).squaredNorm() <= limit; });
}

std::vector<VertexId> select_region(const TetMesh& mesh, const EndRegion& region) {
  const double length = region.direction.norm();
  INCISE_REQUIRE(std::isfinite(length) && std::abs(length - 1.0) < 1e-6,
                 fmt::format("expected a direction of length 1, found length {}", length));
  INCISE_REQUIRE(std::isfinite(region.within_mm) && region.within_mm >= 0.0,
                 fmt::format("expected a distance of at least 0 mm from the end, found {}", region.within_mm));
  double extreme = -std::numeric_limits<double>::infinity();
  for (const Vec3& p : mesh.vertices) extreme = std::max(extreme, p.dot(region.direction));
  return vertices_where(
      mesh, [&](std::size_t v) { return mesh.vertices[v].dot(region.direction) >= extreme - region.within_mm; });
}

std::vector<VertexId> select_region(const TetMesh& mesh, const PointArrayRegion& region) {
  const auto array = mesh.point_data.find(region.name);
  if (array == mesh.point_data.end()) {
    std::string names;
    for (const auto& [name, data] : mesh.point_data) names += (names.empty() ? "'" : ", '") + name + "'";
    INCISE_REQUIRE(false, fmt::format("expected a point array named '{}', found {}", region.name,
                                      names.empty() ? "no point arrays" : names));
  }
  INCISE_REQUIRE(array->second.components == 1 && array->second.values.size() == mesh.vertices.size(),
                 fmt::format("expected one number per vertex in point array '{}', found {} numbers in {} components",
                             region.name, array->second.values.size(), array->second.components));
  return vertices_where(mesh, [&](std::size_t v) { return array->second.values[v] == region.value; });
}

}  // namespace

std::vector<VertexId> select(const TetMesh& mesh, const Region& region) {
  return std::visit([&](const auto& r) { return select_region(mesh, r); }, region);
}

}  // namespace incise
