#pragma once

#include "imaging/opencv.hpp"

#include <incise/geometry/picture.hpp>
#include <incise/geometry/types.hpp>

#include <vector>

namespace incise::imaging_detail {

/// A straight, slim dark piece of the picture.
struct Stroke {
  Vec2 center;     ///< weighted by darkness
  Vec2 direction;  ///< along it
  double length;
  double width;
  double fill;  ///< share of its rectangle that it covers
};

/// Pixels that are dark against their surroundings and without colour, with their darkness, [0, 255].
struct DarkPixels {
  cv::Mat mask;
  cv::Mat darkness;
};
/// @param window  side of the surroundings, pixels
[[nodiscard]] DarkPixels dark_pixels(const ColorPicture& picture, int window);

/// Connected pieces of a mask that are `least_aspect` times as long as wide. @param darkness  weighs their pixels.
[[nodiscard]] std::vector<Stroke> strokes_in(const cv::Mat& mask, const cv::Mat& darkness, double least_aspect);

/// Grey value between pixels, in proportion; beyond the rim the rim's own pixels go on. @pre 8 bits, 2 x 2 pixels or
/// more
[[nodiscard]] double grey_at(const cv::Mat& grey, const Vec2& pixel);

}  // namespace incise::imaging_detail
