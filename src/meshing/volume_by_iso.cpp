#include "meshing/volume_by_iso.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace incise::meshing_detail {
namespace {

constexpr std::size_t kIsoBins = 2048;
constexpr int kSamplesPerAxis = 2;

/// Returns point n of a sequence that fills [0, 1)³ evenly (additive recurrence with the powers of the root of
/// g⁴ = g + 1).
Vec3 even_point(std::size_t n) {
  constexpr double kG = 1.2207440846057596;
  const double t = static_cast<double>(n) + 0.5;
  const Vec3 raw(t / kG, t / (kG * kG), t / (kG * kG * kG));
  return raw - raw.array().floor().matrix();
}

}  // namespace

VolumeByIso::VolumeByIso(const BodyField& body) : above_mm3_(kIsoBins + 2, 0.0) {
  const VolumeGrid& g = body.grid();
  const double sample_mm3 = g.voxel_volume_mm3() / (kSamplesPerAxis * kSamplesPerAxis * kSamplesPerAxis);
  std::vector<std::size_t> count(kIsoBins + 2, 0);
  std::size_t n = 0;
  const auto add = [&](double value, std::size_t samples) {
    count[static_cast<std::size_t>(std::clamp(value, 0.0, 1.0) * kIsoBins)] += samples;
  };
  for (int k = 0; k + 1 < g.size[2]; ++k) {
    for (int j = 0; j + 1 < g.size[1]; ++j) {
      for (int i = 0; i + 1 < g.size[0]; ++i) {
        std::array<double, 8> corners{};
        for (int c = 0; c < 8; ++c) {
          corners[static_cast<std::size_t>(c)] =
              static_cast<double>(body.voxel(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)));
        }
        const auto [low, high] = std::minmax_element(corners.begin(), corners.end());
        if (*low == *high) {
          add(*low, kSamplesPerAxis * kSamplesPerAxis * kSamplesPerAxis);
          continue;
        }
        for (int s = 0; s < 8; ++s) {
          const Vec3 corner(i + 0.5 * (s & 1), j + 0.5 * (s >> 1 & 1), k + 0.5 * (s >> 2));
          add(body.value_at(body.local_from_index(corner + 0.5 * even_point(n++))), 1);
        }
      }
    }
  }
  double above = 0.0;
  for (std::size_t bin = kIsoBins + 1; bin-- > 0;) {
    above += static_cast<double>(count[bin]) * sample_mm3;
    above_mm3_[bin] = above;
  }
}

double VolumeByIso::volume_mm3(double iso) const {
  const double position = std::clamp(iso, 0.0, 1.0) * kIsoBins;
  const auto bin = std::min(static_cast<std::size_t>(position), kIsoBins - 1);
  const double t = position - static_cast<double>(bin);
  return above_mm3_[bin] + t * (above_mm3_[bin + 1] - above_mm3_[bin]);
}

std::optional<double> VolumeByIso::iso_for(double wanted_mm3) const {
  constexpr double kLowest = 0.1;
  constexpr double kHighest = 0.9;
  constexpr int kBisections = 40;
  if (volume_mm3(kLowest) < wanted_mm3 || volume_mm3(kHighest) > wanted_mm3) return std::nullopt;
  double low = kLowest;
  double high = kHighest;
  for (int step = 0; step < kBisections; ++step) {
    const double middle = 0.5 * (low + high);
    (volume_mm3(middle) >= wanted_mm3 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace incise::meshing_detail
