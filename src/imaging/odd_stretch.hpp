#pragma once

#include "imaging/line_tracing.hpp"

#include <incise/imaging/photo_contours.hpp>

namespace incise::imaging_detail {

/// Where a line looks unlike itself over more than its largest gap: in width, strength of colour, or lightness against
/// what lies beside it, each averaged over that gap and held against the line's own median and spread.
/// @param hidden  8 bits, where the line may look otherwise: highlights and the other line; may be empty.
[[nodiscard]] std::optional<OddStretch> odd_stretch_of(const ColorPicture& picture, const InkMap& map,
                                                       const MarkedLine& line, const cv::Mat& hidden,
                                                       const LineSettings& settings);

}  // namespace incise::imaging_detail
