#pragma once

#include <incise/geometry/tet_mesh.hpp>
#include <incise/geometry/types.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace incise {

/// A regular grid of square pixels in the picture plane of a ViewFrame. Pixel (0, 0) has its *centre* at `origin_mm`; x
/// runs fastest.
struct RasterGrid {
  Vec2 origin_mm = Vec2::Zero();
  double pixel_mm = 1.0;  ///< > 0
  int width = 0;
  int height = 0;

  [[nodiscard]] std::size_t pixel_count() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  [[nodiscard]] bool contains(int i, int j) const { return i >= 0 && j >= 0 && i < width && j < height; }
  [[nodiscard]] std::size_t offset(int i, int j) const {
    return static_cast<std::size_t>(i) + static_cast<std::size_t>(width) * static_cast<std::size_t>(j);
  }
  [[nodiscard]] Vec2 centre(int i, int j) const { return origin_mm + pixel_mm * Vec2(i, j); }
  /// Continuous pixel coordinates of a point of the plane.
  [[nodiscard]] Vec2 index_of(const Vec2& p) const { return (p - origin_mm) / pixel_mm; }
  /// The pixel (i, j) whose centre is nearest to a point of the plane; far outside the grid, one just outside it.
  [[nodiscard]] std::array<int, 2> pixel_near(const Vec2& p) const {
    const auto rounded = [](double at, int count) {
      return static_cast<int>(std::lround(std::clamp(at, -1.0, static_cast<double>(count))));
    };
    const Vec2 at = index_of(p);
    return {rounded(at.x(), width), rounded(at.y(), height)};
  }
};

/// A grid with one value per pixel.
template <class Value>
struct RasterOf : RasterGrid {
  std::vector<Value> pixels;  ///< pixel_count() values, x fastest

  RasterOf() = default;
  RasterOf(const RasterGrid& grid, Value value) : RasterGrid(grid), pixels(grid.pixel_count(), value) {}

  [[nodiscard]] Value at(int i, int j) const { return pixels[offset(i, j)]; }
  [[nodiscard]] Value& at(int i, int j) { return pixels[offset(i, j)]; }
  /// The value of the pixel, or `outside` beyond the picture.
  [[nodiscard]] Value at_or(int i, int j, Value outside) const { return contains(i, j) ? at(i, j) : outside; }
};

using Raster = RasterOf<std::uint8_t>;  ///< 1 = in the set, 0 = not
using ScalarRaster = RasterOf<double>;

/// Returns the set of the pixels for whose offsets `is_in(offset)` is true.
template <class IsIn>
[[nodiscard]] Raster set_where(const RasterGrid& grid, const IsIn& is_in) {
  Raster set(grid, 0);
  for (std::size_t p = 0; p < set.pixels.size(); ++p) set.pixels[p] = is_in(p) ? 1 : 0;
  return set;
}

/// Returns a grid whose pixel centres cover the box [low, high] and at least `border_mm` around it.
/// @pre finite, low <= high, pixel > 0, border >= 0.  @throws InvalidArgument also for more than 10^8 pixels.
[[nodiscard]] RasterGrid grid_around(const Vec2& low, const Vec2& high, double pixel_mm, double border_mm);

/// Area of the set, mm².
[[nodiscard]] double area_mm2(const Raster& raster);

/// Returns the value at a point by bilinear interpolation; pixels beyond the picture count as 0.
[[nodiscard]] double sample(const ScalarRaster& raster, const Vec2& p);

/// The part of a triangle surface that an observer sees straight from above: per pixel, the highest surface.
struct DepthBuffer : RasterGrid {
  std::vector<double> heights_mm;       ///< view z of the visible surface; NaN where there is none
  std::vector<std::int32_t> triangles;  ///< index of the visible triangle; -1 where there is none
};

/// Returns the orthographic depth buffer. Of triangles at the same height, the one with the lowest index is seen.
/// @param in_view    vertices in view coordinates (x, y, height), mm; the observer is at +z.
/// @param triangles  of either orientation; those seen edge-on or outside the grid are not drawn.
/// @throws InvalidArgument for a vertex out of range or not finite.
[[nodiscard]] DepthBuffer depth_buffer(const RasterGrid& grid, std::span<const Vec3> in_view,
                                       std::span<const Triangle> triangles);

}  // namespace incise
