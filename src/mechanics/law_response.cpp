#include "mechanics/law_response.hpp"

#include "mechanics/chunks.hpp"
#include "mechanics/laws.hpp"
#include "mechanics/rotation.hpp"
#include "mechanics/volume_averages.hpp"

#include <incise/core/error.hpp>

#include <optional>

namespace incise {
namespace {

/// Response of every live tet at one state.
class TetResponses {
 public:
  TetResponses(const TissueModel& model, TissueState& state, Workers& workers)
      : model_(model), state_(state), workers_(workers), deformations_(model.mesh.tets.size()) {
    const bool is_averaged = model.material.volume == VolumeTreatment::Averaged;
    if (is_averaged) dilations_.resize(deformations_.size());
    for_live_tets([&](std::size_t tet) {
      Deformation& d = deformations_[tet];
      d.f = deformation_gradient(model_, state_.positions, tet);
      d.r = nearest_rotation(d.f, state_.rotations[tet]);
      state_.rotations[tet] = d.r;
      if (is_averaged) dilations_[tet] = dilation(model_.material.model, d);
    });
    if (is_averaged) averages_.emplace(model, state, dilations_, workers);
  }

  void find_stresses() {
    stresses_.assign(deformations_.size(), Mat3::Zero());
    for_live_tets([&](std::size_t tet) { stresses_[tet] = stress(tet); });
  }

  void find_tangents(Tangent tangent) {
    tangents_.resize(deformations_.size());
    if (!model_.fibres.empty()) fibre_tangents_.resize(deformations_.size());
    for_live_tets([&](std::size_t tet) {
      const Deformation& d = deformations_[tet];
      tangents_[tet] = principal_tangent(shape_law(tet), pressure_kpa(tet),
                                         averages_ ? 0.0 : model_.lame[tet].lambda_kpa, d, tangent);
      if (model_.fibres.empty()) return;
      fibre_tangents_[tet] = fibre_tangent_kpa(fibre_law(), model_.fibres[tet], d.f, tangent);
    });
  }

  [[nodiscard]] const std::vector<Mat3>& stresses() const { return stresses_; }

  /// Adds the four blocks in the row of `corner`.
  void add_stiffness(std::size_t tet, std::size_t corner, BlockMatrix& matrix) const {
    const auto& gradients = model_.gradients[tet];
    const Mat3 to_principal = tangents_[tet].v.transpose();
    std::array<Vec3, 4> principal;
    for (std::size_t c = 0; c < 4; ++c) principal[c] = to_principal * gradients[c];
    add_blocks(model_, state_, tet, corner, matrix, [&](std::size_t a, std::size_t b) {
      Mat3 block = stiffness_block(tangents_[tet], principal[a], principal[b]);
      if (a == b) block = (0.5 * (block + block.transpose())).eval();
      if (!model_.fibres.empty()) {
        const Vec3& fibre = model_.fibres[tet];
        block += (gradients[a].dot(fibre) * gradients[b].dot(fibre)) * fibre_tangents_[tet];
      }
      return block;
    });
  }

  void add_averaged_stiffness(BlockMatrix& matrix) const {
    if (!averages_) return;
    std::vector<Mat3> gradients(deformations_.size());
    for_live_tets(
        [&](std::size_t tet) { gradients[tet] = dilation_gradient(model_.material.model, deformations_[tet]); });
    averages_->add_stiffness(state_, gradients, matrix, workers_);
  }

  [[nodiscard]] double energy_uj() const {
    const Material& material = model_.material;
    double energy = averages_ ? averages_->energy_uj() : 0.0;
    for (std::size_t tet = 0; tet < deformations_.size(); ++tet) {
      if (state_.is_live[tet] == 0) continue;
      const Deformation& d = deformations_[tet];
      double density = shape_energy_kpa(shape_law(tet), d);
      if (!averages_) {
        const double theta = dilation(material.model, d);
        density += 0.5 * model_.lame[tet].lambda_kpa * theta * theta;
      }
      if (!model_.fibres.empty()) density += fibre_energy_kpa(fibre_law(), model_.fibres[tet], d.f);
      energy += filled_volume_mm3(model_, state_, tet) * density;
    }
    return energy;
  }

 private:
  template <class Body>
  void for_live_tets(const Body& body) const {
    workers_.for_each(deformations_.size(), kTetsPerChunk, [&](std::size_t tet) {
      if (state_.is_live[tet] != 0) body(tet);
    });
  }

  [[nodiscard]] ShapeLaw shape_law(std::size_t tet) const {
    return {model_.material.model, model_.lame[tet].mu_kpa, model_.material.stiffening};
  }

  [[nodiscard]] FibreLaw fibre_law() const {
    return {model_.material.fibre_modulus_kpa, model_.material.fibre_stiffening};
  }

  [[nodiscard]] double pressure_kpa(std::size_t tet) const {
    if (averages_) return averages_->pressure_kpa(model_.mesh.tets[tet]);
    return model_.lame[tet].lambda_kpa * dilation(model_.material.model, deformations_[tet]);
  }

  [[nodiscard]] Mat3 stress(std::size_t tet) const {
    const Deformation& d = deformations_[tet];
    Mat3 p = shape_stress_kpa(shape_law(tet), d) + pressure_kpa(tet) * dilation_gradient(model_.material.model, d);
    if (!model_.fibres.empty()) p += fibre_stress_kpa(fibre_law(), model_.fibres[tet], d.f);
    return p;
  }

  const TissueModel& model_;
  TissueState& state_;
  Workers& workers_;
  std::vector<Deformation> deformations_;
  std::vector<double> dilations_;
  std::optional<VolumeAverages> averages_;
  std::vector<Mat3> stresses_;
  std::vector<PrincipalTangent> tangents_;
  std::vector<Mat3> fibre_tangents_;
};

}  // namespace

bool is_plain_corotational(const TissueModel& model) {
  return model.material.model == MaterialModel::Corotational && model.material.volume == VolumeTreatment::PerTet &&
         model.fibres.empty();
}

void add_law_response(const TissueModel& model, TissueState& state, std::span<Vec3> forces, BlockMatrix* stiffness,
                      Tangent tangent, Workers& workers) {
  INCISE_REQUIRE(stiffness == nullptr || stiffness->pattern == model.pattern,
                 "expected a matrix of the model's own pattern");
  TetResponses tets(model, state, workers);
  tets.find_stresses();
  if (stiffness != nullptr) tets.find_tangents(tangent);
  // Each vertex gathers from its tets in ascending order: no two threads write to the same row, and the order of sums
  // is fixed.
  workers.for_each(model.mesh.vertices.size(), kVerticesPerChunk, [&](std::size_t v) {
    Vec3 force = Vec3::Zero();
    for_live_corners(model, state, v, [&](std::size_t tet, std::size_t corner) {
      force -= filled_volume_mm3(model, state, tet) * (tets.stresses()[tet] * model.gradients[tet][corner]);
      if (stiffness != nullptr) tets.add_stiffness(tet, corner, *stiffness);
    });
    forces[v] += force;
  });
  if (stiffness != nullptr) tets.add_averaged_stiffness(*stiffness);
}

double law_energy_uj(const TissueModel& model, const TissueState& state) {
  Workers here(1);
  TissueState scratch = state;
  return TetResponses(model, scratch, here).energy_uj();
}

std::vector<Mat3> law_stresses_kpa(const TissueModel& model, const TissueState& state) {
  Workers here(1);
  TissueState scratch = state;
  TetResponses tets(model, scratch, here);
  tets.find_stresses();
  return tets.stresses();
}

}  // namespace incise
