#include "imaging/opencv.hpp"
#include "imaging/picture_file.hpp"

#include <incise/core/error.hpp>
#include <incise/imaging/picture.hpp>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

namespace incise {
namespace {

using imaging_detail::kMostPixels;
using imaging_detail::pixels_of;

cv::Mat decoded(std::string_view bytes, int flags, const std::filesystem::path& name) {
  imaging_detail::hold_opencv_threads();
  imaging_detail::require_whole_picture(bytes, name);
  const cv::Mat file(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
  cv::Mat picture;
  try {
    picture = cv::imdecode(file, flags);
  } catch (const cv::Exception& error) {
    throw DataError(name, "", fmt::format("a picture that cannot be decoded ({})", error.err),
                    "a sound PNG, JPEG or TIFF file");
  }
  if (picture.empty()) {
    throw DataError(name, "", "a picture that cannot be decoded", "a sound PNG, JPEG or TIFF file", "Is it damaged?");
  }
  if (static_cast<double>(picture.rows) * picture.cols > kMostPixels) {
    throw DataError(name, "", fmt::format("{} x {} pixels", picture.cols, picture.rows), "at most 200 million pixels");
  }
  return picture;
}

/// Transparent pixels show the white sheet under them.
cv::Mat on_white(const cv::Mat& bgra) {
  cv::Mat result(bgra.size(), CV_8UC3);
  for (int v = 0; v < bgra.rows; ++v) {
    const auto* from = bgra.ptr<cv::Vec4b>(v);
    auto* to = result.ptr<cv::Vec3b>(v);
    for (int u = 0; u < bgra.cols; ++u) {
      const int alpha = from[u][3];
      for (int c = 0; c < 3; ++c)
        to[u][c] = static_cast<std::uint8_t>((from[u][c] * alpha + 255 * (255 - alpha) + 127) / 255);
    }
  }
  return result;
}

/// Whether some pixel is more than noise away from grey.
bool has_color(const cv::Mat& bgr) {
  constexpr int kGreyTolerance = 8;
  for (int v = 0; v < bgr.rows; ++v) {
    const auto* row = bgr.ptr<cv::Vec3b>(v);
    for (int u = 0; u < bgr.cols; ++u) {
      const auto [low, high] = std::minmax({row[u][0], row[u][1], row[u][2]});
      if (high - low > kGreyTolerance) return true;
    }
  }
  return false;
}

std::string encoded(const char* ending, const cv::Mat& pixels, const std::vector<int>& options) {
  std::vector<std::uint8_t> bytes;
  INCISE_REQUIRE(cv::imencode(ending, pixels, bytes, options), "the picture cannot be encoded");
  return {bytes.begin(), bytes.end()};
}

void require_filled(int width, int height, std::size_t found, std::size_t channels) {
  INCISE_REQUIRE(width > 0 && height > 0, fmt::format("expected a picture with pixels, found {} x {}", width, height));
  const std::size_t expected = channels * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  INCISE_REQUIRE(found == expected, fmt::format("expected {} numbers, found {}", expected, found));
}

cv::Mat bgr_of(const ColorPicture& picture) {
  require_filled(picture.width, picture.height, picture.rgb.size(), 3);
  cv::Mat bgr;
  cv::cvtColor(pixels_of(picture), bgr, cv::COLOR_RGB2BGR);
  return bgr;
}

}  // namespace

ColorPicture decode_picture(std::string_view bytes, const std::filesystem::path& name) {
  // A JPEG has no alpha, but may say which way up the camera was; other formats the other way round.
  const bool is_jpeg = bytes.starts_with("\xFF\xD8\xFF");
  cv::Mat pixels = decoded(bytes, is_jpeg ? cv::IMREAD_COLOR : cv::IMREAD_UNCHANGED, name);
  if (pixels.channels() < 3) {
    throw DataError(name, "", "a greyscale picture", "a colour picture",
                    "Red and green lines cannot be distinguished in grey.");
  }
  if (pixels.depth() == CV_16U) pixels.convertTo(pixels, CV_8U, 1.0 / 257.0);
  if (pixels.depth() != CV_8U) throw DataError(name, "", "channels of another type", "8 or 16 bits a channel");
  if (pixels.channels() == 4) pixels = on_white(pixels);
  if (!has_color(pixels)) {
    throw DataError(name, "", "a picture without colour (red, green and blue are equal everywhere)",
                    "a colour picture");
  }
  ColorPicture picture{pixels.cols, pixels.rows, std::vector<std::uint8_t>(pixels.total() * 3)};
  cv::Mat rgb(pixels.rows, pixels.cols, CV_8UC3, picture.rgb.data());
  cv::cvtColor(pixels, rgb, cv::COLOR_BGR2RGB);
  return picture;
}

DepthPicture decode_depth(std::string_view bytes, const std::filesystem::path& name) {
  const cv::Mat pixels = decoded(bytes, cv::IMREAD_UNCHANGED, name);
  if (pixels.type() != CV_16UC1) {
    throw DataError(name, "", fmt::format("{} channel(s) of {} bits", pixels.channels(), 8 * pixels.elemSize1()),
                    "a depth picture: one channel of 16 bits");
  }
  DepthPicture picture{pixels.cols, pixels.rows, {}};
  for (int v = 0; v < pixels.rows; ++v) {
    const auto* row = pixels.ptr<std::uint16_t>(v);
    picture.counts.insert(picture.counts.end(), row, row + pixels.cols);
  }
  if (cv::countNonZero(pixels) == 0) throw DataError(name, "", "no depth at any pixel", "a depth picture");
  return picture;
}

std::string encode_png(const ColorPicture& picture) {
  return encoded(".png", bgr_of(picture), {});
}

std::string encode_png(const DepthPicture& picture) {
  require_filled(picture.width, picture.height, picture.counts.size(), 1);
  return encoded(".png",
                 cv::Mat(picture.height, picture.width, CV_16U, const_cast<std::uint16_t*>(picture.counts.data())), {});
}

std::string encode_jpeg(const ColorPicture& picture, int quality) {
  INCISE_REQUIRE(quality >= 1 && quality <= 100, fmt::format("expected a quality in [1, 100], found {}", quality));
  return encoded(".jpg", bgr_of(picture), {cv::IMWRITE_JPEG_QUALITY, quality});
}

}  // namespace incise
