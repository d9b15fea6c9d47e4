#pragma once

#include <incise/core/workers.hpp>
#include <incise/geometry/mesh_splits.hpp>
#include <incise/geometry/tet_mesh.hpp>
#include <incise/mechanics/block_matrix.hpp>
#include <incise/mechanics/constraints.hpp>
#include <incise/mechanics/material.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace incise {

class HolderContact;

/// A support, a plane or the surface of a holder, with the penalty stiffness with which it pushes vertices back. The
/// stiffness follows from Young's modulus and the vertex's boundary area: a pressure equal to Young's modulus presses a
/// vertex 0.05 mm in.
struct SupportPlane {
  std::size_t constraint = 0;  ///< index into TissueModel::constraints
  Vec3 point_mm = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();     ///< unit
  std::shared_ptr<const HolderContact> holder;  ///< null: the plane; shared, because the model is copied
  std::vector<VertexId> vertices;  ///< boundary vertices that can move along the normal (holder: along any axis)
  std::vector<double> stiffness;   ///< mN/mm, one per vertex
};

struct TetBatches;  // the tets in the order and layout of the vectorised kernels: src/mechanics/tet_batches.hpp

/// Everything about the tissue that a simulation does not change. Built once and shared between runs. N vertices.
struct TissueModel {
  TetMesh mesh;  ///< rest positions, mm
  Material material;
  std::vector<Constraint> constraints;           ///< as given
  std::vector<std::array<Vec3, 4>> gradients;    ///< per tet: gradient of each corner's shape function at rest, 1/mm
  std::vector<double> volumes_mm3;               ///< per tet, at rest
  std::vector<LameParameters> lame;              ///< per tet
  std::vector<Vec3> fibres;                      ///< per tet: unit direction at rest; empty without fibres
  std::vector<double> toughness;                 ///< per tet, relative to the reference tissue; empty: 1 everywhere
  std::vector<double> vertex_mass_kg;            ///< lumped: a quarter of the mass of each adjacent tet
  std::vector<std::array<bool, 3>> is_fixed;     ///< per vertex and axis
  std::vector<Vec3> prescribed_displacement_mm;  ///< per vertex, from rest; used where is_fixed
  std::vector<std::array<std::int32_t, 3>>
      holder;                         ///< per vertex and axis: the first constraint that holds it, -1: none
  std::vector<Vec3> dead_load_mn;     ///< per vertex: gravity and tractions
  std::vector<Vec3> applied_load_mn;  ///< per constraint: total force of a traction, 0 for other kinds
  std::vector<SupportPlane> supports;
  std::shared_ptr<const BlockPattern> stars;    ///< per vertex: the vertices of its tets, itself included
  /// Pattern of the stiffness matrix: `stars`; with averaged volume, which also couples a tet with the neighbours of
  /// its corners, stars of stars.
  std::shared_ptr<const BlockPattern> pattern;
  std::vector<std::array<std::int32_t, 16>> tet_slots;  ///< per tet: slot of block (corner a, corner b) at 4 a + b
  std::vector<std::int32_t> vertex_tet_start;           ///< N + 1, into vertex_tets
  std::vector<std::int32_t> vertex_tets;                ///< 4 * tet + corner, ascending: for gathering in fixed order
  std::shared_ptr<const TetBatches> batches;            ///< the above in the kernels' layout: rebuild it after a change

  /// Returns the corners of tets that lie at a vertex, each as 4 * tet + corner, ascending.
  [[nodiscard]] std::span<const std::int32_t> corners_at(std::size_t v) const {
    return list_of(vertex_tet_start, vertex_tets, v);
  }
};

/// Builds the model.
/// @throws CaseError (field "specimen.…") for a material out of range, a region that selects nothing, an unusable
/// holder, contradictory constraints on one vertex, or constraints that leave a rigid motion free; InvalidArgument if
/// find_problems(mesh) or validate(field) finds any.
[[nodiscard]] TissueModel make_tissue_model(TetMesh mesh, const Material& material, std::vector<Constraint> constraints,
                                            const Vec3& gravity_mm_s2 = Vec3::Zero(),
                                            const MaterialField& field = {});

