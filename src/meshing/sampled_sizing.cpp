#include "meshing/sampled_sizing.hpp"

#include <algorithm>
#include <cmath>

namespace incise::meshing_detail {
namespace {

constexpr double kStepMm = 1.0;
constexpr double kMostNodes = 2.0e6;
constexpr double kBinMm = 0.1;

}  // namespace

SampledSizing::SampledSizing(const SizingField& field, const BodyField& body, double iso) {
  if (field.has_band()) {
    const Vec3 extent = body.box().sizes();
    step_mm_ = std::max(kStepMm, std::cbrt(extent.prod() / kMostNodes));
    std::array<int, 3>& size = distance_mm_.grid.size;
    for (int axis = 0; axis < 3; ++axis) {
      size[static_cast<std::size_t>(axis)] = static_cast<int>(extent[axis] / step_mm_) + 2;
    }
    distance_mm_.voxels.reserve(distance_mm_.grid.voxel_count());
    for (int k = 0; k < size[2]; ++k) {
      for (int j = 0; j < size[1]; ++j) {
        for (int i = 0; i < size[0]; ++i) {
          const double exact_mm = field.distance_to_band_mm(body.world_from_local(step_mm_ * Vec3(i, j, k)));
          distance_mm_.voxels.push_back(static_cast<float>(exact_mm));  // rounding drops bits that depend on the frame
        }
      }
    }
  }
  measure_body(body, iso);
}

double SampledSizing::distance_mm(const Vec3& local) const {
  if (distance_mm_.voxels.empty()) return 0.0;
  std::array<int, 3> cell{};
  Vec3 f;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    // Circumcentres may lie outside the box: they get the value at its border.
    const int last = distance_mm_.grid.size[a] - 1;
    const double index = std::clamp(local[axis] / step_mm_, 0.0, static_cast<double>(last));
    cell[a] = std::min(static_cast<int>(index), last - 1);
    f[axis] = index - cell[a];
  }
  return trilinear(distance_mm_, cell, f);
}

void SampledSizing::measure_body(const BodyField& body, double iso) {
  const VolumeGrid& g = body.grid();
  for (int k = 0; k < g.size[2]; ++k) {
    for (int j = 0; j < g.size[1]; ++j) {
      for (int i = 0; i < g.size[0]; ++i) {
        if (static_cast<double>(body.voxel(i, j, k)) < iso) continue;
        const auto bin = static_cast<std::size_t>(distance_mm(body.local_from_index(Vec3(i, j, k))) / kBinMm);
        if (bin >= volume_mm3_.size()) volume_mm3_.resize(bin + 1, 0.0);
        volume_mm3_[bin] += g.voxel_volume_mm3();
      }
    }
  }
}

double SampledSizing::cubes(const SizingField& scaled) const {
  double sum = 0.0;
  for (std::size_t bin = 0; bin < volume_mm3_.size(); ++bin) {
    // The first bin holds the points in the band, whose distance is exactly 0.
    const double d = bin == 0 ? 0.0 : (static_cast<double>(bin) + 0.5) * kBinMm;
    const double h = scaled.edge_length_at_mm(d);
    sum += volume_mm3_[bin] / (h * h * h);
  }
  return sum;
}

}  // namespace incise::meshing_detail
