#include "mechanics/volume_averages.hpp"

#include "mechanics/chunks.hpp"
#include "mechanics/elastic_response.hpp"

#include <algorithm>

namespace incise {
namespace {

/// Computes g_n at every vertex of the star of n, in the order of the star's columns.
void gather_gradient(const TissueModel& model, const TissueState& state, std::span<const Mat3> gradients, std::size_t n,
                     std::span<const std::int32_t> star, std::span<Vec3> result) {
  std::fill(result.begin(), result.end(), Vec3::Zero());
  for_live_corners(model, state, n, [&](std::size_t tet, std::size_t) {
    const double share = 0.25 * filled_volume_mm3(model, state, tet);
    for (std::size_t c = 0; c < 4; ++c) {
      const auto at = std::lower_bound(star.begin(), star.end(), model.mesh.tets[tet][c].value);
      result[static_cast<std::size_t>(at - star.begin())] += share * (gradients[tet] * model.gradients[tet][c]);
    }
  });
}

}  // namespace

VolumeAverages::VolumeAverages(const TissueModel& model, const TissueState& state, std::span<const double> dilations,
                               Workers& workers)
    : model_(model),
      volume_(model.mesh.vertices.size(), 0.0),
      modulus_(volume_.size(), 0.0),
      dilation_(volume_.size(), 0.0) {
  workers.for_each(volume_.size(), kVerticesPerChunk, [&](std::size_t n) {
    double volume = 0.0;
    double change = 0.0;
    double compliance = 0.0;  // infinite if a tet has λ = 0: it resists no pressure, so neither does the vertex
    for_live_corners(model, state, n, [&](std::size_t tet, std::size_t) {
      const double share = 0.25 * filled_volume_mm3(model, state, tet);
      volume += share;
      change += share * dilations[tet];
      compliance += share / model.lame[tet].lambda_kpa;
    });
    if (volume == 0.0) return;
    volume_[n] = volume;
    dilation_[n] = change / volume;
    modulus_[n] = volume / compliance;
  });
}

double VolumeAverages::pressure_kpa(const Tet& tet) const {
  double sum = 0.0;
  for (const VertexId v : tet) sum += modulus_[v.index()] * dilation_[v.index()];
  return 0.25 * sum;
}

double VolumeAverages::energy_uj() const {
  double energy = 0.0;
  for (std::size_t n = 0; n < volume_.size(); ++n)
    energy += 0.5 * modulus_[n] * volume_[n] * dilation_[n] * dilation_[n];
  return energy;
}

void VolumeAverages::add_stiffness(const TissueState& state, std::span<const Mat3> gradients, BlockMatrix& stiffness,
                                   Workers& workers) const {
  const BlockPattern& stars = *model_.stars;
  const BlockPattern& pattern = *model_.pattern;
  Points gradient(stars.blocks());
  workers.for_each(volume_.size(), kVerticesPerChunk, [&](std::size_t n) {
    const auto star = stars.columns_of(n);
    const auto row = std::span(gradient).subspan(static_cast<std::size_t>(stars.row_start[n]), star.size());
    gather_gradient(model_, state, gradients, n, star, row);
  });
  // Row v: every vertex n of its star couples v to the whole star of n. n ascends, so K_wv is the exact transpose of
  // K_vw.
  workers.for_each(volume_.size(), kVerticesPerChunk, [&](std::size_t v) {
    for (const std::int32_t neighbour : stars.columns_of(v)) {
      const auto n = static_cast<std::size_t>(neighbour);
      if (volume_[n] == 0.0) continue;
      const auto star = stars.columns_of(n);
      const Vec3* g = gradient.data() + stars.row_start[n];
      const auto self = std::lower_bound(star.begin(), star.end(), static_cast<std::int32_t>(v)) - star.begin();
      const double weight = modulus_[n] / volume_[n];
      std::int32_t slot = pattern.row_start[v];
      for (std::size_t w = 0; w < star.size(); ++w) {
        while (pattern.column[static_cast<std::size_t>(slot)] != star[w]) ++slot;
        double* block = stiffness.block(slot);
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < 3; ++j) block[3 * i + j] += weight * (g[self][i] * g[w][j]);
        }
      }
    }
  });
}

}  // namespace incise
