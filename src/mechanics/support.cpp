#include "mechanics/support.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/tissue.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise {

SupportGap support_gap(const SupportPlane& support, const Vec3& p) {
  if (support.holder) return support.holder->gap(p);
  return {(p - support.point_mm).dot(support.normal), support.normal};
}

void add_support_response(const TissueModel& model, const TissueState& state, std::span<Vec3> forces,
                          BlockMatrix* stiffness) {
  INCISE_REQUIRE(forces.size() == model.mesh.vertices.size(),
                 fmt::format("expected {} forces, found {}", model.mesh.vertices.size(), forces.size()));
  INCISE_REQUIRE(stiffness == nullptr || stiffness->pattern == model.pattern,
                 "expected a matrix of the model's own pattern");
  for (const SupportPlane& support : model.supports) {
    for (std::size_t i = 0; i < support.vertices.size(); ++i) {
      const std::size_t v = support.vertices[i].index();
      const SupportGap at = support_gap(support, state.positions[v]);
      if (!(at.gap_mm <= 0.0))
        continue;  // clear of the surface: a support never pulls. At the surface it resists from the first step on.
      forces[v] -= support.stiffness[i] * at.gap_mm * at.normal;
      if (stiffness == nullptr) continue;
      stiffness->at(model.pattern->diagonal[v]) += support.stiffness[i] * (at.normal * at.normal.transpose());
    }
  }
}

std::vector<std::uint8_t> support_contacts(const TissueModel& model, const TissueState& state) {
  std::vector<std::uint8_t> touches;
  for (const SupportPlane& support : model.supports) {
    for (const VertexId v : support.vertices) {
      touches.push_back(support_gap(support, state.positions[v.index()]).gap_mm <= 0.0 ? 1 : 0);
    }
  }
  return touches;
}

double support_energy_uj(const TissueModel& model, const TissueState& state) {
  double energy = 0.0;
  for (const SupportPlane& support : model.supports) {
    for (std::size_t i = 0; i < support.vertices.size(); ++i) {
      const double gap = support_gap(support, state.positions[support.vertices[i].index()]).gap_mm;
      if (gap < 0.0) energy += 0.5 * support.stiffness[i] * gap * gap;
    }
  }
  return energy;
}

double penetration_mm(const SupportPlane& support, const TissueState& state) {
  double deepest = 0.0;
  for (const VertexId v : support.vertices) {
    deepest = std::max(deepest, -support_gap(support, state.positions[v.index()]).gap_mm);
  }
  return deepest;
}

double support_penetration_mm(const TissueModel& model, const TissueState& state) {
  double deepest = 0.0;
  for (const SupportPlane& support : model.supports) deepest = std::max(deepest, penetration_mm(support, state));
  return deepest;
}

}  // namespace incise
