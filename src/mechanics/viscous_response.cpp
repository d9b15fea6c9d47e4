#include "mechanics/viscous_response.hpp"

#include "mechanics/chunks.hpp"
#include "mechanics/elastic_response.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>

namespace incise {
namespace {

/// Returns the deviator of the Green-Lagrange strain (Fᵀ F − I)/2.
Mat3 strain_deviator(const Mat3& f) {
  const Mat3 c = f.transpose() * f;
  return 0.5 * (c - c.trace() / 3.0 * Mat3::Identity());
}

/// One step of a Maxwell branch: q ← decay q + uptake (D − D_old).
struct BranchStep {
  double share, decay, uptake;
};

struct ViscousStep {
  std::vector<BranchStep> branches;
  double damper = 0.0;   ///< η / (μ dt)
  double stiffness = 0;  ///< derivative of the stress with respect to D, divided by 2 μ

  ViscousStep(const Material& material, double step_s) {
    for (const PronyTerm& term : material.prony) {
      const double half = std::exp(-0.5 * step_s / term.time_s);
      branches.push_back({term.shear_share, half * half, half});
      stiffness += term.shear_share * half;
    }
    damper = material.kelvin_voigt_time_s / step_s;
    stiffness += damper;
  }
};

/// The viscous law of one model for one step, with the memory at its start.
class ViscousTets {
 public:
  ViscousTets(const TissueModel& model, const TissueState& state, double step_s)
      : model_(model), state_(state), step_(model.material, step_s) {}

  [[nodiscard]] Mat3 deformation(std::size_t tet) const { return deformation_gradient(model_, state_.positions, tet); }

  /// Returns q of branch i at the end of the step.
  [[nodiscard]] Mat3 branch(std::size_t tet, std::size_t i, const Mat3& change) const {
    const BranchStep& b = step_.branches[i];
    return b.decay * state_.memory.branches[tet * step_.branches.size() + i] + b.uptake * change;
  }

  [[nodiscard]] Mat3 change(std::size_t tet, const Mat3& f) const {
    return strain_deviator(f) - state_.memory.strains[tet];
  }

  /// Returns the second Piola stress, kPa; its trace is 0.
  [[nodiscard]] Mat3 stress(std::size_t tet, const Mat3& f) const {
    const Mat3 d = change(tet, f);
    Mat3 sum = step_.damper * d;
    for (std::size_t i = 0; i < step_.branches.size(); ++i) sum += step_.branches[i].share * branch(tet, i, d);
    return 2.0 * model_.lame[tet].mu_kpa * sum;
  }

  /// Returns the energy density, kPa, whose derivative with respect to the final strain is the stress.
  [[nodiscard]] double potential(std::size_t tet) const {
    const Mat3 d = change(tet, deformation(tet));
    double sum = step_.damper * d.squaredNorm();
    for (std::size_t i = 0; i < step_.branches.size(); ++i) {
      // |decay q + uptake d|² / uptake without its constant term: safe if uptake underflows to 0.
      const BranchStep& b = step_.branches[i];
      const Mat3& q = state_.memory.branches[tet * step_.branches.size() + i];
      sum += b.share * (b.uptake * d.squaredNorm() + 2.0 * b.decay * q.cwiseProduct(d).sum());
    }
    return model_.lame[tet].mu_kpa * sum;
  }

  /// Returns m of the tangent dS = 2 m dev dE, kPa.
  [[nodiscard]] double modulus(std::size_t tet) const { return model_.lame[tet].mu_kpa * step_.stiffness; }
  [[nodiscard]] std::size_t branch_count() const { return step_.branches.size(); }

