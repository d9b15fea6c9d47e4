#include "imaging/occupancy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace incise {
namespace {

// All lengths in this file are in voxels: partial volume and point spread blur a border over a number of voxels, not of
// millimetres.
constexpr float kBand = 2.3F;           // border voxels lie at most this far from the other side
constexpr float kPureFrom = 2.8F;       // a voxel at least this far from the other side contains one material only
constexpr float kPureTo = 6.0F;         // farther away, it says nothing about the border
constexpr double kMeanRadius = 2.0;     // standard deviation of the local means
constexpr float kLeastWeight = 0.002F;  // of nearby pure voxels, for a mean to count
constexpr float kLeastContrast =
    40.0F;  // HU between inside and outside; below it, gray values say nothing about the border

VolumeGrid in_voxels(VolumeGrid grid) {
  grid.spacing_mm = Vec3::Ones();
  return grid;
}

// Returns the mean HU of the chosen voxels near every voxel; NaN where there are none.
std::vector<float> local_mean(const CtVolume& hu, const std::vector<std::uint8_t>& chosen, Workers& workers) {
  const VolumeGrid grid = in_voxels(hu.grid);
  GrayVolume weight{grid, std::vector<float>(chosen.size())};
  GrayVolume sum{grid, std::vector<float>(chosen.size())};
  for (std::size_t v = 0; v < chosen.size(); ++v) {
    weight.voxels[v] = chosen[v] != 0 ? 1.0F : 0.0F;
    sum.voxels[v] = chosen[v] != 0 ? static_cast<float>(hu.voxels[v]) : 0.0F;
  }
  weight = gaussian(std::move(weight), kMeanRadius, workers);
  sum = gaussian(std::move(sum), kMeanRadius, workers);
  for (std::size_t v = 0; v < chosen.size(); ++v)
    sum.voxels[v] =
        weight.voxels[v] > kLeastWeight ? sum.voxels[v] / weight.voxels[v] : std::numeric_limits<float>::quiet_NaN();
  return std::move(sum.voxels);
}

// Returns the HU farthest from tissue within two voxels, outside the body. It replaces the local mean in a thin gap,
// which has no pure voxel, or only ones of another material.
float most_foreign(const CtVolume& hu, const Mask& body, int i, int j, int k, bool low_side) {
  float found = std::numeric_limits<float>::quiet_NaN();
  for (int c = std::max(0, k - 2); c <= std::min(hu.grid.size[2] - 1, k + 2); ++c)
    for (int b = std::max(0, j - 2); b <= std::min(hu.grid.size[1] - 1, j + 2); ++b)
      for (int a = std::max(0, i - 2); a <= std::min(hu.grid.size[0] - 1, i + 2); ++a) {
        if (body.at(a, b, c) != 0) continue;
        const auto value = static_cast<float>(hu.at(a, b, c));
        if (std::isnan(found) || (low_side ? value < found : value > found)) found = value;
      }
  return found;
}

// Returns whether no mixture of tissue and these surroundings can have that gray value; true if there are none.
bool is_odd(float hu, float outside, bool low_side) {
  return std::isnan(outside) || (low_side ? hu < outside - kLeastContrast : hu > outside + kLeastContrast);
}

struct Surroundings {
  std::vector<float> inside;  // local mean HU of pure tissue
  std::vector<float> low;     // of pure surroundings below the window
  std::vector<float> high;    // and above it
};

Surroundings find_surroundings(const CtVolume& hu, const Mask& body, const GrayVolume& to_body,
                               const GrayVolume& to_outside, const SegmentationSettings& settings, Workers& workers) {
  const std::size_t count = hu.voxels.size();
  std::vector<std::uint8_t> inside(count), low(count), high(count);
  for (std::size_t v = 0; v < count; ++v) {
    const auto value = static_cast<double>(hu.voxels[v]);
    const bool in_window = value >= settings.window_low_hu && value <= settings.window_high_hu;
    const float depth = to_outside.voxels[v];
    const float distance = to_body.voxels[v];
    inside[v] = body.voxels[v] != 0 && in_window && depth >= kPureFrom && depth <= kPureTo;
    const bool around = body.voxels[v] == 0 && distance >= kPureFrom && distance <= kPureTo;
    low[v] = around && value < settings.window_low_hu;
    high[v] = around && value > settings.window_high_hu;
  }
  return {local_mean(hu, inside, workers), local_mean(hu, low, workers), local_mean(hu, high, workers)};
}

// Returns the share of tissue in a voxel of gray value `hu` between pure tissue and pure surroundings; `otherwise` if
// the two look alike.
float share(float hu, float inside, float outside, float otherwise) {
  if (!(std::abs(inside - outside) >= kLeastContrast)) return otherwise;
  return std::clamp((hu - outside) / (inside - outside), 0.0F, 1.0F);
}

constexpr int kSamples = 6;  // along each edge of a cell that the surface crosses

/// Returns the number of samples in a cell that reach the level.
int samples_within(const std::array<double, 8>& corner, double level) {
  int count = 0;
  for (int c = 0; c < kSamples; ++c)
    for (int b = 0; b < kSamples; ++b) {
      const double z = (c + 0.5) / kSamples;
      const double y = (b + 0.5) / kSamples;
      const auto at_x = [&](std::size_t x) {
        return (1 - z) * ((1 - y) * corner[x] + y * corner[x + 2]) + z * ((1 - y) * corner[x + 4] + y * corner[x + 6]);
      };
      const double first = at_x(0);
      const double last = at_x(1);
      for (int a = 0; a < kSamples; ++a) count += first + (last - first) * (a + 0.5) / kSamples >= level ? 1 : 0;
    }
  return count;
}

}  // namespace

