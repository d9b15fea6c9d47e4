#include "mechanics/elastic_response.hpp"

#include "mechanics/corotational_response.hpp"
#include "mechanics/law_response.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

namespace incise {
namespace {

void check_sizes(const TissueModel& model, const TissueState& state, std::size_t forces) {
  INCISE_REQUIRE(state.positions.size() == model.mesh.vertices.size() && forces == model.mesh.vertices.size(),
                 fmt::format("expected {} vertices, found {} positions and {} forces", model.mesh.vertices.size(),
                             state.positions.size(), forces));
  INCISE_REQUIRE(state.rotations.size() == model.mesh.tets.size() && state.is_live.size() == model.mesh.tets.size(),
                 fmt::format("expected {} tets, found {} rotations and {} flags", model.mesh.tets.size(),
                             state.rotations.size(), state.is_live.size()));
  INCISE_REQUIRE(state.fill.empty() || state.fill.size() == model.mesh.tets.size(),
                 fmt::format("expected {} shares of stiffness, found {}", model.mesh.tets.size(), state.fill.size()));
}

}  // namespace

Mat3 deformation_gradient(const TissueModel& model, std::span<const Vec3> positions, std::size_t tet) {
  const Tet& corners = model.mesh.tets[tet];
  const Vec3& origin = vertex(positions, corners[0]);  // differences preserve precision for a body far from the origin
  Mat3 f = Mat3::Zero();
  for (std::size_t c = 1; c < 4; ++c) {
    f.noalias() += (vertex(positions, corners[c]) - origin) * model.gradients[tet][c].transpose();
  }
  return f;
}

void add_elastic_response(const TissueModel& model, TissueState& state, std::span<Vec3> forces, BlockMatrix* stiffness,
                          Workers& workers, Tangent tangent) {
  check_sizes(model, state, forces.size());
  if (is_plain_corotational(model)) {
    add_corotational_response(model, state, forces, stiffness, tangent, workers);
  } else {
    add_law_response(model, state, forces, stiffness, tangent, workers);
  }
}

double elastic_energy_uj(const TissueModel& model, const TissueState& state) {
  check_sizes(model, state, model.mesh.vertices.size());
  return is_plain_corotational(model) ? corotational_energy_uj(model, state) : law_energy_uj(model, state);
}

}  // namespace incise
