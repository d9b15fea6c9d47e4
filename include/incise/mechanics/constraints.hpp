#pragma once

#include <incise/geometry/tet_mesh.hpp>
#include <incise/geometry/types.hpp>

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
/// Vertices whose point array `name` holds `value`.
struct PointArrayRegion {
  std::string name;
  double value = 1.0;
};
using Region = std::variant<BoxRegion, SphereRegion, EndRegion, PointArrayRegion>;

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
/// A rigid platform: tissue stays on the side that the normal points to, and may lift off. Frictionless.
struct SupportConstraint {
  Vec3 point_mm = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
};
/// A dead load on the boundary faces whose corners all lie in the region, kPa.
struct TractionConstraint {
  Region where;
  Vec3 traction_kpa = Vec3::Zero();
};
using Constraint = std::variant<FixedConstraint, DisplacedConstraint, SupportConstraint, TractionConstraint>;

}  // namespace incise
