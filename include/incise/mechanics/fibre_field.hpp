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

/// The direction of the fibres in each tet at rest.
struct FibreDirections {
  Outcome outcome = Outcome::Success;  ///< or NotConverged
  std::vector<Vec3> directions;        ///< one for each tet, of length 1; empty unless outcome is Success
  std::size_t flat_tets = 0;           ///< where the potential does not change: they take their neighbours' direction
  int iterations = 0;
  double residual = 0.0;  ///< over that of the potential 0
};

/// A mesh of a million tets takes about 500.
inline constexpr int kMostFibreIterations = 10000;

/// Along the gradient of the potential that is 0 in `from`, 1 in `to`, and harmonic between them, with no flux through
/// the skin (linear tets, conjugate gradients). Equations and limits: docs/models/elasticity.md, "Fibres".
/// @pre the mesh is sound (find_problems). @throws CaseError (field specimen.material.fibre_field.from or .to) for a
/// region that cannot be applied to the mesh or selects no vertex, or where both select the same one.
[[nodiscard]] FibreDirections fibre_directions(const TetMesh& mesh, const FibreField& field,
                                               int most_iterations = kMostFibreIterations);

}  // namespace incise
