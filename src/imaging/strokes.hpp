#pragma once

#include "imaging/opencv.hpp"

#include <incise/geometry/picture.hpp>
#include <incise/geometry/types.hpp>

#include <vector>

namespace incise::imaging_detail {

/// A straight, slim dark piece of the picture.
struct Stroke {
  Vec2 center;     ///< pixels; weighted by darkness
  Vec2 direction;  ///< unit vector along it
  double length;   ///< pixels
  double width;    ///< pixels
  double fill;     ///< area over length x width
};

/// Colourless pixels that are darker than their surroundings.
struct DarkPixels {
  cv::Mat mask;      ///< 8 bits, 255 = dark
  cv::Mat darkness;  ///< 8 bits, grey levels below the mean of the surroundings
};
/// Finds dark pixels. @param window  side of the surroundings, pixels
[[nodiscard]] DarkPixels dark_pixels(const ColorPicture& picture, int window);

/// Returns the connected pieces of a mask that are at least `least_aspect` times as long as wide.
/// @param darkness  weights of the pixels, 8 bits.
[[nodiscard]] std::vector<Stroke> strokes_in(const cv::Mat& mask, const cv::Mat& darkness, double least_aspect);

/// Returns the grey value between pixels, bilinear; the rim's values continue beyond it. @pre 8 bits, at least 2 x 2
/// pixels
[[nodiscard]] double grey_at(const cv::Mat& grey, const Vec2& pixel);

}  // namespace incise::imaging_detail
