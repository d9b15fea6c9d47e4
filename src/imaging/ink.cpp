#include "imaging/ink.hpp"

#include <incise/core/median.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace incise::imaging_detail {
namespace {

/// Hue angles of red and green ink in OKLab's (a, b) plane, and how fast strength falls beside them: to 0 at 59
/// degrees.
constexpr double kRedHueDeg = 22.0;
constexpr double kGreenHueDeg = 145.0;
constexpr float kHueFall = 0.6F;
/// How far strength may go below 0: lens and JPEG may mix a thin green line with red tissue to grey, which is still
/// greener than the tissue.
constexpr float kBeyondGrey = 0.05F;
/// Added to the lightness by which chroma is divided: in deep shadow, colour is noise.
constexpr float kShadow = 0.05F;
constexpr int kGlareLevel = 238;  // of 255, in the darkest channel
constexpr int kGlareSkirtPx = 2;
constexpr double kSmoothingPx = 0.8;

class Tables {
 public:
  Tables() {
    for (int i = 0; i < 256; ++i) {
      const double c = i / 255.0;
      linear_[static_cast<std::size_t>(i)] =
          static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
    }
    for (int i = 0; i <= kSteps + 1; ++i)
      root_[static_cast<std::size_t>(i)] = static_cast<float>(std::cbrt(static_cast<double>(i) / kSteps));
  }
  /// Linear light of an sRGB value.
  [[nodiscard]] float linear(std::uint8_t value) const { return linear_[value]; }
  /// Cube root on [0, 1].
  [[nodiscard]] float root(float x) const {
    const float place = x * kSteps;
    const int i = static_cast<int>(place);
    const float share = place - static_cast<float>(i);
    return (1.0F - share) * root_[static_cast<std::size_t>(i)] + share * root_[static_cast<std::size_t>(i) + 1];
  }

 private:
  static constexpr int kSteps = 8192;
  std::array<float, 256> linear_{};
  std::array<float, kSteps + 2> root_{};
};

struct Direction {
  explicit Direction(double deg)
      : c(static_cast<float>(std::cos(deg * std::numbers::pi / 180.0))),
        s(static_cast<float>(std::sin(deg * std::numbers::pi / 180.0))) {}
  [[nodiscard]] float strength(float a, float b) const {
    return std::max(-kBeyondGrey, a * c + b * s - kHueFall * std::abs(b * c - a * s));
  }
  float c, s;
};

/// The pixels of the reduced picture that are tissue.
struct Tissue {
  cv::Mat mask;  ///< 8 bits, 255 = tissue
  int step = 1;  ///< pixels of the picture per pixel of the mask, in each direction
};

/// Finds tissue, which is reddish; paper, steel, gloves and char are not. If almost nothing is reddish, everything
/// counts as tissue.
Tissue tissue_in(const cv::Mat& red) {
  constexpr int kWidth = 200;
  constexpr double kLeastRedness = 0.025;
  constexpr double kLeastShare = 0.05;
  Tissue tissue{{}, std::max(1, std::min(red.cols, red.rows) / kWidth)};
  cv::Mat small;
  cv::resize(red, small, {std::max(1, red.cols / tissue.step), std::max(1, red.rows / tissue.step)}, 0, 0,
             cv::INTER_AREA);
  tissue.mask = small > kLeastRedness;
  if (cv::countNonZero(tissue.mask) < kLeastShare * static_cast<double>(tissue.mask.total())) tissue.mask.setTo(255);
  return tissue;
}

/// Gives pixels outside tissue the mean of the tissue in a window around them or, if there is none, of all tissue.
void fill_from_tissue(cv::Mat& values, const Tissue& tissue, int window) {
  cv::Mat weight, sum, share;
  tissue.mask.convertTo(weight, CV_32F, 1.0 / 255.0);
  cv::boxFilter(values.mul(weight), sum, -1, {window, window}, {-1, -1}, true, cv::BORDER_REPLICATE);
  cv::boxFilter(weight, share, -1, {window, window}, {-1, -1}, true, cv::BORDER_REPLICATE);
  const auto overall = static_cast<float>(cv::mean(values, tissue.mask)[0]);
  const float least = 0.5F / static_cast<float>(window * window);
  for (int v = 0; v < values.rows; ++v) {
    for (int u = 0; u < values.cols; ++u) {
      if (tissue.mask.at<std::uint8_t>(v, u) != 0) continue;
      const float found = share.at<float>(v, u);
      values.at<float>(v, u) = found > least ? sum.at<float>(v, u) / found : overall;
    }
  }
}

/// Window of the background's median, pixels: about a quarter of the reduced picture.
int window_of_median(const cv::Mat& small) {
  return std::clamp(std::min(small.cols, small.rows) / 4, 3, 61) | 1;
}

/// Returns the tissue without a broad band of the ink, if the band fills so much of the median's window that the median
/// would count it as tissue; otherwise nullopt.
std::optional<Tissue> tissue_beside_band(const cv::Mat& strength, const Tissue& tissue, double contrast) {
  constexpr double kInk = 0.6;         // of the contrast, above the tissue's median
  constexpr double kMostShare = 0.25;  // of the window; half of it would spoil the median
  cv::Mat small, share;
  cv::resize(strength, small, tissue.mask.size(), 0, 0, cv::INTER_AREA);
  std::vector<float> values;
  for (int v = 0; v < small.rows; ++v) {
    for (int u = 0; u < small.cols; ++u) {
      if (tissue.mask.at<std::uint8_t>(v, u) != 0) values.push_back(small.at<float>(v, u));
    }
  }
  if (values.empty()) return std::nullopt;
  cv::Mat ink = small > median(values) + kInk * contrast;
  const int window = window_of_median(small);
  ink.convertTo(share, CV_32F, 1.0 / 255.0);
  cv::boxFilter(share, share, -1, {window, window}, {-1, -1}, true, cv::BORDER_REPLICATE);
  double most = 0.0;
  cv::minMaxLoc(share, nullptr, &most);
  if (most <= kMostShare) return std::nullopt;
  Tissue result{tissue.mask.clone(), tissue.step};
  cv::dilate(ink, ink, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));  // its rim is mixed with tissue
  result.mask.setTo(cv::Scalar(0), ink);
  if (cv::countNonZero(result.mask) == 0) return std::nullopt;
  return result;
}

