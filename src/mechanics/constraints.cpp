#include <incise/core/error.hpp>
#include <incise/mechanics/constraints.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
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

std::vector<VertexId> select_region(const TetMesh& mesh, const PlaneRegion& region) {
  const double length = region.normal.norm();
  INCISE_REQUIRE(region.point_mm.allFinite() && std::isfinite(length) && length > 1e-12,
                 "expected a plane with a finite point and a normal that is not zero");
  INCISE_REQUIRE(
      !region.within_mm || (std::isfinite(*region.within_mm) && *region.within_mm >= 0.0),
      fmt::format("expected a distance of at least 0 mm from the plane, found {}", region.within_mm.value_or(0.0)));
  const auto height = [&](std::size_t v) { return (mesh.vertices[v] - region.point_mm).dot(region.normal) / length; };
  if (!region.within_mm) return vertices_where(mesh, [&](std::size_t v) { return height(v) >= 0.0; });
  return vertices_where(mesh, [&](std::size_t v) { return std::abs(height(v)) <= *region.within_mm; });
}

/// The values of a named array with one number per item. @param kind  "point" or "cell", @param item  "vertex" or
/// "tet".
const std::vector<double>& named_values(const std::map<std::string, DataArray>& arrays, const std::string& name,
                                        std::size_t count, const char* kind, const char* item) {
  const auto array = arrays.find(name);
  if (array == arrays.end()) {
    std::string names;
    for (const auto& [other, data] : arrays) names += (names.empty() ? "'" : ", '") + other + "'";
    INCISE_REQUIRE(false, fmt::format("expected a {} array named '{}', found {}", kind, name,
                                      names.empty() ? fmt::format("no {} arrays", kind) : names));
  }
  INCISE_REQUIRE(array->second.components == 1 && array->second.values.size() == count,
                 fmt::format("expected one number per {} in {} array '{}', found {} numbers in {} components", item,
                             kind, name, array->second.values.size(), array->second.components));
  return array->second.values;
}

std::vector<VertexId> select_region(const TetMesh& mesh, const PointArrayRegion& region) {
  const auto& values = named_values(mesh.point_data, region.name, mesh.vertices.size(), "point", "vertex");
  return vertices_where(mesh, [&](std::size_t v) { return values[v] == region.value; });
}

std::vector<VertexId> select_region(const TetMesh& mesh, const CellArrayRegion& region) {
  const auto& values = named_values(mesh.cell_data, region.name, mesh.tets.size(), "cell", "tet");
  std::vector<std::uint8_t> is_corner(mesh.vertices.size(), 0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (values[t] != region.value) continue;
    for (const VertexId v : mesh.tets[t]) is_corner[v.index()] = 1;
  }
  return vertices_where(mesh, [&](std::size_t v) { return is_corner[v] != 0; });
}

}  // namespace

std::vector<VertexId> select(const TetMesh& mesh, const Region& region) {
  return std::visit([&](const auto& r) { return select_region(mesh, r); }, region);
}

std::vector<VertexLoad> vertex_loads(const TetMesh& mesh, std::span<const BoundaryFace> skin,
                                     const TractionConstraint& traction) {
  std::vector<std::uint8_t> is_inside(mesh.vertices.size(), 0);
  for (const VertexId v : select(mesh, traction.where)) is_inside[v.index()] = 1;
  std::vector<std::uint8_t> is_loaded(mesh.vertices.size(), 0);
  Points force(mesh.vertices.size(), Vec3::Zero());
  for (const BoundaryFace& face : skin) {
    const bool is_in_region =
        std::all_of(face.corners.begin(), face.corners.end(), [&](VertexId v) { return is_inside[v.index()] != 0; });
    if (!is_in_region) continue;
    const Vec3& a = vertex(mesh.vertices, face.corners[0]);
    const Vec3& b = vertex(mesh.vertices, face.corners[1]);
    const Vec3& c = vertex(mesh.vertices, face.corners[2]);
    const double area = 0.5 * (b - a).cross(c - a).norm();
    for (const VertexId v : face.corners) {
      force[v.index()] += area / 3.0 * traction.traction_kpa;
      is_loaded[v.index()] = 1;
    }
  }
  std::vector<VertexLoad> loads;
  for (std::size_t v = 0; v < force.size(); ++v) {
    if (is_loaded[v] != 0) loads.push_back({VertexId(v), force[v]});
  }
  return loads;
}

}  // namespace incise
