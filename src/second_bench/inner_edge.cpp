#include <incise/core/units.hpp>
#include <incise/geometry/morphology.hpp>
#include <incise/geometry/raster.hpp>
#include <incise/second_bench/cut.hpp>

#include <cmath>

namespace incise::second_bench {
namespace {

constexpr double kPixelMm = 0.1;
constexpr double kAroundMm = 16.0;  // beyond the tumour's edge
constexpr double kSlitMm = 0.6;     // jump of the place at rest between neighbouring pixels that shows a closed-up kerf
constexpr double kBridgeMm = 1.0;   // narrower strips of skin do not count
constexpr int kRays = 360;
constexpr double kSmoothDeg = 4.0;  // to either side: a person draws straight on over it

/// Returns the pixels of skin that continues to its neighbours: no kerf, open or closed up, lies between.
Raster whole_skin(const SeenTissue& seen, const RasterGrid& grid) {
  const DepthBuffer view = depth_buffer(grid, seen.vertices, seen.triangles);
  Points rest(grid.pixel_count(), Vec3::Constant(1e9));
  Raster skin(grid, 0);
  for (int j = 0; j < grid.height; ++j)
    for (int i = 0; i < grid.width; ++i) {
      const std::int32_t n = view.triangles[grid.offset(i, j)];
      if (n < 0 || seen.is_skin[static_cast<std::size_t>(n)] == 0) continue;
      skin.at(i, j) = 1;
      const Triangle& corners = seen.triangles[static_cast<std::size_t>(n)];
      const Vec3 weights = weights_seen_at(seen.vertices, corners, grid.centre(i, j));
      Vec3& place = rest[grid.offset(i, j)];
      place.setZero();
      for (std::size_t c = 0; c < 3; ++c)
        place += weights[static_cast<Eigen::Index>(c)] * seen.rest[corners[c].index()];
    }
  Raster whole = skin;
  for (int j = 1; j < grid.height; ++j)
    for (int i = 1; i < grid.width; ++i) {
      if (skin.at(i, j) == 0) continue;
      for (const auto& [a, b] : {std::pair{i - 1, j}, std::pair{i, j - 1}})
        if (skin.at(a, b) != 0 && (rest[grid.offset(i, j)] - rest[grid.offset(a, b)]).norm() > kSlitMm)
          whole.at(i, j) = 0;
    }
  return whole;
}

}  // namespace

std::optional<Contour> inner_edge_of(const SeenTissue& seen) {
  const Vec3 middle = curve_centroid(seen.tumor_edge);
  const Box3 box = bounding_box(seen.tumor_edge.points);
  const RasterGrid grid = grid_around(box.min().head<2>(), box.max().head<2>(), kPixelMm, kAroundMm);
  const Raster skin = opened(whole_skin(seen, grid), 0.5 * kBridgeMm);
  const Components parts = find_components(skin, 1, Connectivity::Four);
  const auto [ci, cj] = grid.pixel_near(middle.head<2>());
  const std::int32_t plug = parts.labels[grid.offset(ci, cj)];
  if (plug < 0 || parts.parts[static_cast<std::size_t>(plug)].touches_border) return std::nullopt;
  std::vector<double> radius;
  for (int n = 0; n < kRays; ++n) {
    const double angle = 2.0 * units::kPi * n / kRays;
    double r = 0.0;
    for (;; r += 0.25 * kPixelMm) {
      const auto [i, j] = grid.pixel_near(middle.head<2>() + r * Vec2(std::cos(angle), std::sin(angle)));
      if (!grid.contains(i, j) || parts.labels[grid.offset(i, j)] != plug) break;
    }
    radius.push_back(r);
  }
  Contour edge;
  const int half = static_cast<int>(kSmoothDeg * kRays / 360.0);
  for (int n = 0; n < kRays; ++n) {
    double sum = 0.0, weights = 0.0;
    for (int k = -half; k <= half; ++k) {
      const double weight = 1.0 - std::abs(k) / (half + 1.0);
      sum += weight * radius[static_cast<std::size_t>((n + k + kRays) % kRays)];
      weights += weight;
    }
    const double angle = 2.0 * units::kPi * n / kRays;
    edge.points.emplace_back(middle.x() + sum / weights * std::cos(angle), middle.y() + sum / weights * std::sin(angle),
                             middle.z());
  }
  return edge;
}

}  // namespace incise::second_bench
