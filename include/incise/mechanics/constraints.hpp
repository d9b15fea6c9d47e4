#pragma once

#include <incise/geometry/tet_mesh.hpp>
#include <incise/geometry/types.hpp>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace incise {

// Where a constraint acts; always in rest positions, mm, LPS.
struct BoxRegion {
  Box3 box_mm;
};
struct SphereRegion {
  Vec3 center_mm = Vec3::Zero();
  double radius_mm = 0.0;
};
/// Vertices at most `within_mm` from the body's extreme point along `direction` (unit): "the last 12 mm at the
/// posterior end".
struct EndRegion {
  Vec3 direction = Vec3::UnitY();
  double within_mm = 10.0;
};
/// Without `within_mm`: vertices on the plane or on the side that the normal points to. With it: vertices at most that
/// far from the plane, on either side.
struct PlaneRegion {
  Vec3 point_mm = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  ///< any length but 0
  std::optional<double> within_mm;
};
/// Vertices whose point array `name` holds `value`.
struct PointArrayRegion {
  std::string name;
  double value = 1.0;
};
/// Corners of the tets whose cell array `name` holds `value`: a labelled part of the body, its rim included.
struct CellArrayRegion {
  std::string name;
  double value = 1.0;
};
/// Vertices of the skin at most `radius_mm` from a line that was painted on it.
struct PatchRegion {
  Points path_mm;  ///< joined by straight lines; one point: a spot
  double radius_mm = 3.0;
};
using Region =
    std::variant<BoxRegion, SphereRegion, EndRegion, PlaneRegion, CellArrayRegion, PointArrayRegion, PatchRegion>;

/// A group with one key, which names what it is: {end: {direction: posterior, within_mm: 12}}, {cell_array: clamp=1}.
void describe(Visitor& v, Region& region);

/// Vertices of the mesh inside a region, ascending.
[[nodiscard]] std::vector<VertexId> select(const TetMesh& mesh, const Region& region);

/// Vertices held where they are along the given axes.
struct FixedConstraint {
  Region where;
  std::array<bool, 3> axes{true, true, true};
};
/// Vertices moved by a given displacement, mm, and held there.
struct DisplacedConstraint {
  Region where;
  Vec3 displacement_mm = Vec3::Zero();
};
/// The surface of a rigid holder: closed (a body, which tissue stays outside of) or open (a tray or sheet, on whose
/// normals' side tissue stays; what lies beyond its rim is not touched).
struct HolderSurface {
  std::string name;  ///< the file that it came from, for messages and lists
  TriMesh surface;   ///< mm, LPS, in the frame of the specimen; neighbours oriented alike
};
/// A rigid platform: tissue stays on the side that the normal points to, and may lift off. Frictionless. A plane, or
/// the surface of a holder, where one is given.
struct SupportConstraint {
  Vec3 point_mm = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
  std::shared_ptr<const HolderSurface>
      holder;  ///< null: the plane; shared, because constraints are copied with the model
};
/// A dead load on the boundary faces whose corners all lie in the region, kPa.
struct TractionConstraint {
  Region where;
  Vec3 traction_kpa = Vec3::Zero();
};
/// The force of a traction on one vertex, mN.
struct VertexLoad {
  VertexId vertex;
  Vec3 force_mn = Vec3::Zero();
};
/// A traction as forces on vertices, a third of traction times area for each corner of its faces; ascending by vertex.
/// Empty when no boundary face lies in the region. @param skin  boundary_faces(mesh).
[[nodiscard]] std::vector<VertexLoad> vertex_loads(const TetMesh& mesh, std::span<const BoundaryFace> skin,
                                                   const TractionConstraint& traction);

using Constraint = std::variant<FixedConstraint, DisplacedConstraint, SupportConstraint, TractionConstraint>;
inline constexpr std::array<std::string_view, 4> kConstraintNames{"fixed", "displaced", "support", "traction"};
[[nodiscard]] constexpr std::span<const std::string_view> names_of(const Constraint&) {
  return kConstraintNames;
}
void describe(Visitor& v, FixedConstraint& c);
void describe(Visitor& v, DisplacedConstraint& c);
/// By the name of the holder's file in a file of settings, by its surface in what is complete: a key does not depend on
/// where a file lies.
void describe(Visitor& v, SupportConstraint& c);
void describe(Visitor& v, TractionConstraint& c);

}  // namespace incise
