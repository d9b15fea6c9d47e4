#include "geometry/kerf_picture.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/kerf_contours.hpp>
#include <incise/geometry/morphology.hpp>
#include <incise/geometry/surface_query.hpp>
#include <incise/geometry/thinning.hpp>
#include <incise/geometry/tracing.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

const Vec3 kAgainstPlane = -Vec3::UnitZ();  // approach for curves in view coordinates

/// Passes of re-centring and smoothing; the second already moves the line by less than 0.01 mm.
constexpr int kCentringPasses = 3;

/// Length of the piece that gives an open cut's direction at its ends, mm: long enough to average out the mesh's grain.
constexpr double kDirectionMm = 2.0;

/// Spacing of the mid-line during the computation, in pixels.
constexpr double kWorkingSpacing = 1.0;

bool is_kerf(const KerfPicture& picture, const Vec2& p) {
  const auto [i, j] = picture.mask.pixel_near(p);
  return picture.mask.at_or(i, j, 0) != 0;
}

/// Middle and width of the removed tissue across the kerf.
struct CrossSection {
  double middle_mm = 0.0;  // from the given point, along the normal
  double width_mm = 0.0;   // of a kerf through the whole layer with as much removed tissue
};

CrossSection section_across(const KerfPicture& picture, const Vec2& p, const Vec2& normal) {
  const double step = 0.5 * picture.mask.pixel_mm;
  double weights = 0.0;
  double moments = 0.0;
  const auto add = [&](double s) {
    const double share = sample(picture.coverage, p + s * normal);
    weights += share;
    moments += share * s;
  };
  if (is_kerf(picture, p)) add(0.0);
  for (const double side : {-1.0, 1.0}) {
    for (double s = step; s < kMaxHalfWidthMm && is_kerf(picture, p + side * s * normal); s += step) add(side * s);
  }
  if (weights == 0.0) return {};
  return {moments / weights, weights * step};
}

/// Moves the curve to the middle of the kerf and smooths it.
Contour centred(const KerfPicture& picture, Contour curve, const KerfMidlineSettings& settings) {
  for (int pass = 0; pass < kCentringPasses; ++pass) {
    curve = smoothed(evenly_spaced(curve, kWorkingSpacing * settings.pixel_mm), settings.smoothing_mm);
    Contour moved = curve;
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
      const Vec2 normal = normal_at(curve, i);
      moved.points[i].head<2>() += section_across(picture, curve.points[i].head<2>(), normal).middle_mm * normal;
    }
    curve = smoothed(evenly_spaced(moved, kWorkingSpacing * settings.pixel_mm), settings.smoothing_mm);
  }
  return curve;
}

double mean_width(const KerfPicture& picture, const Contour& curve) {
  double sum = 0.0;
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    sum += section_across(picture, curve.points[i].head<2>(), normal_at(curve, i)).width_mm;
  }
  return sum / static_cast<double>(curve.points.size());
}

/// Returns the line equally far from the tissue inside the ring and from all other tissue: the zero level of a
/// difference of distances. It separates the two, so it is closed whatever the shape of the kerf.
std::optional<Contour> equidistant_loop(const KerfPicture& picture, const Raster& inside, const Vec3& enclosed) {
  const Raster outside =
      set_where(picture.mask, [&](std::size_t p) { return picture.mask.pixels[p] == 0 && inside.pixels[p] == 0; });
  const ScalarRaster to_inside = distance_to(inside, 1);
  const ScalarRaster to_outside = distance_to(outside, 1);
  ScalarRaster difference(picture.mask, 0.0);
  for (std::size_t p = 0; p < difference.pixels.size(); ++p) {
    difference.pixels[p] = to_outside.pixels[p] - to_inside.pixels[p];
  }
  std::optional<Contour> loop;
  for (Contour& line : level_lines(difference, 0.0, -1.0)) {
    if (!contains_in_view(line, enclosed, kAgainstPlane)) continue;
    if (!loop || length_mm(line) > length_mm(*loop)) loop = std::move(line);
  }
  return loop;
}

/// Extends both ends of an open curve straight to the border of the kerf, by less than kMaxHalfWidthMm.
Contour extended_to_ends(const KerfPicture& picture, Contour curve, const KerfMidlineSettings& settings) {
  const double step = 0.25 * settings.pixel_mm;
  const auto back =
      std::min(curve.points.size() - 1, static_cast<std::size_t>(std::ceil(kDirectionMm / settings.pixel_mm)));
  const auto extension = [&](const Vec3& end, const Vec3& before) {
    const Vec3 along = (end - before).normalized();
    Vec3 at = end;
    for (double s = step; s < kMaxHalfWidthMm; s += step) {
      const Vec3 next = end + s * along;
      if (!is_kerf(picture, next.head<2>())) break;
      at = next;
    }
    return at;
  };
  const Vec3 first = extension(curve.points.front(), curve.points[back]);
  const Vec3 last = extension(curve.points.back(), curve.points[curve.points.size() - 1 - back]);
  if (first != curve.points.front()) curve.points.insert(curve.points.begin(), first);
  if (last != curve.points.back()) curve.points.push_back(last);
  return curve;
}

