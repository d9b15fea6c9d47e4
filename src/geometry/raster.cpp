#include "plane_cross.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/raster.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace incise {
namespace {

constexpr double kMaxPixels = 1e8;

/// Slack, in pixels, by which a pixel's centre may lie outside a triangle, so that no pixel between neighbouring
/// triangles is left out.
constexpr double kPixelSlack = 1e-9;

struct PixelRange {
  int first = 0;
  int last = -1;
};

/// Returns the pixels along one axis whose centres lie in [low, high], clipped to [0, count).
PixelRange pixels_between(double low, double high, int count) {
  const double first = std::max(0.0, std::ceil(low - kPixelSlack));
  const double last = std::min(static_cast<double>(count - 1), std::floor(high + kPixelSlack));
  if (!(first <= last)) return {};
  return {static_cast<int>(first), static_cast<int>(last)};
}

/// Calls visit(i, j, weights) for every pixel whose centre lies in the triangle, given in pixel coordinates.
template <class Visit>
void for_each_pixel_in(const RasterGrid& grid, const std::array<Vec2, 3>& t, const Visit& visit) {
  const double doubled_area = plane_cross(t[1] - t[0], t[2] - t[0]);
  if (doubled_area == 0.0 || !std::isfinite(doubled_area)) return;
  const PixelRange columns =
      pixels_between(std::min({t[0].x(), t[1].x(), t[2].x()}), std::max({t[0].x(), t[1].x(), t[2].x()}), grid.width);
  const PixelRange rows =
      pixels_between(std::min({t[0].y(), t[1].y(), t[2].y()}), std::max({t[0].y(), t[1].y(), t[2].y()}), grid.height);
  std::array<double, 3> slack{};
  for (std::size_t c = 0; c < 3; ++c) {
    slack[c] = kPixelSlack * (t[(c + 2) % 3] - t[(c + 1) % 3]).norm() / std::abs(doubled_area);
  }
  for (int j = rows.first; j <= rows.last; ++j) {
    for (int i = columns.first; i <= columns.last; ++i) {
      const Vec2 p(i, j);
      const double u = plane_cross(t[2] - t[1], p - t[1]) / doubled_area;
      const double v = plane_cross(t[0] - t[2], p - t[2]) / doubled_area;
      const double w = 1.0 - u - v;
      if (u >= -slack[0] && v >= -slack[1] && w >= -slack[2]) visit(i, j, Vec3(u, v, w));
    }
  }
}

}  // namespace

RasterGrid grid_around(const Vec2& low, const Vec2& high, double pixel_mm, double border_mm) {
  INCISE_REQUIRE(low.allFinite() && high.allFinite() && (low.array() <= high.array()).all(),
                 "expected a finite box with low <= high");
  INCISE_REQUIRE(std::isfinite(pixel_mm) && pixel_mm > 0.0,
                 fmt::format("expected a pixel above 0 mm, found {}", pixel_mm));
  INCISE_REQUIRE(std::isfinite(border_mm) && border_mm >= 0.0,
                 fmt::format("expected a border of 0 mm or more, found {}", border_mm));
  const Vec2 counts = ((high - low).array() / pixel_mm + 2.0 * border_mm / pixel_mm).ceil() + 1.0;
  INCISE_REQUIRE(counts.prod() <= kMaxPixels,
                 fmt::format("a picture of {} x {} pixels is too large, expected at most 1e8", counts.x(), counts.y()));
  return {low - Vec2::Constant(border_mm), pixel_mm, static_cast<int>(counts.x()), static_cast<int>(counts.y())};
}

double area_mm2(const Raster& raster) {
  const auto count =
      std::count_if(raster.pixels.begin(), raster.pixels.end(), [](std::uint8_t value) { return value != 0; });
  return static_cast<double>(count) * raster.pixel_mm * raster.pixel_mm;
}

double sample(const ScalarRaster& raster, const Vec2& p) {
  const Vec2 at = raster.index_of(p);
  // In this form, a coordinate that is NaN also lies outside.
  if (!(at.x() > -1.0 && at.y() > -1.0 && at.x() < raster.width && at.y() < raster.height)) return 0.0;
  const int i = static_cast<int>(std::floor(at.x()));
  const int j = static_cast<int>(std::floor(at.y()));
  const double u = at.x() - i;
  const double v = at.y() - j;
  return (1.0 - v) * ((1.0 - u) * raster.at_or(i, j, 0.0) + u * raster.at_or(i + 1, j, 0.0)) +
         v * ((1.0 - u) * raster.at_or(i, j + 1, 0.0) + u * raster.at_or(i + 1, j + 1, 0.0));
}

DepthBuffer depth_buffer(const RasterGrid& grid, std::span<const Vec3> in_view, std::span<const Triangle> triangles) {
  DepthBuffer buffer;
  static_cast<RasterGrid&>(buffer) = grid;
  buffer.heights_mm.assign(grid.pixel_count(), std::numeric_limits<double>::quiet_NaN());
  buffer.triangles.assign(grid.pixel_count(), -1);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    std::array<Vec2, 3> flat;
    Vec3 heights;
    for (std::size_t c = 0; c < 3; ++c) {
      const VertexId id = triangles[t][c];
      INCISE_REQUIRE(id.is_valid() && id.index() < in_view.size(),
                     fmt::format("triangle {} names vertex {}, expected one of {}", t, id.value, in_view.size()));
      const Vec3& p = in_view[id.index()];
      INCISE_REQUIRE(p.allFinite(), fmt::format("vertex {} is not finite", id.value));
      flat[c] = grid.index_of(p.head<2>());
      heights[static_cast<Eigen::Index>(c)] = p.z();
    }
    for_each_pixel_in(grid, flat, [&](int i, int j, const Vec3& weights) {
      const std::size_t pixel = grid.offset(i, j);
      const double height = weights.dot(heights);
      if (buffer.triangles[pixel] >= 0 && height <= buffer.heights_mm[pixel]) return;
      buffer.heights_mm[pixel] = height;
      buffer.triangles[pixel] = static_cast<std::int32_t>(t);
    });
  }
  return buffer;
}

}  // namespace incise
