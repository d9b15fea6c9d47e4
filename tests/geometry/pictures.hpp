#pragma once

#include <incise/core/error.hpp>
#include <incise/geometry/raster.hpp>

#include <string>
#include <vector>

namespace incise::testing {

/// A picture drawn in text, '#' = 1, its first line being row 0 (the lowest y).
inline Raster drawn(const std::vector<std::string>& rows, double pixel_mm = 1.0) {
  Raster raster(RasterGrid{Vec2::Zero(), pixel_mm, static_cast<int>(rows[0].size()), static_cast<int>(rows.size())}, 0);
  for (int j = 0; j < raster.height; ++j) {
    for (int i = 0; i < raster.width; ++i) {
      raster.at(i, j) = rows[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] == '#' ? 1 : 0;
    }
  }
  return raster;
}

inline std::vector<std::string> as_text(const Raster& raster) {
  std::vector<std::string> rows;
  for (int j = 0; j < raster.height; ++j) {
    std::string row;
    for (int i = 0; i < raster.width; ++i) row += raster.at(i, j) != 0 ? '#' : '.';
    rows.push_back(row);
  }
  return rows;
}

/// Sets every pixel whose centre lies within `radius_mm` of `centre`.
inline void stamp_disc(Raster& raster, const Vec2& centre, double radius_mm) {
  for (int j = 0; j < raster.height; ++j) {
    for (int i = 0; i < raster.width; ++i) {
      if ((raster.centre(i, j) - centre).norm() <= radius_mm) raster.at(i, j) = 1;
    }
  }
}

/// A ring round (0, 0), with border.
inline Raster ring(double inner_mm, double outer_mm, double pixel_mm) {
  const Vec2 reach = Vec2::Constant(outer_mm);
  Raster raster(grid_around(-reach, reach, pixel_mm, 1.0), 0);
  for (int j = 0; j < raster.height; ++j) {
    for (int i = 0; i < raster.width; ++i) {
      const double radius = raster.centre(i, j).norm();
      raster.at(i, j) = radius >= inner_mm && radius <= outer_mm ? 1 : 0;
    }
  }
  return raster;
}

}  // namespace incise::testing
