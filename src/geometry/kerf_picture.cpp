#include "geometry/kerf_picture.hpp"

#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/geometry/disjoint_sets.hpp>
#include <incise/geometry/morphology.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace incise {
namespace {

/// Free border around the kerf, mm: the picture's frame must not narrow the way out of an open ring.
constexpr double kKerfBorderMm = 3.0;

/// Number of directions that the search for a gap distinguishes.
constexpr int kDirections = 3600;

template <class ViewTets>
ScalarRaster coverage_of(const ViewTets& tets, const DepthBuffer& surface, const KerfMidlineSettings& settings) {
  ScalarRaster coverage(surface, 0.0);
  const double thickness = settings.layer_bottom_mm - settings.layer_top_mm;
  for_each_pixel_over(tets, surface, [&](std::size_t pixel, const Vec2& centre, const SightLines& tet) {
    const double top = surface.heights_mm[pixel];
    coverage.pixels[pixel] +=
        tet.length(centre, top - settings.layer_bottom_mm, top - settings.layer_top_mm) / thickness;
  });
  return coverage;
}

Raster mask_of(const ScalarRaster& coverage, const KerfMidlineSettings& settings) {
  const Raster mask = set_where(coverage, [&](std::size_t p) { return coverage.pixels[p] >= settings.min_coverage; });
  return holes_filled(closed(mask, settings.closing_mm), settings.max_island_mm2);
}

void require_valid(const KerfMidlineSettings& s) {
  INCISE_REQUIRE(
      std::isfinite(s.layer_top_mm) && std::isfinite(s.layer_bottom_mm) && s.layer_top_mm < s.layer_bottom_mm,
      fmt::format("expected a layer with top < bottom, found {} to {} mm", s.layer_top_mm, s.layer_bottom_mm));
  INCISE_REQUIRE(s.min_coverage > 0.0 && s.min_coverage <= 1.0,
                 fmt::format("expected a least coverage in (0, 1], found {}", s.min_coverage));
  INCISE_REQUIRE(s.max_island_mm2 >= 0.0, fmt::format("expected islands of 0 mm² or more, found {}", s.max_island_mm2));
  INCISE_REQUIRE(std::isfinite(s.spacing_mm) && s.spacing_mm > 0.0,
                 fmt::format("expected a spacing above 0 mm, found {}", s.spacing_mm));
}

}  // namespace

Points points_in_view(std::span<const Vec3> points, const ViewFrame& view) {
  Points seen;
  seen.reserve(points.size());
  for (const Vec3& p : points) seen.push_back(view.to_view(p));
  return seen;
}

std::optional<KerfPicture> kerf_picture(const KerfInput& input, const ViewFrame& view,
                                        const KerfMidlineSettings& settings) {
  require_valid(settings);
  if (input.removed_tets.empty()) return std::nullopt;
  const auto tets = tets_in_view(input, view);
  Box3 box;
  for (const std::array<Vec3, 4>& corners : tets) {
    for (const Vec3& corner : corners) box.extend(corner);
  }
  const double border = kKerfBorderMm + settings.closing_mm;
  const RasterGrid grid = grid_around(box.min().head<2>(), box.max().head<2>(), settings.pixel_mm, border);
  KerfPicture picture;
  picture.coverage = coverage_of(
      tets, depth_buffer(grid, points_in_view(input.surface.vertices, view), input.surface.triangles), settings);
  picture.mask = mask_of(picture.coverage, settings);
  if (area_mm2(picture.mask) == 0.0) return std::nullopt;
  return picture;
}

Contour evenly_spaced(const Contour& curve, double spacing_mm) {
  return resample(curve, static_cast<std::size_t>(std::max(8.0, std::round(length_mm(curve) / spacing_mm))));
}

Vec2 normal_at(const Contour& curve, std::size_t i) {
  const std::size_t n = curve.points.size();
  const std::size_t before = curve.is_closed ? (i + n - 1) % n : (i == 0 ? 0 : i - 1);
  const std::size_t after = curve.is_closed ? (i + 1) % n : std::min(i + 1, n - 1);
  const Vec2 along = (curve.points[after] - curve.points[before]).head<2>();
  return Vec2(-along.y(), along.x()).normalized();
}

