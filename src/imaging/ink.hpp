#pragma once

#include "imaging/opencv.hpp"

#include <incise/imaging/marked_line.hpp>

namespace incise::imaging_detail {

/// How much of an ink's colour each pixel has, whatever the light: chroma over lightness along the ink's hue.
struct InkStrengths {
  cv::Mat red;    ///< height x width, float
  cv::Mat green;  ///< height x width, float
  cv::Mat glare;  ///< height x width, 8 bits, 255 where the picture is burnt out
};
[[nodiscard]] InkStrengths ink_strengths(const ColorPicture& picture);

/// An ink held against the tissue that it lies on.
struct InkMap {
  cv::Mat likelihood;     ///< height x width, float: 0 = the tissue around, 1 = the ink; smoothed over a pixel
  double contrast = 0.0;  ///< ink over tissue, in units of strength
  double noise = 0.0;     ///< of the tissue, same units
  bool is_present = false;
};
/// Against the tissue around: what is not reddish (paper, instruments, char) is no tissue, and not looked at.
/// @param mm_per_pixel  > 0: 8 mm of line, one pixel wide, are the least that counts.
[[nodiscard]] InkMap ink_map(const InkStrengths& strengths, InkColor color, double mm_per_pixel);

/// Likelihood between pixels, bilinear; 0 outside the picture.
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

}  // namespace incise::imaging_detail