/// Returns the strength of the surrounding tissue: the median over about a quarter of the picture.
cv::Mat local_background(const cv::Mat& strength, const Tissue& tissue) {
  constexpr double kFullScale = 0.6;  // 255 steps from -kBeyondGrey; no tissue has greater strength
  cv::Mat small, bytes;
  cv::resize(strength, small, tissue.mask.size(), 0, 0, cv::INTER_AREA);
  const int window = window_of_median(small);
  fill_from_tissue(small, tissue, window);
  small.convertTo(bytes, CV_8U, 255.0 / kFullScale, kBeyondGrey * 255.0 / kFullScale);
  cv::medianBlur(bytes, bytes, window);
  bytes.convertTo(small, CV_32F, kFullScale / 255.0, -kBeyondGrey);
  cv::GaussianBlur(small, small, {0, 0}, 2.0);  // removes the steps of 1/255 of full scale
  cv::Mat result;
  cv::resize(small, result, strength.size(), 0, 0, cv::INTER_LINEAR);
  return result;
}

/// Returns a robust standard deviation of the tissue, from the median absolute value of every seventh pixel.
double spread_of(const cv::Mat& difference, const Tissue& tissue) {
  std::vector<float> values;
  values.reserve(difference.total() / 7 + 1);
  std::size_t count = 0;
  for (int v = 0; v < difference.rows; ++v) {
    const auto* row = difference.ptr<float>(v);
    const auto* is_tissue = tissue.mask.ptr<std::uint8_t>(std::min(v / tissue.step, tissue.mask.rows - 1));
    for (int u = 0; u < difference.cols; ++u) {
      if (is_tissue[std::min(u / tissue.step, tissue.mask.cols - 1)] != 0 && count++ % 7 == 0)
        values.push_back(std::abs(row[u]));
    }
  }
  return 1.4826 * median(values);
}

/// Returns the value that `count` pixels exceed.
double level_exceeded_by(const cv::Mat& values, std::size_t count) {
  constexpr int kBins = 4096;
  std::vector<std::size_t> bins(kBins, 0);
  for (int v = 0; v < values.rows; ++v) {
    const auto* row = values.ptr<float>(v);
    for (int u = 0; u < values.cols; ++u)
      ++bins[static_cast<std::size_t>(std::clamp(static_cast<int>(row[u] * kBins), 0, kBins - 1))];
  }
  std::size_t above = 0;
  for (int i = kBins - 1; i > 0; --i) {
    above += bins[static_cast<std::size_t>(i)];
    if (above >= count) return static_cast<double>(i) / kBins;
  }
  return 0.0;
}

