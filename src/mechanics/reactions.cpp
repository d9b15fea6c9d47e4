#include "mechanics/reactions.hpp"

#include "mechanics/support.hpp"

#include <cmath>

namespace incise {

Points free_axes(const TissueModel& model, const TissueState& state) {
  Points is_free(model.mesh.vertices.size(), Vec3::Zero());
  for (std::size_t tet = 0; tet < model.mesh.tets.size(); ++tet) {
    if (state.is_live[tet] == 0) continue;
    for (const VertexId v : model.mesh.tets[tet]) is_free[v.index()] = Vec3::Ones();
  }
  for (std::size_t v = 0; v < is_free.size(); ++v) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (model.is_fixed[v][i]) is_free[v][static_cast<int>(i)] = 0.0;
    }
  }
  return is_free;
}

double free_norm(std::span<const Vec3> vectors, std::span<const Vec3> is_free) {
  double squared = 0.0;
  for (std::size_t v = 0; v < vectors.size(); ++v) squared += vectors[v].cwiseProduct(is_free[v]).squaredNorm();
  return std::sqrt(squared);
}

double negligible_force_mn(const TissueModel& model) {
  const double size = bounding_box(model.mesh.vertices).diagonal().norm();
  return 1e-6 * model.material.youngs_modulus_kpa * size * size;
}

std::vector<Vec3> reactions(const TissueModel& model, const TissueState& state, Workers& workers) {
  std::vector<Vec3> result = model.applied_load_mn;
  TissueState scratch = state;
  Points forces = model.dead_load_mn;
  add_elastic_response(model, scratch, forces, nullptr, workers);
  add_support_response(model, scratch, forces, nullptr);
  for (std::size_t v = 0; v < forces.size(); ++v) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t holder = model.holder[v][i];
      if (holder >= 0) result[static_cast<std::size_t>(holder)][static_cast<int>(i)] -= forces[v][static_cast<int>(i)];
    }
  }
  for (const SupportPlane& plane : model.supports) {
    for (std::size_t i = 0; i < plane.vertices.size(); ++i) {
      const SupportGap at = support_gap(plane, state.positions[plane.vertices[i].index()]);
      if (at.gap_mm < 0.0) result[plane.constraint] -= plane.stiffness[i] * at.gap_mm * at.normal;
    }
  }
  return result;
}

}  // namespace incise
