#include "geometry/kerf_picture.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/kerf_depth.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

void require_valid(const KerfDepthSettings& s, const Contour& course) {
  INCISE_REQUIRE(s.needle_diameter_mm > 0.0 && std::isfinite(s.needle_diameter_mm),
                 fmt::format("expected a needle diameter above 0 mm, found {}", s.needle_diameter_mm));
  INCISE_REQUIRE(s.reach_mm > 0.5 * s.needle_diameter_mm && std::isfinite(s.reach_mm),
                 fmt::format("expected a reach above half the needle's diameter, found {} mm", s.reach_mm));
  INCISE_REQUIRE(s.spacing_mm > 0.0 && std::isfinite(s.spacing_mm),
                 fmt::format("expected a spacing above 0 mm, found {}", s.spacing_mm));
  INCISE_REQUIRE(s.pixel_mm > 0.0 && s.pixel_mm <= s.needle_diameter_mm,
                 fmt::format("expected pixels in (0, {}] mm, found {}", s.needle_diameter_mm, s.pixel_mm));
  INCISE_REQUIRE(course.points.size() >= 2,
                 fmt::format("expected a course of at least 2 points, found {}", course.points.size()));
  for (std::size_t i = 0; i < course.points.size(); ++i) {
    INCISE_REQUIRE(course.points[i].allFinite(), fmt::format("point {} of the course is not finite", i));
  }
  INCISE_REQUIRE(length_mm(course) > 0.0, "expected a course with a length");
}

/// Returns the depth of the lowest removed point below the skin in each line of sight, mm; 0 where nothing is removed.
ScalarRaster depth_picture(const KerfInput& kerf, const ViewFrame& view, const RasterGrid& grid) {
  const DepthBuffer skin = depth_buffer(grid, points_in_view(kerf.surface.vertices, view), kerf.surface.triangles);
  ScalarRaster depth(grid, 0.0);
  for_each_pixel_over(tets_in_view(kerf, view), skin,
                      [&](std::size_t pixel, const Vec2& centre, const SightLines& tet) {
                        const double top = skin.heights_mm[pixel];
                        const SightLines::Span gone = tet.within(centre, -std::numeric_limits<double>::infinity(), top);
                        if (gone.low <= gone.high) depth.pixels[pixel] = std::max(depth.pixels[pixel], top - gone.low);
                      });
  return depth;
}

/// Returns the greatest mean depth, mm, over one needle diameter on the line across the course.
double deepest_across(const ScalarRaster& depth, const Vec2& p, const Vec2& across, const KerfDepthSettings& settings) {
  const double step = 0.5 * depth.pixel_mm;
  const auto half = static_cast<int>(std::floor(settings.reach_mm / step));
  const int window =
      std::min(2 * half + 1, std::max(1, static_cast<int>(std::lround(settings.needle_diameter_mm / step))));
  std::vector<double> sum_before{0.0};
  for (int k = -half; k <= half; ++k) {
    const auto [i, j] = depth.pixel_near(p + k * step * across);
    sum_before.push_back(sum_before.back() + depth.at_or(i, j, 0.0));
  }
  double deepest = 0.0;
  for (std::size_t end = static_cast<std::size_t>(window); end < sum_before.size(); ++end) {
    deepest = std::max(deepest, (sum_before[end] - sum_before[end - static_cast<std::size_t>(window)]) / window);
  }
  return deepest;
}

}  // namespace

DepthProfile depth_along(const KerfInput& kerf, const Contour& course, const KerfDepthSettings& settings) {
  require_valid(settings, course);
  DepthProfile profile;
  profile.course = evenly_spaced(course, settings.spacing_mm);
  const std::size_t count = profile.course.points.size();
  const double spacing = length_mm(course) / static_cast<double>(course.is_closed ? count : count - 1);
  const ViewFrame view = view_along(kerf.approach);
  const Contour in_view{points_in_view(profile.course.points, view), course.is_closed};
  const Box3 box = bounding_box(in_view.points);
  const RasterGrid grid = grid_around(box.min().head<2>(), box.max().head<2>(), settings.pixel_mm, settings.reach_mm);
  const ScalarRaster depth = depth_picture(kerf, view, grid);
  for (std::size_t i = 0; i < count; ++i) {
    profile.arclength_mm.push_back(spacing * static_cast<double>(i));
    profile.depth_mm.push_back(deepest_across(depth, in_view.points[i].head<2>(), normal_at(in_view, i), settings));
  }
  return profile;
}

}  // namespace incise