/// Takes half a kerf's width off both ends, where a skeleton forks towards the corners of the kerf's end.
Contour trimmed(const KerfPicture& picture, const Contour& path) {
  const ScalarRaster to_tissue = distance_to(picture.mask, 0);
  double half_width = 0.0;
  for (const Vec3& p : path.points)
    half_width += sample(to_tissue, p.head<2>()) / static_cast<double>(path.points.size());
  const auto cut = static_cast<std::size_t>(std::ceil(half_width / picture.mask.pixel_mm));
  if (path.points.size() < 3 * cut) return path;  // hardly longer than wide: a hole, not a cut
  const auto begin = path.points.begin() + static_cast<std::ptrdiff_t>(cut);
  const auto end = path.points.end() - static_cast<std::ptrdiff_t>(cut);
  return {.points = Points(begin, end), .is_closed = false};
}

std::optional<Contour> open_midline(const KerfPicture& picture, const KerfMidlineSettings& settings) {
  const Components parts = find_components(picture.mask, 1, Connectivity::Eight);
  const std::optional<std::int32_t> largest = largest_part(parts);
  if (!largest) return std::nullopt;
  const std::optional<Contour> path = longest_path(thinned(part_of(picture.mask, parts, *largest)));
  if (!path) return std::nullopt;
  return extended_to_ends(picture, centred(picture, trimmed(picture, *path), settings), settings);
}

/// Projects a curve from the picture plane onto the surface.
Contour on_surface(const Contour& curve, const KerfInput& input, const ViewFrame& view) {
  const SurfaceQuery surface(input.surface);
  Contour result{.points = {}, .is_closed = curve.is_closed};
  double height = 0.0;
  for (const Vec3& p : curve.points) {
    const std::optional<SurfacePoint> seen = surface.seen_at(view.from_view({p.x(), p.y(), height}), input.approach);
    // Beyond the silhouette, where closing a gap may lead the curve, the nearest point of the surface is used.
    const Vec3 position =
        seen ? seen->position_mm : surface.nearest(view.from_view({p.x(), p.y(), height})).position_mm;
    height = view.to_view(position).z();
    result.points.push_back(position);
  }
  return result;
}

}  // namespace

KerfMidline midline_contour(const KerfInput& input, const KerfMidlineSettings& settings) {
  INCISE_REQUIRE(input.inside_mm.allFinite(), "the enclosed point is not finite");
  KerfMidline result;
  const ViewFrame view = view_along(input.approach);
  const Vec2 inside = view.to_view(input.inside_mm).head<2>();
  std::optional<KerfPicture> picture = kerf_picture(input, view, settings);
  if (!picture) {
    result.gap_deg = input.is_closed ? 360.0 : 0.0;
    return result;
  }
  result.area_mm2 = area_mm2(picture->mask);
  std::optional<Contour> curve;
  if (input.is_closed) {
    const std::optional<Raster> enclosed = enclosed_tissue(picture->mask, inside);
    if (!enclosed) {
      result.gap_deg = widest_gap_deg(picture->mask, inside);
      const WidestGap gap = widest_gap(picture->mask, inside);
      result.gap_mm = gap.width_mm;
      if (gap.place) {
        const Contour place{{{gap.place->x(), gap.place->y(), 0.0}}, false};
        result.gap_place_mm = on_surface(place, input, view).points.front();
      }
      return result;
    }
    curve = equidistant_loop(*picture, *enclosed, {inside.x(), inside.y(), 0.0});
    INCISE_ASSERT(curve.has_value());
    if (curve) curve = centred(*picture, *curve, settings);
  } else {
    curve = open_midline(*picture, settings);
  }
  if (!curve) return result;
  result.mean_width_mm = mean_width(*picture, *curve);
  result.contour = evenly_spaced(on_surface(*curve, input, view), settings.spacing_mm);
  result.is_closed = input.is_closed;
  if (input.is_closed) {
    result.contour = start_farthest_along(counter_clockwise(*result.contour, input.approach), view.x);
  }
  return result;
}

}  // namespace incise
