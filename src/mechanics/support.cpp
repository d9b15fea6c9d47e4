#include "mechanics/support.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/tissue.hpp>

#include <fmt/format.h>

namespace incise {

void add_support_response(const TissueModel& model, const TissueState& state, std::span<Vec3> forces,
                          BlockMatrix* stiffness) {
  INCISE_REQUIRE(forces.size() == model.mesh.vertices.size(),
                 fmt::format("expected {} forces, found {}", model.mesh.vertices.size(), forces.size()));
  for (const SupportPlane& plane : model.supports) {
    const Mat3 across = plane.normal * plane.normal.transpose();
    for (std::size_t i = 0; i < plane.vertices.size(); ++i) {
      const std::size_t v = plane.vertices[i].index();
      const double gap = (state.positions[v] - plane.point_mm).dot(plane.normal);
      if (!(gap <= 0.0))
        continue;  // clear of the plane: it never pulls; at the plane it resists from the first step on
      forces[v] -= plane.stiffness[i] * gap * plane.normal;
      if (stiffness == nullptr) continue;
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(stiffness->block(model.pattern->diagonal[v])) +=
          plane.stiffness[i] * across;
    }
  }
}

std::vector<std::uint8_t> support_contacts(const TissueModel& model, const TissueState& state) {
  std::vector<std::uint8_t> touches;
  for (const SupportPlane& plane : model.supports) {
    for (const VertexId v : plane.vertices) {
      touches.push_back((state.positions[v.index()] - plane.point_mm).dot(plane.normal) <= 0.0 ? 1 : 0);
    }
  }
  return touches;
}

double support_energy_uj(const TissueModel& model, const TissueState& state) {
  double energy = 0.0;
  for (const SupportPlane& plane : model.supports) {
    for (std::size_t i = 0; i < plane.vertices.size(); ++i) {
      const double gap = (state.positions[plane.vertices[i].index()] - plane.point_mm).dot(plane.normal);
      if (gap < 0.0) energy += 0.5 * plane.stiffness[i] * gap * gap;
    }
  }
  return energy;
}

double support_penetration_mm(const TissueModel& model, const TissueState& state) {
  double deepest = 0.0;
  for (const SupportPlane& plane : model.supports) {
    for (const VertexId v : plane.vertices) {
      deepest = std::max(deepest, (plane.point_mm - state.positions[v.index()]).dot(plane.normal));
    }
  }
  return deepest;
}

}  // namespace incise
