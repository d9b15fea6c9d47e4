#pragma once

#include "imaging/opencv.hpp"

#include <incise/imaging/marked_line.hpp>

namespace incise::imaging_detail {

/// The amount of each ink's colour in each pixel, independent of the light: chroma over lightness along the ink's hue.
struct InkStrengths {
  cv::Mat red;    ///< height x width, float
  cv::Mat green;  ///< height x width, float
  cv::Mat glare;  ///< height x width, 8 bits, 255 where the picture is burnt out
};
[[nodiscard]] InkStrengths ink_strengths(const ColorPicture& picture);

/// An ink relative to the tissue on which it lies.
struct InkMap {
  cv::Mat likelihood;     ///< height x width, float: 0 = surrounding tissue, 1 = ink; smoothed over about a pixel
  double contrast = 0.0;  ///< strength of the ink minus the tissue's
  double noise = 0.0;     ///< standard deviation of the tissue's strength
  bool is_present = false;
};
/// Measures an ink relative to the surrounding tissue. Pixels that are not reddish (paper, instruments, char) do not
/// count as tissue.
/// @param mm_per_pixel  > 0; sets the least area of ink: a line 8 mm long and one pixel wide.
[[nodiscard]] InkMap ink_map(const InkStrengths& strengths, InkColor color, double mm_per_pixel);

/// Returns the value between pixels, bilinear; 0 outside the picture.
[[nodiscard]] inline double sampled(const cv::Mat& map, double u, double v) {
  const int iu = static_cast<int>(std::floor(u));
  const int iv = static_cast<int>(std::floor(v));
  if (iu < 0 || iv < 0 || iu + 1 >= map.cols || iv + 1 >= map.rows) return 0.0;
  const double a = u - iu;
  const double b = v - iv;
  const auto* top = map.ptr<float>(iv) + iu;
  const auto* low = map.ptr<float>(iv + 1) + iu;
  return (1 - b) * ((1 - a) * top[0] + a * top[1]) + b * ((1 - a) * low[0] + a * low[1]);
}

/// Returns whether a mask, 8 bits, is set at the pixel nearest to p; false outside the mask.
[[nodiscard]] inline bool covers(const cv::Mat& mask, const Vec2& p) {
  const cv::Point at(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
  return cv::Rect(0, 0, mask.cols, mask.rows).contains(at) && mask.at<std::uint8_t>(at) != 0;
}

}  // namespace incise::imaging_detail
