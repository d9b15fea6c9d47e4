#pragma once

#include <incise/calibration/calibration_run.hpp>
#include <incise/core/describe.hpp>
#include <incise/mechanics/material.hpp>

#include <array>
#include <span>
#include <string_view>
#include <vector>

namespace incise {

/// Covariates of a ring: quantities in which rings, tissues or cuts differ, all known before the cut.
struct RingCovariates {
  double radius_mm = 0.0;  ///< of the circle with the area inside the tumour edge, seen along the approach
  double outline = 1.0;    ///< length of the edge over the circumference of that circle, >= 1
  double along = 0.5;      ///< place of the edge's middle along the pull: 0 to 1 from end to end of the body
  double aside_mm = 0.0;   ///< distance of that middle from the body's middle, across the pull; positive to its left
  double youngs_modulus_kpa = 0.0;  ///< implied by the measured pull; without one, the case's
  double lateral_margin_mm = 0.0;   ///< prescribed, like the next two
  double depth_mm = 0.0;
  double speed_mm_s = 0.0;
  // Directions in the view, counter-clockwise from its x; not covariates.
  double start_deg = 0.0;  ///< from the edge's middle to where the cut starts
  double pull_deg = 90.0;  ///< of the pull
};
inline void describe(Visitor& v, RingCovariates& r) {
  v({"radius_mm", "Radius of the circle with the area inside the tumour edge.", "mm"}, r.radius_mm, kAnatomyMm);
  v("outline", r.outline, "Length of the tumour edge over the circumference of that circle.", {1.0, 100.0});
  v("along", r.along, "Where the middle of the tumour edge lies along the pull, from end to end of the body.",
    {0.0, 1.0});
  v({"aside_mm", "Distance of that middle from the body's middle, across the pull; positive to the left of the pull.",
     "mm"},
    r.aside_mm, {-kAnatomyMm.most, kAnatomyMm.most});
  v({"youngs_modulus_kpa", "Young's modulus, from the pull where it was measured.", "kPa"}, r.youngs_modulus_kpa,
    {kLeastYoungsModulusKpa, kMostYoungsModulusKpa});
  v({"lateral_margin_mm", "Prescribed lateral margin.", "mm"}, r.lateral_margin_mm, kAnatomyMm);
  v({"depth_mm", "Prescribed depth.", "mm"}, r.depth_mm, kAnatomyMm);
  v({"speed_mm_s", "Prescribed speed.", "mm/s"}, r.speed_mm_s, {1e-6, 1e4});
  v({"start_deg", "Direction from the edge's middle to where the cut starts, counter-clockwise in the view.", "deg"},
    r.start_deg, {-360.0, 360.0});
  v({"pull_deg", "Direction of the pull, counter-clockwise in the view.", "deg"}, r.pull_deg, {-360.0, 360.0});
}

/// The covariates in the order of their names: radius, modulus and speed as logarithms, `aside` without its sign.
inline constexpr std::array<std::string_view, 8> kRingCovariateNames{
    "radius", "outline", "along", "aside", "youngs_modulus", "lateral_margin", "depth", "speed"};
using CovariateValues = std::array<double, kRingCovariateNames.size()>;
[[nodiscard]] CovariateValues values_of(const RingCovariates& ring);

/// Finds the covariates of a ring that lie outside the 10th to 90th percentile of the others', except the outline.
/// Percentiles are interpolated between neighbours in order.
/// @returns indices into kRingCovariateNames. @throws InvalidArgument without others.
[[nodiscard]] std::vector<std::size_t> outside_covariates(const RingCovariates& ring,
                                                          std::span<const RingCovariates> others);
/// A ring with at least this many covariates outside is unlike the others (docs/models/second_bench.md, Frozen).
inline constexpr std::size_t kUnlikeFrom = 2;

}  // namespace incise
