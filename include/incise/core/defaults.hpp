#pragma once

namespace incise {

/// Defaults that several settings share.

/// Clinical cut-off of the tissue left beside the tumour, mm. Source: the paper, III-A.1, [30].
inline constexpr double kCloseMarginMm = 2.2;
/// Intended distance from the tumour edge to the kerf's mid-line, mm. Source: the paper, II-A.
inline constexpr double kLateralMarginMm = 5.0;
/// Intended depth of the tool's tip below the surface, along its axis, mm. Source: the paper, II-A.
inline constexpr double kPlannedDepthMm = 5.0;
/// Radius of the paper's needle electrode, mm: half of an ideal kerf's width. Source: the paper, II-B.2.
inline constexpr double kElectrodeRadiusMm = 0.5;
/// Overlap: distance that a ring is cut beyond its start, mm. With less, the ring may stay open.
inline constexpr double kRingOverlapMm = 8.0;

}  // namespace incise
