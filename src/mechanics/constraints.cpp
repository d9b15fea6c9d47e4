#include <incise/core/error.hpp>
#include <incise/geometry/contour.hpp>
#include <incise/mechanics/constraints.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>

namespace incise {
namespace {

constexpr std::array<Field, 7> kRegionKeys{
    {{"box_mm", "low and high corner, rest positions, LPS"},
     {"sphere"},
     {"end", "vertices at most within_mm from the body's extreme point along direction"},
     {"plane",
      "vertices on the plane or on its normal's side; with within_mm: at most that far from the plane, on either side"},
     {"cell_array", "NAME=VALUE of a cell array of the mesh: the corners of those tets"},
     {"point_array", "NAME=VALUE of a point array of the mesh"},
     {"patch", "vertices of the skin at most radius_mm from a line that was painted on it, rest positions, LPS"}}};
constexpr std::array<Field, 2> kSupportKeys{
    {{"surface", "triangles of a holder, normals towards the tissue (mm, LPS)"}, {"plane"}}};

constexpr std::string_view kWhereItActs = "where it acts";

void describe_under(Visitor& v, const Field& key, BoxRegion& r) {
  v(key, r.box_mm);
  if (v.sets() && r.box_mm.isEmpty())
    v.refuse(key, "a low corner above the high corner", "[[low x, y, z], [high x, y, z]]");
}

void describe_under(Visitor& v, const Field& key, SphereRegion& r) {
  v.begin(key);
  v("center_mm", r.center_mm);
  v("radius_mm", r.radius_mm, {}, kPositive);
  v.end();
}

void describe_under(Visitor& v, const Field& key, EndRegion& r) {
  v.begin(key);
  v.direction("direction", r.direction);
  v("within_mm", r.within_mm, {}, kPositive);
  v.end();
}

void describe_under(Visitor& v, const Field& key, PlaneRegion& r) {
  v.begin(key);
  v("point_mm", r.point_mm);
  v.direction("normal", r.normal);
  v("within_mm", r.within_mm, {}, kNotNegative);
  v.end();
}

void describe_under(Visitor& v, const Field& key, PatchRegion& r) {
  v.begin(key);
  v("path_mm", r.path_mm);
  v("radius_mm", r.radius_mm, {}, {0.1, 50.0});
  if (v.sets() && r.path_mm.empty()) v.refuse({"path_mm"}, "no point", "at least one point of the painted line");
  v.end();
}

/// Describes a name and a value, written NAME=VALUE.
void name_and_value(Visitor& v, const Field& key, std::string& name, double& value) {
  std::string text = fmt::format("{}={}", name, value);
  v(key, text);
  if (!v.sets()) return;
  const std::size_t equals = std::min(text.find('='), text.size());
  name = text.substr(0, equals);
  std::istringstream number(text.substr(std::min(equals + 1, text.size())));
  if (name.empty() || !(number >> value) || !(number >> std::ws).eof() || !std::isfinite(value))
    v.refuse(key, "'" + text + "'", "NAME=VALUE, such as clamp=1");
}

void describe_under(Visitor& v, const Field& key, CellArrayRegion& r) {
  name_and_value(v, key, r.name, r.value);
}

void describe_under(Visitor& v, const Field& key, PointArrayRegion& r) {
  name_and_value(v, key, r.name, r.value);
}

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

/// Returns the values of a named array with one number per item.
/// @param kind  "point" or "cell".  @param item  "vertex" or "tet".
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

std::vector<VertexId> select_region(const TetMesh& mesh, const PatchRegion& region) {
  INCISE_REQUIRE(!region.path_mm.empty() && std::isfinite(region.radius_mm) && region.radius_mm > 0.0,
                 "expected a painted line of at least one point and a radius above 0 mm");
  std::vector<std::uint8_t> is_skin(mesh.vertices.size(), 0);
  for (const BoundaryFace& face : boundary_faces(mesh)) {
    for (const VertexId v : face.corners) is_skin[v.index()] = 1;
  }
  const Contour path{region.path_mm, false};
  return vertices_where(mesh, [&](std::size_t v) {
    return is_skin[v] != 0 && nearest_on(path, mesh.vertices[v]).distance_mm <= region.radius_mm;
  });
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

void describe(Visitor& v, Region& region) {
  std::size_t place = region.index();
  const std::size_t found = v.key(place, kRegionKeys);
  if (found == 0) v.refuse({}, "an empty group", "box_mm, sphere, end, plane, point_array, cell_array or patch");
  if (found > 1)
    v.refuse({}, fmt::format("{} regions", found), "one of box_mm, sphere, end, plane, point_array, cell_array, patch");
  if (place == Visitor::kUnchanged) return;
  const auto describe_own = [&v](Region& own) {
    std::visit([&](auto& r) { describe_under(v, kRegionKeys[own.index()], r); }, own);
  };
  if (place == Visitor::kEveryKind) {
    for (std::size_t i = 0; i < kRegionKeys.size(); ++i) {
      Region made;
      Visitor::emplace(made, i);
      describe_own(made);
    }
    return;
  }
  if (v.sets()) Visitor::emplace(region, place);
  describe_own(region);
}

void describe(Visitor& v, FixedConstraint& c) {
  v("where", c.where, kWhereItActs);
  constexpr std::string_view kLetters = "xyz";
  std::optional<std::string> axes{std::in_place};
  for (std::size_t i = 0; i < kLetters.size(); ++i)
    if (c.axes[i]) *axes += kLetters[i];
  const Field field{"axes", {}, {}, "^[xyz]+$"};
  v(field, axes);
  if (!v.sets()) return;
  const std::string letters = axes.value_or(std::string(kLetters));
  c.axes = {};
  if (letters.empty()) v.refuse(field, "nothing", "some of the letters x, y, z");
  for (const char letter : letters) {
    const std::size_t axis = kLetters.find(letter);
    if (axis == std::string_view::npos) v.refuse(field, "'" + letters + "'", "some of the letters x, y, z");
    c.axes[axis] = true;
  }
}

void describe(Visitor& v, DisplacedConstraint& c) {
  v("where", c.where, kWhereItActs);
  v("displacement_mm", c.displacement_mm);
}

void describe(Visitor& v, SupportConstraint& c) {
  std::size_t place = c.holder ? 0 : 1;
  const std::size_t found = v.key(place, kSupportKeys);
  if (found == 0) v.refuse({}, "no `plane`", "plane: {point_mm, normal}, or surface: FILE");
  if (found > 1) v.refuse({}, "a plane and a surface", "only one of plane and surface");
  if (place == 0 || place == Visitor::kEveryKind) {
    HolderSurface holder = c.holder ? *c.holder : HolderSurface{};
    if (v.is_complete()) {
      v(kSupportKeys[0], holder.surface);
    } else {
      v(kSupportKeys[0], holder.name);
      if (v.sets() && holder.name.empty())
        v.refuse(kSupportKeys[0], "no name", "a file with triangles: .stl, .ply, .obj or .vtp");
    }
    if (v.sets()) c.holder = std::make_shared<HolderSurface>(std::move(holder));
  }
  if (place == 1 || place == Visitor::kEveryKind) {
    v.begin(kSupportKeys[1]);
    v("point_mm", c.point_mm);
    v.direction("normal", c.normal);
    v.end();
  }
}

void describe(Visitor& v, TractionConstraint& c) {
  v("where", c.where, kWhereItActs);
  v("traction_kpa", c.traction_kpa);
}

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
