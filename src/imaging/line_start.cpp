#include "imaging/line_tracing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

namespace incise::imaging_detail {
namespace {

constexpr int kLeastSpeckPixels = 12;
constexpr double kRingLikeness = 0.3;  // least radius of another ring, relative to the largest

double signed_area(const Line& line) {  // positive: counter-clockwise on a screen, where v runs down
  double twice = 0.0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec2& a = line[i];
    const Vec2& b = line[(i + 1) % line.size()];
    twice += a.y() * b.x() - a.x() * b.y();
  }
  return 0.5 * twice;
}

cv::Mat distance_to_ink(const cv::Mat& mask) {
  cv::Mat inverse, distance;
  cv::bitwise_not(mask, inverse);
  cv::distanceTransform(inverse, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  return distance;
}

/// Returns the place on the ink that the rolling disc centred at p touches.
Vec2 foot_of(const cv::Mat& distance, const cv::Point& p) {
  const int u = std::clamp(p.x, 1, distance.cols - 2);
  const int v = std::clamp(p.y, 1, distance.rows - 2);
  const Vec2 gradient(distance.at<float>(v, u + 1) - distance.at<float>(v, u - 1),
                      distance.at<float>(v + 1, u) - distance.at<float>(v - 1, u));
  const double norm = gradient.norm();
  if (norm < 1e-6) return {p.x, p.y};
  return Vec2(p.x, p.y) - gradient / norm * distance.at<float>(v, u);
}

/// Returns the number of the connected piece, of pixels within a disc radius of ink, that borders on an enclosed place.
int neighbor_piece(const cv::Mat& pieces, const cv::Mat& places, int place) {
  for (int v = 1; v < places.rows; ++v) {
    for (int u = 1; u < places.cols; ++u) {
      if (places.at<int>(v, u) != place) continue;
      if (pieces.at<int>(v - 1, u) != 0) return pieces.at<int>(v - 1, u);
    }
  }
  return 0;
}

Line border_of(const cv::Mat& places, int place, const cv::Mat& distance) {
  std::vector<std::vector<cv::Point>> borders;
  cv::findContours(cv::Mat(places == place), borders, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  const auto longest = std::max_element(borders.begin(), borders.end(),
                                        [](const auto& a, const auto& b) { return a.size() < b.size(); });
  Line line;
  for (const cv::Point& p : *longest) line.push_back(foot_of(distance, p));
  smooth(line, true, 6);
  return line;
}

/// Shortest ways from one cell of a coarse grid to all others. A cell costs more the farther it is from ink; cells of
/// negative cost are closed.
struct Ways {
  std::vector<double> length;
  std::vector<int> from;
  int farthest = -1;
};

Ways ways_from(int start, const cv::Mat& cost) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const int n = cost.rows * cost.cols;
  Ways ways{std::vector<double>(static_cast<std::size_t>(n), kFar), std::vector<int>(static_cast<std::size_t>(n), -1),
            start};
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  ways.length[static_cast<std::size_t>(start)] = 0.0;
  open.emplace(0.0, start);
  while (!open.empty()) {
    const auto [length, cell] = open.top();
    open.pop();
    if (length > ways.length[static_cast<std::size_t>(cell)]) continue;
    ways.farthest = cell;  // cells leave the queue in order of length
    for (int dv = -1; dv <= 1; ++dv) {
      for (int du = -1; du <= 1; ++du) {
        const int v = cell / cost.cols + dv;
        const int u = cell % cost.cols + du;
        if ((du == 0 && dv == 0) || u < 0 || v < 0 || u >= cost.cols || v >= cost.rows || cost.at<float>(v, u) < 0.0F)
          continue;
        const int next = v * cost.cols + u;
        const double through = length + std::hypot(du, dv) * cost.at<float>(v, u);
        if (through >= ways.length[static_cast<std::size_t>(next)]) continue;
        ways.length[static_cast<std::size_t>(next)] = through;
        ways.from[static_cast<std::size_t>(next)] = cell;
        open.emplace(through, next);
      }
    }
  }
  return ways;
}

}  // namespace

cv::Mat ink_mask(const InkMap& map) {
  constexpr double kGreyIsNoInk = 0.06;  // colourless places on coloured tissue do not count
  return without_specks(map.likelihood > std::max(0.5, kGreyIsNoInk / map.contrast), kLeastSpeckPixels);
}

cv::Mat without_specks(const cv::Mat& above, int least_pixels) {
  cv::Mat labels, stats, centers;
  const int count = cv::connectedComponentsWithStats(above, labels, stats, centers, 8, CV_32S);
  std::vector<std::uint8_t> is_kept(static_cast<std::size_t>(count), 0);
  for (int i = 1; i < count; ++i)
    is_kept[static_cast<std::size_t>(i)] = stats.at<int>(i, cv::CC_STAT_AREA) >= least_pixels ? 255 : 0;
  return by_piece(labels, is_kept);
}

cv::Mat by_piece(const cv::Mat& pieces, const std::vector<std::uint8_t>& values) {
  cv::Mat mask(pieces.size(), CV_8U);
  for (int v = 0; v < mask.rows; ++v) {
    const auto* from = pieces.ptr<int>(v);
    auto* to = mask.ptr<std::uint8_t>(v);
    for (int u = 0; u < mask.cols; ++u) to[u] = values[static_cast<std::size_t>(from[u])];
  }
  return mask;
}

std::optional<MaskWindow> window_of(const cv::Mat& mask, int rim_px) {
  const cv::Rect box = cv::boundingRect(mask);
  if (box.empty()) return std::nullopt;
  MaskWindow window;
  cv::copyMakeBorder(mask(box), window.mask, rim_px, rim_px, rim_px, rim_px, cv::BORDER_CONSTANT, cv::Scalar(0));
  window.corner_px = Vec2(box.x - rim_px, box.y - rim_px);
  return window;
}

RollingResult roll_inside(const MaskWindow& window, double disc_radius_px) {
  RollingResult result;
  const cv::Mat distance = distance_to_ink(window.mask);
  const cv::Mat free = distance > disc_radius_px;
  cv::Mat places, stats, centers;
  const int count = cv::connectedComponentsWithStats(free, places, stats, centers, 4, CV_32S);
  const int outside = places.at<int>(0, 0);
  struct Place {
    int number;
    double radius_px;
  };
  std::vector<Place> found;
  for (int i = 1; i < count; ++i) {
    if (i == outside) continue;
    found.push_back({i, std::sqrt(stats.at<int>(i, cv::CC_STAT_AREA) / std::numbers::pi) + disc_radius_px});
  }
  if (found.empty()) return result;
  std::stable_sort(found.begin(), found.end(),
                   [](const Place& a, const Place& b) { return a.radius_px > b.radius_px; });
  result.radius_px = found.front().radius_px;
  const auto is_ring = [&](const Place& place) {
    return place.radius_px >= kRingLikeness * result.radius_px && place.radius_px > 1.5 * disc_radius_px;
  };
  result.rings = static_cast<std::size_t>(std::count_if(found.begin(), found.end(), is_ring));
  if (result.rings > 1) {
    result.second_radius_px = found[1].radius_px;
    cv::Mat pieces;
    cv::connectedComponents(cv::Mat(free == 0), pieces, 8, CV_32S);
    result.rings_touch =
        neighbor_piece(pieces, places, found[0].number) == neighbor_piece(pieces, places, found[1].number);
  }
  result.inner_border = border_of(places, found.front().number, distance);
  for (Vec2& p : result.inner_border) p += window.corner_px;
  if (signed_area(result.inner_border) < 0.0) std::reverse(result.inner_border.begin(), result.inner_border.end());
  return result;
}

Line longest_way(const MaskWindow& window, double bridge_px) {
  const int factor = std::max(1, static_cast<int>(bridge_px / 3.0));
  const cv::Size size(window.mask.cols / factor + 1, window.mask.rows / factor + 1);
  cv::Mat padded, small;
  cv::copyMakeBorder(window.mask, padded, 0, size.height * factor - window.mask.rows, 0,
                     size.width * factor - window.mask.cols, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::resize(padded, small, size, 0, 0, cv::INTER_AREA);
  small = small > 0;
  const cv::Mat distance = distance_to_ink(small);
  const double bridge = bridge_px / factor;
  cv::Mat near_ink = distance <= bridge, pieces;
  const int count = cv::connectedComponents(near_ink, pieces, 8, CV_32S);
  std::vector<int> ink(static_cast<std::size_t>(count), 0);
  std::vector<int> first(static_cast<std::size_t>(count), -1);
  for (int i = 0; i < small.rows * small.cols; ++i) {
    const int piece = pieces.at<int>(i / small.cols, i % small.cols);
    if (small.at<std::uint8_t>(i / small.cols, i % small.cols) == 0 || piece == 0) continue;
    ++ink[static_cast<std::size_t>(piece)];
    if (first[static_cast<std::size_t>(piece)] < 0) first[static_cast<std::size_t>(piece)] = i;
  }
  const auto largest = static_cast<std::size_t>(std::max_element(ink.begin(), ink.end()) - ink.begin());
  if (first[largest] < 0) return {};
  cv::Mat cost(small.size(), CV_32F, cv::Scalar(-1.0F));
  for (int v = 0; v < cost.rows; ++v) {
    for (int u = 0; u < cost.cols; ++u) {
      if (pieces.at<int>(v, u) == static_cast<int>(largest))
        cost.at<float>(v, u) = 1.0F + 4.0F * distance.at<float>(v, u) / static_cast<float>(bridge);
    }
  }
  const int end = ways_from(first[largest], cost).farthest;
  const Ways ways = ways_from(end, cost);
  Line line;
  for (int cell = ways.farthest; cell >= 0; cell = ways.from[static_cast<std::size_t>(cell)]) {
    line.push_back(window.corner_px + Vec2(cell % cost.cols + 0.5, cell / cost.cols + 0.5) * factor - Vec2(0.5, 0.5));
  }
  if (signed_area(line) < 0.0) std::reverse(line.begin(), line.end());
  smooth(line, false, 6);
  return line;
}

}  // namespace incise::imaging_detail
