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

// Regions: where a constraint acts. They always refer to rest positions, mm, LPS.
struct BoxRegion {
  Box3 box_mm;
};
struct SphereRegion {
  Vec3 center_mm = Vec3::Zero();
  double radius_mm = 0.0;
};
/// Vertices at most `within_mm`, measured along `direction` (unit), from the body's extreme point in that direction:
/// "the last 12 mm at the posterior end".
struct EndRegion {
  Vec3 direction = Vec3::UnitY();
  double within_mm = 10.0;
};
/// Without `within_mm`: vertices on the plane or on the side to which the normal points. With it: vertices at most that
/// far from the plane, on either side.
struct PlaneRegion {
  Vec3 point_mm = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  ///< any length but 0
  std::optional<double> within_mm;
};
/// Vertices at which the point array `name` equals `value`.
struct PointArrayRegion {
  std::string name;
  double value = 1.0;
};
/// Corners of the tets in which the cell array `name` equals `value`: a labelled part of the body with its border.
struct CellArrayRegion {
  std::string name;
  double value = 1.0;
};
/// Vertices of the skin at most `radius_mm` from a line that was painted on it.
struct PatchRegion {
  Points path_mm;  ///< joined by straight lines; a single point gives a spot
  double radius_mm = 3.0;
};
using Region =
    std::variant<BoxRegion, SphereRegion, EndRegion, PlaneRegion, CellArrayRegion, PointArrayRegion, PatchRegion>;

/// A group with a single key, which names the kind of region: {end: {direction: posterior, within_mm: 12}},
/// {cell_array: clamp=1}.
void describe(Visitor& v, Region& region);

/// Returns the vertices of the mesh inside a region, ascending. @throws InvalidArgument if the region cannot be
/// applied: a number that is not finite or out of range, a direction of EndRegion that is not of length 1, an array
/// that the mesh does not have.
[[nodiscard]] std::vector<VertexId> select(const TetMesh& mesh, const Region& region);

/// Holds vertices in place along the given axes.
struct FixedConstraint {
  Region where;
  std::array<bool, 3> axes{true, true, true};
};
/// Moves vertices by a given displacement, mm, and holds them there.
struct DisplacedConstraint {
  Region where;
  Vec3 displacement_mm = Vec3::Zero();
};
/// The surface of a rigid holder. Tissue stays outside a closed surface (a body). It stays on the side of the normals
/// of an open one (a tray or sheet); tissue beyond the rim is not touched.
struct HolderSurface {
  std::string name;  ///< the file that it was read from, for messages and lists
  TriMesh surface;   ///< mm, LPS, in the frame of the specimen; triangles consistently oriented
};
/// A rigid platform without friction: a plane or, if one is given, the surface of a holder. Tissue stays on the side to
/// which the normal points, and may lift off.
struct SupportConstraint {
  Vec3 point_mm = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  ///< any length but 0
  std::shared_ptr<const HolderSurface>
      holder;  ///< null: the plane; shared, because constraints are copied with the model
};
/// A dead load, kPa, on the boundary faces whose corners all lie in the region.
struct TractionConstraint {
  Region where;
  Vec3 traction_kpa = Vec3::Zero();
};
/// The force of a traction on one vertex, mN.
struct VertexLoad {
  VertexId vertex;
  Vec3 force_mn = Vec3::Zero();
};
/// Returns a traction as forces on vertices, ascending by vertex: each corner of a loaded face gets a third of traction
/// times rest area. Empty if no boundary face lies in the region. @param skin  boundary_faces(mesh).
/// @throws InvalidArgument as `select`.
[[nodiscard]] std::vector<VertexLoad> vertex_loads(const TetMesh& mesh, std::span<const BoundaryFace> skin,
                                                   const TractionConstraint& traction);

using Constraint = std::variant<FixedConstraint, DisplacedConstraint, SupportConstraint, TractionConstraint>;
inline constexpr std::array<std::string_view, 4> kConstraintNames{"fixed", "displaced", "support", "traction"};
[[nodiscard]] constexpr std::span<const std::string_view> names_of(const Constraint&) {
  return kConstraintNames;
}
void describe(Visitor& v, FixedConstraint& c);
void describe(Visitor& v, DisplacedConstraint& c);
/// A settings file names the holder's file; a complete description (Visitor::is_complete) contains its surface. Cache
/// keys therefore do not depend on where the file lies.
void describe(Visitor& v, SupportConstraint& c);
void describe(Visitor& v, TractionConstraint& c);

}  // namespace incise
