#pragma once

#include <incise/geometry/picture.hpp>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace incise::imaging_detail {

/// Returns a picture's pixels in the order R, G, B, without a copy. @pre as encode_png.
[[nodiscard]] inline cv::Mat pixels_of(const ColorPicture& picture) {
  // OpenCV has no read-only matrix; nobody writes through this one.
  return {picture.height, picture.width, CV_8UC3, const_cast<std::uint8_t*>(picture.rgb.data())};
}

/// Keeps OpenCV to the thread that called it: the library's own `Workers` are the only threads.
inline void hold_opencv_threads() {
  cv::setNumThreads(1);
}

}  // namespace incise::imaging_detail
