#pragma once

#include <incise/core/verdict.hpp>
#include <incise/geometry/volume.hpp>

#include <optional>

namespace incise {

/// HU of air, by the definition of the Hounsfield scale.
inline constexpr double kAirHounsfield = -1000.0;
/// Largest accepted distance of the air peak from kAirHounsfield, HU. A scanner that clips at -1024 is 24 off; partial
/// volume and scatter add to this.
inline constexpr double kAirPeakTolerance = 60.0;
/// Largest accepted median difference of a slice from its neighbours, HU. In real scans it is below 10.
inline constexpr double kSliceStepTolerance = 30.0;

/// Returns the most frequent value of air in a scan, HU (middle of a bin of 10 HU), or nullopt if less than 0.2 % of
/// the voxels are air, [-1500, -400) HU. Voxels of exactly -1024 may be padding: they count only if there is too little
/// other air. O(voxels).
[[nodiscard]] std::optional<double> air_peak_hu(const CtVolume& ct);

/// The slice (along k, not the first or last) whose values differ most from both neighbours in the same direction.
struct OddSlice {
  int slice = 0;
  double step_hu = 0.0;  ///< median over the pixels, against the neighbour that differs less; signed; 0: none
};
/// Finds the oddest slice, from fewer than 20 000 pixels of each. @throws InvalidArgument for fewer than 3 slices.
[[nodiscard]] OddSlice oddest_slice(const CtVolume& ct);

/// Returns a verdict with a caution `scan` for each sign that a CT's values are not Hounsfield units throughout: air
/// that is not near -1000 (all values have an offset), or a slice that differs from its neighbours (it has its own
/// intercept).
[[nodiscard]] Verdict check_scan(const CtVolume& ct);

}  // namespace incise