GrayVolume occupancy_from_gray(const CtVolume& hu, const Mask& region, const Mask& body,
                               const SegmentationSettings& settings, Workers& workers) {
  const Mask body_in_voxels{in_voxels(body.grid), body.voxels};
  const GrayVolume to_body = distance_to(body_in_voxels, workers);
  const GrayVolume to_outside = distance_to(complement(body_in_voxels), workers);
  const Surroundings near = find_surroundings(hu, body, to_body, to_outside, settings, workers);

  GrayVolume occupancy{hu.grid, std::vector<float>(hu.voxels.size(), 0.0F)};
  for (int k = 0; k < hu.grid.size[2]; ++k)
    for (int j = 0; j < hu.grid.size[1]; ++j)
      for (int i = 0; i < hu.grid.size[0]; ++i) {
        const std::size_t v = hu.grid.offset(i, j, k);
        const bool is_body = body.voxels[v] != 0;
        const float label = is_body ? 1.0F : 0.0F;
        occupancy.voxels[v] = label;
        const auto value = static_cast<float>(hu.voxels[v]);
        const bool is_below = value < settings.window_low_hu;
        const bool is_above = value > settings.window_high_hu;
        // The region or the opening cuts sharply: tissue that it cut off the body keeps its label. So does a filled
        // cavity, whatever it contains.
        if (region.voxels[v] == 0 || is_body == (is_below || is_above)) continue;
        if ((is_body ? to_outside : to_body).voxels[v] > kBand) continue;
        if (std::isnan(near.inside[v])) continue;
        const bool low_side = is_body ? value < near.inside[v] : is_below;
        float outside = low_side ? near.low[v] : near.high[v];
        if (!is_body && is_odd(value, outside, low_side)) outside = most_foreign(hu, body, i, j, k, low_side);
        if (std::isnan(outside)) continue;
        occupancy.voxels[v] = share(value, near.inside[v], outside, label);
      }
  return occupancy;
}

double iso_volume_mm3(const GrayVolume& values, double level, Workers& workers) {
  const VolumeGrid& grid = values.grid;
  const auto layers = static_cast<std::size_t>(std::max(0, grid.size[2] - 1));
  std::vector<std::size_t> whole(layers, 0), samples(layers, 0);
  workers.for_each(layers, 1, [&](std::size_t layer) {
    const int k = static_cast<int>(layer);
    for (int j = 0; j + 1 < grid.size[1]; ++j) {
      std::array<const float*, 4> rows{};  // rows of corners at (j, k), (j + 1, k), (j, k + 1), (j + 1, k + 1)
      for (int r = 0; r < 4; ++r)
        rows[static_cast<std::size_t>(r)] = values.voxels.data() + grid.offset(0, j + (r & 1), k + (r >> 1));
      for (int i = 0; i + 1 < grid.size[0]; ++i) {
        int within = 0;
        for (const float* row : rows) within += (row[i] >= level ? 1 : 0) + (row[i + 1] >= level ? 1 : 0);
        if (within == 0) continue;
        if (within == 8) {
          ++whole[layer];
          continue;
        }
        std::array<double, 8> corner{};
        for (std::size_t c = 0; c < 8; ++c) corner[c] = rows[c / 2][static_cast<std::size_t>(i) + c % 2];
        samples[layer] += static_cast<std::size_t>(samples_within(corner, level));
      }
    }
  });
  const auto sum = [](const std::vector<std::size_t>& of) {
    return static_cast<double>(std::accumulate(of.begin(), of.end(), std::size_t{0}));
  };
  return grid.voxel_volume_mm3() * (sum(whole) + sum(samples) / (kSamples * kSamples * kSamples));
}

}  // namespace incise
