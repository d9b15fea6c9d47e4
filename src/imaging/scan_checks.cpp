#include <incise/core/error.hpp>
#include <incise/core/median.hpp>
#include <incise/imaging/scan_checks.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace incise {
namespace {

constexpr int kLowestAir = -1500;
constexpr int kHighestAir = -400;
constexpr int kBinHu = 10;
constexpr double kLeastAirShare = 0.002;
constexpr std::size_t kMostPixels = 10000;   // of a slice; at most twice as many are compared
constexpr std::size_t kLeastPixels = 50;     // too few to compare below this

/// The middle of the fullest bin of air, and the number of voxels in all bins.
struct AirCount {
  double peak_hu = 0.0;
  std::size_t voxels = 0;
};

AirCount count_air(const CtVolume& ct, bool with_padding) {
  std::array<std::size_t, (kHighestAir - kLowestAir) / kBinHu> bins{};
  AirCount air;
  for (const std::int16_t hu : ct.voxels) {
    if (hu < kLowestAir || hu >= kHighestAir || (!with_padding && hu == kAirHu)) continue;
    ++bins[static_cast<std::size_t>((hu - kLowestAir) / kBinHu)];
    ++air.voxels;
  }
  const auto fullest = static_cast<int>(std::max_element(bins.begin(), bins.end()) - bins.begin());
  air.peak_hu = kLowestAir + (fullest + 0.5) * kBinHu;
  return air;
}

/// Returns the median over pixels of one slice minus another; 0 if too few pixels can be compared.
double step_between(const CtVolume& ct, int slice, int other) {
  const std::size_t pixels = static_cast<std::size_t>(ct.grid.size[0]) * static_cast<std::size_t>(ct.grid.size[1]);
  const std::size_t stride = std::max<std::size_t>(1, pixels / kMostPixels);
  const std::int16_t* here = ct.voxels.data() + static_cast<std::size_t>(slice) * pixels;
  const std::int16_t* there = ct.voxels.data() + static_cast<std::size_t>(other) * pixels;
  std::vector<double> steps;
  for (std::size_t p = 0; p < pixels; p += stride) {
    if (here[p] != kAirHu && there[p] != kAirHu) steps.push_back(here[p] - there[p]);
  }
  return steps.size() < kLeastPixels ? 0.0 : median(steps);
}

/// Returns the smaller of a slice's two differences from its neighbours if both have the same sign, else 0: a slice
/// with its own intercept deviates from both in the same direction, one at the border of a board lies between them.
double step_of(const CtVolume& ct, int slice) {
  const double below = step_between(ct, slice, slice - 1);
  const double above = step_between(ct, slice, slice + 1);
  if (below * above <= 0.0) return 0.0;
  return std::abs(below) < std::abs(above) ? below : above;
}

}  // namespace

std::optional<double> air_peak_hu(const CtVolume& ct) {
  for (const bool with_padding : {false, true}) {
    const AirCount air = count_air(ct, with_padding);
    if (static_cast<double>(air.voxels) >= kLeastAirShare * static_cast<double>(ct.voxels.size()) && air.voxels > 0) return air.peak_hu;
  }
  return std::nullopt;
}

OddSlice oddest_slice(const CtVolume& ct) {
  INCISE_REQUIRE(ct.grid.size[2] >= 3, "expected three slices or more");
  OddSlice oddest;
  for (int slice = 1; slice + 1 < ct.grid.size[2]; ++slice) {
    const double step = step_of(ct, slice);
    if (std::abs(step) > std::abs(oddest.step_hu)) oddest = {slice, step};
  }
  return oddest;
}

Verdict check_scan(const CtVolume& ct) {
  Verdict verdict;
  const std::optional<double> air = air_peak_hu(ct);
  if (air && std::abs(*air - kAirHounsfield) > kAirPeakTolerance) {
    verdict.add("scan", *air,
                fmt::format("the air in the scan is at {:.0f} HU, not near {:.0f}: the scan's offset or scale differs "
                            "from that of Hounsfield units, and the tissue's window does not fit it",
                            *air, kAirHounsfield),
                {}, kAirHounsfield);
  }
  if (ct.grid.size[2] >= 3) {
    const OddSlice odd = oddest_slice(ct);
    if (std::abs(odd.step_hu) > kSliceStepTolerance) {
      const double height_mm = ct.grid.world_from_index(Vec3(0, 0, odd.slice)).z();
      verdict.add("scan", odd.step_hu,
                  fmt::format("slice {} of the scan (z {:.1f} mm) differs by {:+.0f} HU from its neighbours: it has "
                              "its own intercept, or belongs to another scan",
                              odd.slice, height_mm, odd.step_hu),
                  VerdictPlace{{},
                               ct.grid.world_from_index(Vec3(0.5 * ct.grid.size[0], 0.5 * ct.grid.size[1], odd.slice)),
                               fmt::format("slice {}", odd.slice)},
                  kSliceStepTolerance);
    }
  }
  return verdict;
}

}  // namespace incise