/// Returns the model on the split mesh. A copy has the material, constraints and prescribed displacement of its
/// original. The copies of a vertex share its mass, dead load and support stiffness in proportion to the tissue around
/// each. Volumes are those of whole tets; TissueState::fill gives the share that a tet holds. O(M log M).
/// @throws InvalidArgument for splits of another mesh.
[[nodiscard]] TissueModel split_model(const TissueModel& whole, const MeshSplits& splits);

/// Returns the rest volume of the tissue that a tet of the split mesh holds, mm³. @param split  the model on that mesh.
[[nodiscard]] inline double rest_volume_mm3(const TissueModel& split, const MeshSplits& splits, TetId tet) {
  const std::size_t whole_count = split.mesh.tets.size() - splits.copies.size();
  return share_of(splits, whole_count, tet) * split.volumes_mm3[tet.index()];
}

/// Returns the toughness of a tet relative to the reference tissue (1).
[[nodiscard]] inline double relative_toughness(const TissueModel& model, std::size_t tet) {
  return model.toughness.empty() ? 1.0 : model.toughness[tet];
}

/// Memory of viscous tissue: deviators of Green-Lagrange strains. Empty without viscosity.
struct ViscousMemory {
  std::vector<Mat3> strains;   ///< per tet: strain at the end of the last step
  std::vector<Mat3> branches;  ///< per tet and Prony term (tet * terms + term): strain of the branch's spring
  [[nodiscard]] bool operator==(const ViscousMemory&) const = default;
};
inline void describe(Visitor& v, ViscousMemory& m) {
  v("strains", m.strains, "Strain of each tet at the end of the last step.");
  v("branches", m.branches, "Strain of each branch's spring, tet by tet.");
}

/// The part of the tissue that a simulation changes: a value that can be saved, compared and restored.
struct TissueState {
  Points positions;                   ///< N x 3, mm
  std::vector<Mat3> rotations;        ///< per tet: proper rotation, warm start of the polar decomposition
  std::vector<std::uint8_t> is_live;  ///< per tet: 1 until it is carved
  std::vector<double> fill;           ///< per tet: remaining share of its stiffness, (0, 1] if live; empty: 1
  ViscousMemory memory;               ///< of viscous tissue; updated by end_viscous_step
};
inline void describe(Visitor& v, TissueState& s) {
  v("positions", s.positions, "Positions of the vertices.");
  v("rotations", s.rotations, "Rotations of the tets, from which the polar decomposition starts.");
  v("is_live", s.is_live, "For each tet: 1 until it is carved.");
  v("fill", s.fill, "Remaining share of the stiffness of each live tet; empty: 1.");
  v("memory", s.memory, "Memory of viscous tissue.");
}
/// Returns the state at rest: every tet live, all rotations the identity.
[[nodiscard]] TissueState rest_state(const TissueModel& model);

/// Returns the remaining share of a tet's stiffness, [0, 1]; 0: it is carved.
[[nodiscard]] inline double filled_share(const TissueState& state, std::size_t tet) {
  if (state.is_live[tet] == 0) return 0.0;
  return state.fill.empty() ? 1.0 : state.fill[tet];
}
/// Returns the remaining share of a live tet's rest volume, mm³.
[[nodiscard]] inline double filled_volume_mm3(const TissueModel& model, const TissueState& state, std::size_t tet) {
  return state.fill.empty() ? model.volumes_mm3[tet] : state.fill[tet] * model.volumes_mm3[tet];
}

/// Kind of stiffness matrix: which derivative −∂f/∂x of the forces.
enum class Tangent {
  FrozenRotations,  ///< positive semi-definite and cheap: rotations held fixed (corotational), else as Projected
  Exact,            ///< the Hessian of the energy
  Projected,        ///< as Exact, with the negative curvatures of each tet set to zero: positive semi-definite
};

