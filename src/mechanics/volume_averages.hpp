#pragma once

#include "mechanics/laws.hpp"

namespace incise {

/// Change of volume averaged to the vertices over live tets (Bonet and Burton 1998): θ_n = Σ V_t/4 θ_t / V_n with
/// V_n = Σ V_t/4, energy U = Σ k_n V_n θ_n² / 2, where 1/k_n is the V-weighted mean of 1/λ_t: tets round a vertex share
/// one pressure, as springs in series share one force.
class VolumeAverages {
 public:
  /// @param dilations  per tet: θ; those of carved tets are ignored.
  VolumeAverages(const TissueModel& model, const TissueState& state, std::span<const double> dilations,
                 Workers& workers);

  /// Returns the mean of k_n θ_n over the corners of a tet, kPa: the pressure that works on its own dilation.
  [[nodiscard]] double pressure_kpa(const Tet& tet) const;
  /// Returns U, µJ, summed in the order of the vertices.
  [[nodiscard]] double energy_uj() const;
  /// Adds Σ_n k_n/V_n g_n g_nᵀ, g_n = ∂(V_n θ_n)/∂x, to the matrix. `gradients` holds ∂θ/∂F of every live tet.
  void add_stiffness(const TissueState& state, std::span<const Mat3> gradients, BlockMatrix& stiffness,
                     Workers& workers) const;

 private:
  const TissueModel& model_;
  std::vector<double> volume_;    // V_n, mm³; 0 without live tets
  std::vector<double> modulus_;   // k_n, kPa
  std::vector<double> dilation_;  // θ_n
};

}  // namespace incise
