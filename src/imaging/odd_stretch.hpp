#pragma once

#include "imaging/line_tracing.hpp"

#include <incise/imaging/photo_contours.hpp>

namespace incise::imaging_detail {

/// Returns the stretch of a closed line that looks most different from the rest, if any: in width, strength of colour,
/// or lightness relative to the tissue inside. Each is averaged over the largest allowed gap and compared with the
/// line's own median and spread.
/// @param hidden  8 bits, not 0 where highlights or the other line cover this one; may be empty.
[[nodiscard]] std::optional<OddStretch> odd_stretch_of(const ColorPicture& picture, const InkMap& map,
                                                       const MarkedLine& line, const cv::Mat& hidden,
                                                       const LineSettings& settings);

}  // namespace incise::imaging_detail