std::optional<Raster> enclosed_tissue(const Raster& mask, const Vec2& inside) {
  const auto [i, j] = mask.pixel_near(inside);
  if (!mask.contains(i, j) || mask.at(i, j) != 0) return std::nullopt;
  const Components tissue = find_components(mask, 0, Connectivity::Four);
  const std::int32_t part = tissue.labels[mask.offset(i, j)];
  if (tissue.parts[static_cast<std::size_t>(part)].touches_border) return std::nullopt;
  return part_of(mask, tissue, part);
}

double widest_gap_deg(const Raster& mask, const Vec2& inside) {
  std::vector<std::uint8_t> is_cut(kDirections, 0);
  for (int j = 0; j < mask.height; ++j) {
    for (int i = 0; i < mask.width; ++i) {
      if (mask.at(i, j) == 0) continue;
      const Vec2 offset = mask.centre(i, j) - inside;
      if (offset.norm() <= mask.pixel_mm) return 0.0;  // the kerf covers the point, so it lies in every direction
      const double half = std::asin(0.5 * mask.pixel_mm / offset.norm());
      const double angle = std::atan2(offset.y(), offset.x()) + 2.0 * units::kPi;
      const double per_radian = kDirections / (2.0 * units::kPi);
      for (int k = static_cast<int>((angle - half) * per_radian); k <= static_cast<int>((angle + half) * per_radian);
           ++k) {
        is_cut[static_cast<std::size_t>(k % kDirections)] = 1;
      }
    }
  }
  int longest = 0;
  int run = 0;
  for (int k = 0; k < 2 * kDirections; ++k) {  // twice round: a gap may contain the first direction
    run = is_cut[static_cast<std::size_t>(k % kDirections)] != 0 ? 0 : run + 1;
    longest = std::max(longest, run);
  }
  return 360.0 * std::min(longest, kDirections) / kDirections;
}

WidestGap widest_gap(const Raster& mask, const Vec2& inside) {
  const auto pixel = mask.pixel_near(inside);
  if (!mask.contains(pixel[0], pixel[1])) return {std::numeric_limits<double>::infinity(), {}};
  if (mask.at(pixel[0], pixel[1]) != 0) return {0.0, {}};
  const ScalarRaster distance = distance_to(mask, 1);
  const std::size_t start = mask.offset(pixel[0], pixel[1]), beyond = mask.pixels.size();
  std::vector<std::size_t> order(mask.pixels.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t p) { return distance.pixels[p]; });
  // Open the pixels from the widest places on, until there is a way out: it opens at its narrowest place.
  DisjointSets sets(mask.pixels.size() + 1);  // the last one is the outside of the picture
  std::vector<std::uint8_t> is_open(mask.pixels.size(), 0);
  for (const std::size_t p : order) {
    if (distance.pixels[p] <= 0.0) break;
    is_open[p] = 1;
    const int i = static_cast<int>(p % static_cast<std::size_t>(mask.width));
    const int j = static_cast<int>(p / static_cast<std::size_t>(mask.width));
    for (const auto& [di, dj] : {std::array{-1, 0}, std::array{1, 0}, std::array{0, -1}, std::array{0, 1}}) {
      if (!mask.contains(i + di, j + dj)) {
        sets.join(p, beyond);
      } else if (is_open[mask.offset(i + di, j + dj)] != 0) {
        sets.join(p, mask.offset(i + di, j + dj));
      }
    }
    if (is_open[start] == 0 || sets.root(start) != sets.root(beyond)) continue;
    // Distances are measured to the centres of the kerf's outermost pixels. If the start itself is the narrowest place,
    // it lies beside the kerf, and the bridge is wider.
    const double width = std::max(0.0, 2.0 * distance.pixels[p] - mask.pixel_mm);
    return {width, p == start ? std::nullopt : std::optional(mask.centre(i, j))};
  }
  return {0.0, {}};
}

}  // namespace incise
