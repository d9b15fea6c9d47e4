#pragma once

#include <incise/core/outcome.hpp>
#include <incise/mechanics/constraints.hpp>

#include <cstddef>
#include <vector>

namespace incise {

/// Fibres that run from one part of the body to another, as a muscle does from its origin to its insertion.
struct FibreField {
  Region from;
  Region to;
};
inline void describe(Visitor& v, FibreField& f) {
  v("from", f.from, "the region where the fibres begin");
  v("to", f.to, "the region where the fibres end");
}

/// Result of fibre_directions.
struct FibreDirections {
  Outcome outcome = Outcome::Success;  ///< Success or NotConverged
  std::vector<Vec3> directions;        ///< per tet: unit direction at rest; empty unless outcome is Success
  std::size_t flat_tets = 0;           ///< tets with a constant potential: they take their neighbours' direction
  int iterations = 0;                  ///< of conjugate gradients
  double residual = 0.0;               ///< relative to the residual of the potential 0
};

/// Computes the direction of the fibres in each tet: along the gradient of the potential that is 0 in `from`, 1 in `to`
/// and harmonic between them, with no flux through the skin (linear tets, conjugate gradients). Equations and limits:
/// docs/models/elasticity.md, "Fibres".
/// @param most_iterations  of conjugate gradients; a mesh of a million tets takes about 500.
/// @throws InvalidArgument if find_problems(mesh) finds any; CaseError (field specimen.material.fibre_field.from or
/// .to) for a region that cannot be applied to the mesh or selects no vertex, and for regions with a common vertex.
[[nodiscard]] FibreDirections fibre_directions(const TetMesh& mesh, const FibreField& field,
                                               int most_iterations = 10000);

}  // namespace incise