/// Finds highlights, where the picture is burnt out. White paper is as bright but hides nothing: a nearly as bright
/// area that fills kLeastPaper of the picture is not a highlight.
/// @param darkest  value of each pixel's darkest channel, 8 bits
cv::Mat glare_in(const cv::Mat& darkest) {
  constexpr int kPaperLevel = 215;
  constexpr double kLeastPaper = 0.05;
  constexpr int kStep = 4;
  cv::Mat glare = darkest >= kGlareLevel;
  cv::Mat small, pieces, stats, centers, is_paper;
  cv::resize(darkest, small, {std::max(1, glare.cols / kStep), std::max(1, glare.rows / kStep)}, 0, 0, cv::INTER_AREA);
  const int count = cv::connectedComponentsWithStats(small >= kPaperLevel, pieces, stats, centers, 8, CV_32S);
  cv::Mat paper(small.size(), CV_8U, cv::Scalar(0));
  for (int i = 1; i < count; ++i) {
    if (stats.at<int>(i, cv::CC_STAT_AREA) >= kLeastPaper * static_cast<double>(small.total())) paper |= pieces == i;
  }
  if (cv::countNonZero(paper) > 0) {
    cv::dilate(paper, paper, cv::getStructuringElement(cv::MORPH_RECT, {5, 5}));  // beside a line it is darker
    cv::resize(paper, is_paper, glare.size(), 0, 0, cv::INTER_NEAREST);
    glare.setTo(cv::Scalar(0), is_paper);
  }
  // The skirt of a highlight is not burnt out, but has lost its colour too.
  const int width = 2 * kGlareSkirtPx + 1;
  cv::dilate(glare, glare, cv::getStructuringElement(cv::MORPH_RECT, {width, width}));
  return glare;
}

}  // namespace

InkStrengths ink_strengths(const ColorPicture& picture) {
  static const Tables tables;
  static const Direction red(kRedHueDeg);
  static const Direction green(kGreenHueDeg);
  InkStrengths result{
      cv::Mat(picture.height, picture.width, CV_32F), cv::Mat(picture.height, picture.width, CV_32F), {}};
  cv::Mat darkest(picture.height, picture.width, CV_8U);
  for (int y = 0; y < picture.height; ++y) {
    const std::uint8_t* rgb =
        picture.rgb.data() + 3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width);
    auto* red_row = result.red.ptr<float>(y);
    auto* green_row = result.green.ptr<float>(y);
    auto* darkest_row = darkest.ptr<std::uint8_t>(y);
    for (int x = 0; x < picture.width; ++x, rgb += 3) {
      // OKLab (Ottosson 2020). A change of light multiplies L, a and b alike, so a/L and b/L do not change.
      const float r = tables.linear(rgb[0]), g = tables.linear(rgb[1]), b = tables.linear(rgb[2]);
      const float l = tables.root(0.4122214708F * r + 0.5363325363F * g + 0.0514459929F * b);
      const float m = tables.root(0.2119034982F * r + 0.6806995451F * g + 0.1073969566F * b);
      const float s = tables.root(0.0883024619F * r + 0.2817188376F * g + 0.6299787005F * b);
      const float lightness = 0.2104542553F * l + 0.7936177850F * m - 0.0040720468F * s + kShadow;
      const float along_a = (1.9779984951F * l - 2.4285922050F * m + 0.4505937099F * s) / lightness;
      const float along_b = (0.0259040371F * l + 0.7827717662F * m - 0.8086757660F * s) / lightness;
      red_row[x] = red.strength(along_a, along_b);
      green_row[x] = green.strength(along_a, along_b);
      darkest_row[x] = std::min({rgb[0], rgb[1], rgb[2]});
    }
  }
  result.glare = glare_in(darkest);
  return result;
}

InkMap ink_map(const InkStrengths& strengths, InkColor color, double mm_per_pixel) {
  // Least contrast of a line. The redness of tissue itself varies by about half of this. Nothing on tissue is green,
  // but grey is 0.05 above it.
  constexpr double kLeastRed = 0.07;
  constexpr double kLeastGreen = 0.07;
  constexpr double kShortestLineMm = 8.0;
  constexpr double kNoises = 8.0;
  const cv::Mat& strength = color == InkColor::Red ? strengths.red : strengths.green;
  const Tissue tissue = tissue_in(strengths.red);
  const auto pixels = static_cast<std::size_t>(std::max(24.0, kShortestLineMm / mm_per_pixel));
  InkMap result;
  const auto hold_against = [&](const Tissue& around) {
    cv::GaussianBlur(strength, result.likelihood, {0, 0}, kSmoothingPx);
    result.likelihood -= local_background(strength, around);
    result.noise = spread_of(result.likelihood, around);
    result.contrast = level_exceeded_by(result.likelihood, pixels);
  };
  hold_against(tissue);
  if (const auto beside = tissue_beside_band(strength, tissue, result.contrast)) hold_against(*beside);
  result.is_present =
      result.contrast > (color == InkColor::Red ? kLeastRed : kLeastGreen) && result.contrast > kNoises * result.noise;
  if (result.is_present) result.likelihood *= 1.0 / result.contrast;
  return result;
}

}  // namespace incise::imaging_detail
