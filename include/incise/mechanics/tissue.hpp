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

/// A support plane, or a holder's surface in its place, and the stiffness with which it pushes a vertex back, mN/mm per
/// vertex (penalty, chosen from the material and the vertex's surface area so that penetration stays below 0.05 mm under
/// the loads of a clamped tongue).
struct SupportPlane {
  std::size_t constraint = 0;  ///< index into TissueModel::constraints
  Vec3 point_mm = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();     ///< unit
  std::shared_ptr<const HolderContact> holder;  ///< null: the plane; shared, because the model is copied
  std::vector<VertexId> vertices;  ///< boundary vertices that can move along the normal
  std::vector<double> stiffness;   ///< mN/mm, one per vertex
};

struct TetBatches;  // the tets in the order and layout of the vectorised kernels: src/mechanics/tet_batches.hpp

/// Everything about the tissue that a simulation does not change. Built once, shared between runs.
struct TissueModel {
  TetMesh mesh;  ///< rest positions, mm
  Material material;
  std::vector<Constraint> constraints;           ///< as given
  std::vector<std::array<Vec3, 4>> gradients;    ///< per tet: gradient of each corner's shape function at rest, 1/mm
  std::vector<double> volumes_mm3;               ///< per tet, at rest
  std::vector<LameParameters> lame;              ///< per tet
  std::vector<Vec3> fibres;                      ///< per tet: unit direction at rest; empty without fibres
  std::vector<double> toughness;                 ///< per tet: against cutting, relative to the reference tissue; empty: 1 everywhere
  std::vector<double> vertex_mass_kg;            ///< lumped: a quarter of each adjacent tet
  std::vector<std::array<bool, 3>> is_fixed;     ///< per vertex and axis
  std::vector<Vec3> prescribed_displacement_mm;  ///< per vertex; used where is_fixed
  std::vector<std::array<std::int32_t, 3>>
      holder;                         ///< per vertex and axis: the first constraint that holds it, -1: none
  std::vector<Vec3> dead_load_mn;     ///< per vertex: gravity and tractions
  std::vector<Vec3> applied_load_mn;  ///< per constraint: sum of its tractions (0 for other kinds)
  std::vector<SupportPlane> supports;
  std::shared_ptr<const BlockPattern> stars;    ///< per vertex: the vertices of its tets, itself among them
  /// Of the stiffness: `stars`, or with averaged volume, where tets also feel the neighbours of their corners, stars of
  /// stars.
  std::shared_ptr<const BlockPattern> pattern;
  std::vector<std::array<std::int32_t, 16>> tet_slots;  ///< per tet: slot of block (corner a, corner b) at 4 a + b
  std::vector<std::int32_t> vertex_tet_start;           ///< N + 1, into vertex_tets
  std::vector<std::int32_t> vertex_tets;                ///< 4 * tet + corner, ascending: for gathering in fixed order
  std::shared_ptr<const TetBatches> batches;            ///< a copy of the above for the kernels: to be made anew if that changes
};

/// Builds the model. Throws CaseError (field "specimen.…") for a material out of range, a region that selects nothing,
/// contradictory constraints on one vertex, too few constraints to stop rigid motion; InvalidArgument when
/// find_problems(mesh) finds any.
[[nodiscard]] TissueModel make_tissue_model(TetMesh mesh, const Material& material, std::vector<Constraint> constraints,
                                            const Vec3& gravity_mm_s2 = Vec3::Zero(),
                                            const MaterialField& field = {});

/// The model on the split mesh: a copy has its original's material, constraints and prescribed displacement; mass, dead
/// load and a support's stiffness are shared among the copies of a vertex by the tissue about each. Volumes are those
/// of whole tets: TissueState::fill says how much of it a tet of the split mesh holds. O(M log M).
/// @throws InvalidArgument for splits that are not of this model's mesh.
[[nodiscard]] TissueModel split_model(const TissueModel& whole, const MeshSplits& splits);

/// What a tet of the split mesh holds, mm³ at rest. @param split  the model on that mesh
[[nodiscard]] inline double rest_volume_mm3(const TissueModel& split, const MeshSplits& splits, TetId tet) {
  const std::size_t whole_count = split.mesh.tets.size() - splits.copies.size();
  return share_of(splits, whole_count, tet) * split.volumes_mm3[tet.index()];
}

/// Against cutting, relative to the reference tissue (1).
[[nodiscard]] inline double relative_toughness(const TissueModel& model, std::size_t tet) {
  return model.toughness.empty() ? 1.0 : model.toughness[tet];
}

/// What viscous tissue remembers: strains of Green and Lagrange without their volumetric part. Empty without viscosity.
struct ViscousMemory {
  std::vector<Mat3> strains;   ///< per tet: at the end of the last step
  std::vector<Mat3> branches;  ///< per tet and Prony term (tet * terms + term): strain of the branch's spring
  [[nodiscard]] bool operator==(const ViscousMemory&) const = default;
};
inline void describe(Visitor& v, ViscousMemory& m) {
  v("strains", m.strains, "Of each tet at the end of the last step.");
  v("branches", m.branches, "Strain of each branch's spring, tet by tet.");
}

