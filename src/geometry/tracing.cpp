#include <incise/core/error.hpp>
#include <incise/geometry/gaussian.hpp>
#include <incise/geometry/morphology.hpp>
#include <incise/geometry/tracing.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

namespace incise {
namespace {

using Pixel = std::array<int, 2>;

Vec3 centre_of(const RasterGrid& grid, const Pixel& pixel) {
  const Vec2 centre = grid.centre(pixel[0], pixel[1]);
  return {centre.x(), centre.y(), 0.0};
}

Pixel pixel_at(const RasterGrid& grid, std::size_t offset) {
  const auto width = static_cast<std::size_t>(grid.width);
  return {static_cast<int>(offset % width), static_cast<int>(offset / width)};
}

/// Path lengths from one pixel along a skeleton, and the pixel before each.
struct Reach {
  std::vector<double> lengths;
  std::vector<std::size_t> previous;
  std::size_t farthest = 0;
};

Reach reach_from(const Raster& skeleton, std::size_t start) {
  Reach reach;
  reach.lengths.assign(skeleton.pixels.size(), std::numeric_limits<double>::infinity());
  reach.previous.assign(skeleton.pixels.size(), start);
  reach.farthest = start;
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  reach.lengths[start] = 0.0;
  queue.emplace(0.0, start);
  while (!queue.empty()) {
    const auto [length, offset] = queue.top();
    queue.pop();
    if (length > reach.lengths[offset]) continue;
    if (length > reach.lengths[reach.farthest]) reach.farthest = offset;
    const auto [i, j] = pixel_at(skeleton, offset);
    for (int dj = -1; dj <= 1; ++dj) {
      for (int di = -1; di <= 1; ++di) {
        if ((di == 0 && dj == 0) || skeleton.at_or(i + di, j + dj, 0) == 0) continue;
        const std::size_t next = skeleton.offset(i + di, j + dj);
        const double candidate = length + (di != 0 && dj != 0 ? std::numbers::sqrt2 : 1.0);
        if (candidate >= reach.lengths[next]) continue;
        reach.lengths[next] = candidate;
        reach.previous[next] = offset;
        queue.emplace(candidate, next);
      }
    }
  }
  return reach;
}

/// Returns the points of a curve filtered by a Gaussian along it. @param sigma  in points.
Points filtered(const Points& points, bool is_closed, double sigma) {
  const int n = static_cast<int>(points.size());
  const std::vector<double> kernel = gaussian_weights(sigma);
  const int reach = gaussian_reach(sigma);
  const auto point = [&](int i) -> Vec3 {
    if (is_closed) return points[static_cast<std::size_t>(((i % n) + n) % n)];
    // Beyond an end, the curve continues as its point reflection through that end, so the end stays in place.
    if (i < 0) return 2.0 * points.front() - points[static_cast<std::size_t>(std::min(-i, n - 1))];
    if (i >= n) return 2.0 * points.back() - points[static_cast<std::size_t>(std::max(2 * (n - 1) - i, 0))];
    return points[static_cast<std::size_t>(i)];
  };
  Points result;
  result.reserve(points.size());
  for (int i = 0; i < n; ++i) {
    Vec3 sum = Vec3::Zero();
    double weights = 0.0;
    for (int k = -reach; k <= reach; ++k) {
      const double weight = kernel[static_cast<std::size_t>(std::abs(k))];
      sum += weight * point(i + k);
      weights += weight;
    }
    result.push_back(sum / weights);
  }
  return result;
}

}  // namespace

std::optional<Contour> longest_path(const Raster& skeleton) {
  const Components parts = find_components(skeleton, 1, Connectivity::Eight);
  const std::optional<std::int32_t> largest = largest_part(parts);
  if (!largest || parts.parts[static_cast<std::size_t>(*largest)].pixels < 2) return std::nullopt;
  const Raster part = part_of(skeleton, parts, *largest);
  const auto start =
      static_cast<std::size_t>(std::find(part.pixels.begin(), part.pixels.end(), 1) - part.pixels.begin());
  // In a tree, the pixel farthest from any given pixel is an end of a longest path.
  const std::size_t one_end = reach_from(part, start).farthest;
  const Reach reach = reach_from(part, one_end);
  Contour path{.points = {}, .is_closed = false};
  for (std::size_t at = reach.farthest; at != one_end; at = reach.previous[at]) {
    path.points.push_back(centre_of(part, pixel_at(part, at)));
  }
  path.points.push_back(centre_of(part, pixel_at(part, one_end)));
  if (one_end < reach.farthest) std::reverse(path.points.begin(), path.points.end());
  return path;
}

Contour smoothed(const Contour& curve, double sigma_mm) {
  INCISE_REQUIRE(std::isfinite(sigma_mm) && sigma_mm >= 0.0,
                 fmt::format("expected a sigma of 0 mm or more, found {}", sigma_mm));
  if (sigma_mm == 0.0 || curve.points.size() < 3) return curve;
  const double spacing =
      length_mm(curve) / static_cast<double>(curve.is_closed ? curve.points.size() : curve.points.size() - 1);
  INCISE_REQUIRE(spacing > 0.0, "all points of the curve coincide, expected a positive length");
  // Four times the number of points already evens out everything, to rounding. The limit bounds the cost for a curve
  // much shorter than sigma_mm.
  const double sigma = std::min(sigma_mm / spacing, 4.0 * static_cast<double>(curve.points.size()));
  const Points once = filtered(curve.points, curve.is_closed, sigma);
  const Points twice = filtered(once, curve.is_closed, sigma);
  Contour result = curve;
  for (std::size_t i = 0; i < once.size(); ++i) result.points[i] = 2.0 * once[i] - twice[i];
  return result;
}

}  // namespace incise
