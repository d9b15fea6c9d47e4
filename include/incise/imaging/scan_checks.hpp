#pragma once

#include <incise/core/verdict.hpp>
#include <incise/geometry/volume.hpp>

#include <optional>

namespace incise {

/// Hounsfield units say what they mean: air is -1000.
inline constexpr double kAirHounsfield = -1000.0;
/// Farthest that the peak of air may lie from there, HU. Scanners that stop at -1024 lie 24 off; partial volume and scatter add some.
inline constexpr double kAirPeakTolerance = 60.0;
/// Farthest that a slice may lie from its neighbours in the median over its pixels, HU. In real scans it is below 10.
inline constexpr double kSliceStepTolerance = 30.0;

/// Where the air in a scan has its peak, HU; nothing in a scan that shows hardly any (fewer than 0.2 % of the voxels). Voxels that were set
/// to -1024 as padding count only where there is no other air. O(voxels).
[[nodiscard]] std::optional<double> air_peak_hu(const CtVolume& ct);

/// The slice (along k, the first and the last excepted) that lies farthest to one side of both its neighbours, in the median over pixels.
struct OddSlice {
  int slice = 0;
  double step_hu = 0.0;
};
/// @pre at least 3 slices. O(voxels), at most some 10 000 pixels a slice.
[[nodiscard]] OddSlice oddest_slice(const CtVolume& ct);

/// Cautions `scan` of a CT whose numbers argue against being Hounsfield units throughout: air that is not at -1000 (an offset of all
/// values), and a slice that steps out of line (an intercept of its own).
[[nodiscard]] Verdict check_scan(const CtVolume& ct);

}  // namespace incise