/// Adds the elastic forces (minus the energy gradient) of the live tets at state.positions to `forces` (N x 3, mN), and
/// the tangent −∂f/∂x to `stiffness` unless it is null. Updates state.rotations. For viscous tissue this is the
/// long-time response. Finite for inverted and collapsed tets. Sums have a fixed order: same bits at any thread count.
/// @pre `stiffness` is symmetric.  @throws InvalidArgument for arrays of the wrong size, or a matrix of another pattern
/// object than model.pattern.
void add_elastic_response(const TissueModel& model, TissueState& state, std::span<Vec3> forces, BlockMatrix* stiffness,
                          Workers& workers, Tangent tangent = Tangent::FrozenRotations);

/// Adds viscous forces to `forces` (N x 3, mN), and their tangent to `stiffness` unless it is null: those at the end of
/// a step of `step_s` (> 0) that began with state.memory and ends at state.positions. They are minus the gradient of
/// viscous_potential_uj. Does nothing without viscosity. @throws InvalidArgument for step_s <= 0, arrays of the wrong
/// size, a matrix of another pattern object than model.pattern, or a memory that does not fit the model (rest_state
/// provides one).
void add_viscous_response(const TissueModel& model, const TissueState& state, double step_s, std::span<Vec3> forces,
                          BlockMatrix* stiffness, Workers& workers, Tangent tangent = Tangent::FrozenRotations);
/// Returns the potential of a step's viscous forces, µJ, up to a constant. @throws as add_viscous_response.
[[nodiscard]] double viscous_potential_uj(const TissueModel& model, const TissueState& state, double step_s);
/// Ends a viscous step at state.positions: advances state.memory. An infinite `step_s` relaxes every branch completely,
/// as after a static solution. @throws as add_viscous_response.
void end_viscous_step(const TissueModel& model, TissueState& state, double step_s, Workers& workers);

/// Returns the shear stiffness in one step of `during_s` (> 0, s) divided by the long-time one: 1 + Σ shear_share
/// exp(−during_s / (2 time_s)) + kelvin_voigt_time_s / during_s; 1 without viscosity.
[[nodiscard]] double shear_ratio(const Material& material, double during_s);
/// Sets state.memory as if the tissue had been brought from rest to state.positions in an instant, `since_s` ago. Does
/// nothing without viscosity.
/// @param since_s  s, >= 0; infinite: every branch has relaxed.  @throws InvalidArgument for a negative one.
void remember_deformation(const TissueModel& model, TissueState& state, double since_s);

/// Adds the push of the supports (they never pull) to `forces` (N x 3, mN), and its tangent k n nᵀ to `stiffness`
/// unless it is null. The tangent is exact on a plane and on flat parts of a holder; where the nearest point lies on an
/// edge or a corner, it omits the rotation of the normal. @throws InvalidArgument for forces of the wrong size, or a
/// matrix of another pattern object than model.pattern.
void add_support_response(const TissueModel& model, const TissueState& state, std::span<Vec3> forces,
                          BlockMatrix* stiffness);

/// Returns the energy stored in the penalty of the supports, µJ.
[[nodiscard]] double support_energy_uj(const TissueModel& model, const TissueState& state);
/// Returns the depth of the deepest vertex behind a support, mm; 0: none is behind one.
[[nodiscard]] double support_penetration_mm(const TissueModel& model, const TissueState& state);

/// Returns the elastic energy of the live tets, µJ.
[[nodiscard]] double elastic_energy_uj(const TissueModel& model, const TissueState& state);

/// Replaces the rows and columns of constrained axes, and of vertices whose diagonal block is zero, by those of the
/// identity, and sets the right side (N x 3) to zero there: the solution then does not move them.
/// @param also_held  N flags or empty: further vertices to hold.
/// @throws InvalidArgument for a matrix of another pattern or arrays of the wrong size.
void hold_constrained(const TissueModel& model, BlockMatrix& matrix, std::span<Vec3> right_side,
                      std::span<const std::uint8_t> also_held = {});

}  // namespace incise