 private:
  const TissueModel& model_;
  const TissueState& state_;
  ViscousStep step_;
};

/// Returns the stress with its negative eigenvalues set to zero: compression could make the tangent indefinite.
Mat3 without_compression(const Mat3& stress) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(stress);
  const Vec3 values = solver.eigenvalues().cwiseMax(0.0);
  return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

/// Returns block (a, b) of the tangent per volume: with Fa = F g_a,
/// (g_a · S g_b) I + m (g_a · g_b) F Fᵀ + m Fb Faᵀ − 2m/3 Fa Fbᵀ.
Mat3 viscous_block(const Mat3& f, const Mat3& geometric_stress, double m, const Vec3& a, const Vec3& b) {
  const Vec3 fa = f * a;
  const Vec3 fb = f * b;
  Mat3 block = m * a.dot(b) * (f * f.transpose()) + m * (fb * fa.transpose()) - 2.0 / 3.0 * m * (fa * fb.transpose());
  block.diagonal().array() += a.dot(geometric_stress * b);
  return block;
}

void check(const TissueModel& model, const TissueState& state, double step_s) {
  const std::size_t tets = model.mesh.tets.size();
  INCISE_REQUIRE(step_s > 0.0, fmt::format("expected a step above 0 s, found {}", step_s));
  INCISE_REQUIRE(state.positions.size() == model.mesh.vertices.size() && state.is_live.size() == tets,
                 fmt::format("expected {} vertices and {} tets, found {} and {}", model.mesh.vertices.size(), tets,
                             state.positions.size(), state.is_live.size()));
  INCISE_REQUIRE(
      state.memory.strains.size() == tets && state.memory.branches.size() == tets * model.material.prony.size(),
      fmt::format("expected the viscous memory of {} tets with {} branches each, found {} and {} in all", tets,
                  model.material.prony.size(), state.memory.strains.size(), state.memory.branches.size()));
}

}  // namespace

double shear_ratio(const Material& material, double during_s) {
  return 1.0 + ViscousStep(material, during_s).stiffness;
}

ViscousMemory rest_memory(const Material& material, std::size_t tets) {
  ViscousMemory memory;
  if (!is_viscous(material)) return memory;
  memory.strains.assign(tets, Mat3::Zero());
  memory.branches.assign(tets * material.prony.size(), Mat3::Zero());
  return memory;
}

void add_viscous_response(const TissueModel& model, const TissueState& state, double step_s, std::span<Vec3> forces,
                          BlockMatrix* stiffness, Workers& workers, Tangent tangent) {
  if (!is_viscous(model.material)) return;
  check(model, state, step_s);
  INCISE_REQUIRE(forces.size() == model.mesh.vertices.size(),
                 fmt::format("expected {} forces, found {}", model.mesh.vertices.size(), forces.size()));
  INCISE_REQUIRE(stiffness == nullptr || stiffness->pattern == model.pattern,
                 "expected a matrix of the model's own pattern");
  const ViscousTets tets(model, state, step_s);
  struct Response {
    Mat3 f, stress, geometric;
  };
  std::vector<Response> responses(model.mesh.tets.size());
  workers.for_each(responses.size(), kTetsPerChunk, [&](std::size_t tet) {
    if (state.is_live[tet] == 0) return;
    Response& r = responses[tet];
    r.f = tets.deformation(tet);
    r.stress = tets.stress(tet, r.f);
    if (stiffness != nullptr) r.geometric = tangent == Tangent::Exact ? r.stress : without_compression(r.stress);
  });
  workers.for_each(forces.size(), kVerticesPerChunk, [&](std::size_t v) {
    Vec3 force = Vec3::Zero();
    for_live_corners(model, state, v, [&](std::size_t tet, std::size_t corner) {
      const Response& r = responses[tet];
      const auto& g = model.gradients[tet];
      force -= filled_volume_mm3(model, state, tet) * (r.f * (r.stress * g[corner]));
      if (stiffness == nullptr) return;
      add_blocks(model, state, tet, corner, *stiffness, [&](std::size_t a, std::size_t b) {
        Mat3 block = viscous_block(r.f, r.geometric, tets.modulus(tet), g[a], g[b]);
        if (a == b) block = (0.5 * (block + block.transpose())).eval();
        return block;
      });
    });
    forces[v] += force;
  });
}

double viscous_potential_uj(const TissueModel& model, const TissueState& state, double step_s) {
  if (!is_viscous(model.material)) return 0.0;
  check(model, state, step_s);
  const ViscousTets tets(model, state, step_s);
  double sum = 0.0;
  for (std::size_t tet = 0; tet < model.mesh.tets.size(); ++tet) {
    if (state.is_live[tet] != 0) sum += filled_volume_mm3(model, state, tet) * tets.potential(tet);
  }
  return sum;
}

void remember_deformation(const TissueModel& model, TissueState& state, double since_s) {
  if (!is_viscous(model.material)) return;
  INCISE_REQUIRE(since_s >= 0.0, fmt::format("expected a time of 0 s or more, found {}", since_s));
  const std::vector<PronyTerm>& terms = model.material.prony;
  state.memory = rest_memory(model.material, model.mesh.tets.size());
  for (std::size_t tet = 0; tet < model.mesh.tets.size(); ++tet) {
    const Mat3 strain = strain_deviator(deformation_gradient(model, state.positions, tet));
    state.memory.strains[tet] = strain;
    for (std::size_t i = 0; i < terms.size(); ++i)
      state.memory.branches[tet * terms.size() + i] = std::exp(-since_s / terms[i].time_s) * strain;
  }
}

void end_viscous_step(const TissueModel& model, TissueState& state, double step_s, Workers& workers) {
  if (!is_viscous(model.material)) return;
  check(model, state, step_s);
  const ViscousTets tets(model, state, step_s);
  workers.for_each(model.mesh.tets.size(), kTetsPerChunk, [&](std::size_t tet) {
    if (state.is_live[tet] == 0) return;
    const Mat3 f = tets.deformation(tet);
    const Mat3 change = tets.change(tet, f);
    const std::size_t count = tets.branch_count();
    for (std::size_t i = 0; i < count; ++i) state.memory.branches[tet * count + i] = tets.branch(tet, i, change);
    state.memory.strains[tet] = strain_deviator(f);
  });
}

}  // namespace incise
