#include <incise/workflow/case.hpp>

namespace incise {

std::vector<Constraint> default_constraints(const TetMesh& mesh) {
  constexpr double kClampMm = 15.0;    // what the posterior clamp of a specimen holder takes hold of
  constexpr double kSutureMm = 10.0;   // round the retraction suture
  constexpr double kStretchMm = 20.0;  // paper II-A
  const double lowest = bounding_box(mesh.vertices).min().z();
  return {FixedConstraint{EndRegion{Vec3::UnitY(), kClampMm}, {true, true, true}},
          DisplacedConstraint{EndRegion{-Vec3::UnitY(), kSutureMm}, Vec3(0.0, -kStretchMm, 0.0)},
          SupportConstraint{Vec3(0.0, 0.0, lowest), Vec3::UnitZ()}};
}

}  // namespace incise
