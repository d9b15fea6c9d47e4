#include "imaging/strokes.hpp"

#include <algorithm>
#include <cmath>

namespace incise::imaging_detail {

DarkPixels dark_pixels(const ColorPicture& picture, int window) {
  constexpr double kLeastStep = 40.0;  // grey levels
  constexpr int kColorless = 40;       // greatest difference of the channels
  const cv::Mat rgb = pixels_of(picture);
  cv::Mat grey, around;
  cv::cvtColor(rgb, grey, cv::COLOR_RGB2GRAY);
  cv::boxFilter(grey, around, -1, {window, window});
  DarkPixels dark;
  cv::subtract(around, grey, dark.darkness);
  dark.mask = cv::Mat(grey.size(), CV_8U);
  for (int v = 0; v < grey.rows; ++v) {
    for (int u = 0; u < grey.cols; ++u) {
      const auto& c = rgb.at<cv::Vec3b>(v, u);
      const auto [low, high] = std::minmax({c[0], c[1], c[2]});
      dark.mask.at<std::uint8_t>(v, u) =
          dark.darkness.at<std::uint8_t>(v, u) > kLeastStep && high - low <= kColorless ? 255 : 0;
    }
  }
  return dark;
}

std::vector<Stroke> strokes_in(const cv::Mat& mask, const cv::Mat& darkness, double least_aspect) {
  cv::Mat labels, stats, centers;
  const int count = cv::connectedComponentsWithStats(mask, labels, stats, centers, 8, CV_32S);
  std::vector<Stroke> strokes;
  for (int i = 1; i < count; ++i) {
    const cv::Rect box(stats.at<int>(i, cv::CC_STAT_LEFT), stats.at<int>(i, cv::CC_STAT_TOP),
                       stats.at<int>(i, cv::CC_STAT_WIDTH), stats.at<int>(i, cv::CC_STAT_HEIGHT));
    const int area = stats.at<int>(i, cv::CC_STAT_AREA);
    if (area < 12 || std::max(box.width, box.height) < 8) continue;
    double mass = 0.0;
    Vec2 first = Vec2::Zero();
    Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
    for (int v = box.y; v < box.y + box.height; ++v) {
      for (int u = box.x; u < box.x + box.width; ++u) {
        if (labels.at<int>(v, u) != i) continue;
        const double weight = darkness.at<std::uint8_t>(v, u) + 1.0;
        const Vec2 p(u, v);
        mass += weight;
        first += weight * p;
        second += weight * p * p.transpose();
      }
    }
    const Vec2 center = first / mass;
    const Eigen::Matrix2d spread = second / mass - center * center.transpose();
    const double middle = 0.5 * spread.trace();
    const double half = std::hypot(0.5 * (spread(0, 0) - spread(1, 1)), spread(0, 1));
    const double angle = 0.5 * std::atan2(2.0 * spread(0, 1), spread(0, 0) - spread(1, 1));
    // An even rectangle of length a has the variance a²/12 along itself.
    const double length = std::sqrt(12.0 * (middle + half));
    const double width = std::sqrt(12.0 * std::max(middle - half, 1.0 / 12.0));
    if (length < least_aspect * width) continue;
    strokes.push_back({center, {std::cos(angle), std::sin(angle)}, length, width, area / (length * width)});
  }
  return strokes;
}

double grey_at(const cv::Mat& grey, const Vec2& pixel) {
  const int u = std::clamp(static_cast<int>(pixel.x()), 0, grey.cols - 2);
  const int v = std::clamp(static_cast<int>(pixel.y()), 0, grey.rows - 2);
  const double a = std::clamp(pixel.x() - u, 0.0, 1.0), b = std::clamp(pixel.y() - v, 0.0, 1.0);
  return (1 - b) * ((1 - a) * grey.at<std::uint8_t>(v, u) + a * grey.at<std::uint8_t>(v, u + 1)) +
         b * ((1 - a) * grey.at<std::uint8_t>(v + 1, u) + a * grey.at<std::uint8_t>(v + 1, u + 1));
}

}  // namespace incise::imaging_detail
