#include "mechanics/corotational_response.hpp"
#include "mechanics/elastic_response.hpp"

#include "mechanics/rotation.hpp"

#include <Eigen/Eigenvalues>

namespace incise {
namespace {

constexpr std::size_t kTetsPerChunk = 512;
constexpr std::size_t kVerticesPerChunk = 128;
constexpr double kLeastTurningCurvature = 1e-6;  // relative to the stretches, or to 1: below it the rotation is not unique

/// Curvature of one tet's energy density in the turn of F against R, in the current frame. With A = Rᵀ dF and a the
/// axial vector of A - Aᵀ, d²Ψ = 2μ |sym A|² + λ tr² A + aᵀ (μ I + (λ tr(S - I) - 2μ) G⁻¹) a, where S = Rᵀ F and G = tr
/// S I - S. This is the last bracket; it vanishes at zero strain, and the frozen tangent is what is left without it.
Mat3 turning_curvature(const Mat3& f, const Mat3& r, const LameParameters& lame, bool is_projected) {
  const Mat3 s = r.transpose() * f;
  const Eigen::SelfAdjointEigenSolver<Mat3> stretches(0.5 * (s + s.transpose()));
  const double trace = stretches.eigenvalues().sum();
  const double factor = lame.lambda_kpa * (trace - 3.0) - 2.0 * lame.mu_kpa;
  const double least = kLeastTurningCurvature * std::max(1.0, stretches.eigenvalues().cwiseAbs().maxCoeff());
  Vec3 curvature;
  for (int i = 0; i < 3; ++i) {
    const double g = std::max(trace - stretches.eigenvalues()[i], least);
    curvature[i] = lame.mu_kpa + factor / g;
    if (is_projected) curvature[i] = std::max(curvature[i], 0.0);
  }
  const Mat3 axes = r * stretches.eigenvectors();
  return axes * curvature.asDiagonal() * axes.transpose();
}

/// First Piola stress R (2μ (S - I) + λ tr(S - I) I), with S = Rᵀ F, as 2μ (F - R) + λ tr(S - I) R.
Mat3 piola(const Mat3& f, const Mat3& r, const LameParameters& lame) {
  const double dilation = lame.lambda_kpa * (r.cwiseProduct(f).sum() - 3.0);
  return 2.0 * lame.mu_kpa * (f - r) + dilation * r;
}

struct RowBuilder {
  const TissueModel& model;
  const TissueState& state;
  const std::vector<Mat3>* turning;  // null: rotations frozen

  void add_force(std::size_t tet, std::size_t corner, Vec3& force) const {
    const Mat3 f = deformation_gradient(model, state.positions, tet);
    force -= model.volumes_mm3[tet] * (piola(f, state.rotations[tet], model.lame[tet]) * model.gradients[tet][corner]);
  }

  /// The four blocks of row `corner`: K_ab = V (λ a aᵀ_b + μ a_b aᵀ + μ (a · a_b) I), a = R g. Products are paired so
  /// that K_ba is the exact transpose of K_ab.
  void add_stiffness(std::size_t tet, std::size_t corner, BlockMatrix& matrix) const {
    const Mat3& r = state.rotations[tet];
    const double lambda = model.volumes_mm3[tet] * model.lame[tet].lambda_kpa;
    const double mu = model.volumes_mm3[tet] * model.lame[tet].mu_kpa;
    std::array<Vec3, 4> a;
    for (std::size_t c = 0; c < 4; ++c) a[c] = r * model.gradients[tet][c];
    const std::int32_t* slots = model.tet_slots[tet].data() + 4 * corner;
    for (std::size_t b = 0; b < 4; ++b) {
      double outer[9];
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) outer[3 * i + j] = a[corner][i] * a[b][j];
      }
      const double shear = mu * (outer[0] + outer[4] + outer[8]);
      double* block = matrix.block(slots[b]);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          block[3 * i + j] += lambda * outer[3 * i + j] + mu * outer[3 * j + i] + (i == j ? shear : 0.0);
        }
      }
    }
    if (turning != nullptr) add_turning(tet, corner, a, matrix);
  }

  /// V [a]ᵀ M [a_b], where [.] is the cross-product matrix.
  void add_turning(std::size_t tet, std::size_t corner, const std::array<Vec3, 4>& a, BlockMatrix& matrix) const {
    const auto cross = [](const Vec3& v) {
      Mat3 m;
      m << 0.0, -v[2], v[1], v[2], 0.0, -v[0], -v[1], v[0], 0.0;
      return m;
    };
    const Mat3 left = model.volumes_mm3[tet] * cross(a[corner]).transpose() * (*turning)[tet];
    for (std::size_t b = 0; b < 4; ++b) {
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(matrix.block(model.tet_slots[tet][4 * corner + b])) +=
          left * cross(a[b]);
    }
  }
};

void update_rotations(const TissueModel& model, TissueState& state, std::vector<Mat3>* turning, bool is_projected,
                      Workers& workers) {
  workers.for_each(model.mesh.tets.size(), kTetsPerChunk, [&](std::size_t tet) {
    if (state.is_live[tet] == 0) return;
    const Mat3 f = deformation_gradient(model, state.positions, tet);
    state.rotations[tet] = nearest_rotation(f, state.rotations[tet]);
    if (turning != nullptr) (*turning)[tet] = turning_curvature(f, state.rotations[tet], model.lame[tet], is_projected);
  });
}

}  // namespace

void add_corotational_response(const TissueModel& model, TissueState& state, std::span<Vec3> forces,
                               BlockMatrix* stiffness, Tangent tangent, std::vector<Mat3>& turning, Workers& workers) {
  const bool is_turning = stiffness != nullptr && tangent != Tangent::FrozenRotations;
  if (is_turning) turning.resize(model.mesh.tets.size());
  update_rotations(model, state, is_turning ? &turning : nullptr, tangent == Tangent::Projected, workers);

  // Each vertex gathers from its tets in ascending order: no two threads write the same place, and the order of sums is
  // fixed.
  const RowBuilder builder{model, state, is_turning ? &turning : nullptr};
  workers.for_each(model.mesh.vertices.size(), kVerticesPerChunk, [&](std::size_t v) {
    Vec3 force = Vec3::Zero();
    for (auto i = model.vertex_tet_start[v]; i < model.vertex_tet_start[v + 1]; ++i) {
      const auto entry = static_cast<std::size_t>(model.vertex_tets[static_cast<std::size_t>(i)]);
      const std::size_t tet = entry / 4;
      if (state.is_live[tet] == 0) continue;
      builder.add_force(tet, entry % 4, force);
      if (stiffness != nullptr) builder.add_stiffness(tet, entry % 4, *stiffness);
    }
    forces[v] += force;
  });
}

double corotational_energy_uj(const TissueModel& model, const TissueState& state) {
  double energy = 0.0;
  for (std::size_t tet = 0; tet < model.mesh.tets.size(); ++tet) {
    if (state.is_live[tet] == 0) continue;
    const Mat3 f = deformation_gradient(model, state.positions, tet);
    const Mat3 r = nearest_rotation(f, state.rotations[tet]);
    const double dilation = r.cwiseProduct(f).sum() - 3.0;
    const LameParameters& lame = model.lame[tet];
    energy +=
        model.volumes_mm3[tet] * (lame.mu_kpa * (f - r).squaredNorm() + 0.5 * lame.lambda_kpa * dilation * dilation);
  }
  return energy;
}

}  // namespace incise