/// What a simulation changes: a value that can be saved, compared and restored.
struct TissueState {
  Points positions;                   ///< N x 3, mm
  std::vector<Mat3> rotations;        ///< per tet, warm start of the polar decomposition; proper
  std::vector<std::uint8_t> is_live;  ///< per tet: 1 until it is carved
  std::vector<double> fill;           ///< per live tet: the share of its stiffness that is left, (0, 1]; empty: 1
  ViscousMemory memory;               ///< of viscous tissue; changed by end_viscous_step alone
};
inline void describe(Visitor& v, TissueState& s) {
  v("positions", s.positions, "Of the vertices.");
  v("rotations", s.rotations, "Of the tets: where the polar decomposition starts.");
  v("is_live", s.is_live, "Of each tet: 1 until it is carved.");
  v("fill", s.fill, "Of each live tet: the share of its stiffness that is left; empty: 1.");
  v("memory", s.memory, "Of viscous tissue.");
}
[[nodiscard]] TissueState rest_state(const TissueModel& model);

/// The share of a tet's stiffness that is left; 0: it is carved.
[[nodiscard]] inline double filled_share(const TissueState& state, std::size_t tet) {
  if (state.is_live[tet] == 0) return 0.0;
  return state.fill.empty() ? 1.0 : state.fill[tet];
}
/// What is left of a live tet's rest volume, mm³.
[[nodiscard]] inline double filled_volume_mm3(const TissueModel& model, const TissueState& state, std::size_t tet) {
  return state.fill.empty() ? model.volumes_mm3[tet] : state.fill[tet] * model.volumes_mm3[tet];
}

/// Which derivative of the forces is wanted.
enum class Tangent {
  FrozenRotations,  ///< positive semi-definite and cheap: rotations held (corotational), else as Projected
  Exact,            ///< the Hessian of the energy
  Projected,        ///< as Exact, each tet's negative curvatures set to zero: positive semi-definite
};

/// Elastic forces (minus the energy gradient) of the live tets at state.positions, mN; adds to `forces` (N). Updates
/// state.rotations. With `stiffness`: also adds the tangent −∂f/∂x. The long-time response of viscous tissue. Finite for
/// inverted and collapsed tets. Fixed order: same bits at any thread count.
void add_elastic_response(const TissueModel& model, TissueState& state, std::span<Vec3> forces, BlockMatrix* stiffness,
                          Tangent tangent, Workers& workers);
/// The same with the tangent of frozen rotations.
void add_elastic_response(const TissueModel& model, TissueState& state, std::span<Vec3> forces, BlockMatrix* stiffness,
                          Workers& workers);

/// Adds the viscous forces, mN, at the end of a step of `step_s` (> 0) that ends at state.positions and began with
/// state.memory; with `stiffness` their tangent. They are minus the gradient of viscous_potential_uj. Nothing without
/// viscosity. @throws InvalidArgument when the memory is not that of this model (rest_state gives one).
void add_viscous_response(const TissueModel& model, const TissueState& state, double step_s, std::span<Vec3> forces,
                          BlockMatrix* stiffness, Tangent tangent, Workers& workers);
/// The same with the tangent of frozen rotations (projected).
void add_viscous_response(const TissueModel& model, const TissueState& state, double step_s, std::span<Vec3> forces,
                          BlockMatrix* stiffness, Workers& workers);
/// What a step's viscous forces are the gradient of, µJ, up to a constant over the step.
[[nodiscard]] double viscous_potential_uj(const TissueModel& model, const TissueState& state, double step_s);
/// Ends a step at state.positions: carries the memory over. An infinite `step_s` lets every branch relax, as after a
/// static solution.
void end_viscous_step(const TissueModel& model, TissueState& state, double step_s, Workers& workers);

/// How stiff tissue is against a shear that goes on for `during_s` (> 0), over its long-time response; 1 without
/// viscosity.
[[nodiscard]] double shear_ratio(const Material& material, double during_s);
/// Sets state.memory to that of tissue that was brought from rest to state.positions at once, some time ago.
/// @param since_s  >= 0; infinite: every branch has relaxed. Nothing without viscosity.
void remember_deformation(const TissueModel& model, TissueState& state, double since_s);

/// Adds the push of the supports (no pull) and, with `stiffness`, its tangent k n nᵀ: exact on a plane and on the flat
/// parts of a holder, without the turn of the normal where the nearest place is an edge or a corner.
void add_support_response(const TissueModel& model, const TissueState& state, std::span<Vec3> forces,
                          BlockMatrix* stiffness);

/// Energy stored by the supports' push, µJ, and the depth of the vertex that lies deepest behind one, mm (0: none
/// does).
[[nodiscard]] double support_energy_uj(const TissueModel& model, const TissueState& state);
[[nodiscard]] double support_penetration_mm(const TissueModel& model, const TissueState& state);

/// Elastic energy of the live tets, µJ.
[[nodiscard]] double elastic_energy_uj(const TissueModel& model, const TissueState& state);

/// Replaces the rows and columns of constrained axes (and of vertices on whose diagonal block nothing was added) by
/// identity rows, and the right side by zero there: the solution then keeps those still. Vertices to hold beside the
/// model's own may be given (one flag per vertex).
void hold_constrained(const TissueModel& model, BlockMatrix& matrix, std::span<Vec3> right_side,
                      std::span<const std::uint8_t> also_held = {});

}  // namespace incise
