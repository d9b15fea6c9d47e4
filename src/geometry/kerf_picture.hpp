#pragma once

#include "geometry/sight_lines.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/contour.hpp>
#include <incise/geometry/kerf_contours.hpp>
#include <incise/geometry/raster.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <ranges>
#include <span>

namespace incise {

/// Greatest distance from the middle of a kerf at which its border is searched, mm.
inline constexpr double kMaxHalfWidthMm = 4.0;

/// A kerf seen along the approach.
struct KerfPicture {
  ScalarRaster coverage;  ///< removed share of the layer, [0, 1], at each pixel
  Raster mask;            ///< where enough is removed; includes narrow bridges and small islands
};

/// Returns the removed tets in view coordinates, mm, each computed when it is visited: there may be a million. Keeps
/// references to both arguments. A visit throws InvalidArgument for a corner that is not finite.
[[nodiscard]] inline auto tets_in_view(const KerfInput& input, const ViewFrame& view) {
  return input.removed_tets | std::views::transform([&input, &view](const std::array<Vec3, 4>& tet) {
           std::array<Vec3, 4> seen;
           for (std::size_t c = 0; c < 4; ++c) {
             INCISE_REQUIRE(tet[c].allFinite(), fmt::format("removed tet {} has a corner that is not finite",
                                                            &tet - input.removed_tets.data()));
             seen[c] = view.to_view(tet[c]);
           }
           return seen;
         });
}

/// Returns the points in view coordinates, mm.
[[nodiscard]] Points points_in_view(std::span<const Vec3> points, const ViewFrame& view);

/// Calls visit(pixel, centre, tet) for each tet and each pixel that shows the surface and whose centre lies in the
/// tet's box. @param tets  as tets_in_view returns.  @param pixel  its offset.  @param tet  as SightLines.
template <class ViewTets, class Visit>
void for_each_pixel_over(const ViewTets& tets, const DepthBuffer& surface, const Visit& visit) {
  for (const std::array<Vec3, 4>& corners : tets) {
    const Box3 box = bounding_box(corners);
    const SightLines tet(corners);
    const Vec2 first = surface.index_of(box.min().head<2>());
    const Vec2 last = surface.index_of(box.max().head<2>());
    for (int j = std::max(0, static_cast<int>(std::ceil(first.y())));
         j <= std::min(surface.height - 1, static_cast<int>(std::floor(last.y()))); ++j) {
      for (int i = std::max(0, static_cast<int>(std::ceil(first.x())));
           i <= std::min(surface.width - 1, static_cast<int>(std::floor(last.x()))); ++i) {
        const std::size_t pixel = surface.offset(i, j);
        if (surface.triangles[pixel] >= 0) visit(pixel, surface.centre(i, j), tet);
      }
    }
  }
}

/// Projects the removed tets, clipped to the layer below the surface. nullopt if nowhere enough of the layer is
/// removed.
/// @throws InvalidArgument for settings out of range.
[[nodiscard]] std::optional<KerfPicture> kerf_picture(const KerfInput& input, const ViewFrame& view,
                                                      const KerfMidlineSettings& settings);

/// Returns the curve with evenly spaced points, `spacing_mm` apart or a little more or less; at least 8.
[[nodiscard]] Contour evenly_spaced(const Contour& curve, double spacing_mm);

/// Unit normal, in the picture plane, to the left of a curve at its point i.
/// @pre neighbours of point i do not coincide in the picture.
[[nodiscard]] Vec2 normal_at(const Contour& curve, std::size_t i);

/// Returns the uncut tissue around point `inside` if the kerf separates it from the picture's border, otherwise
/// nullopt.
[[nodiscard]] std::optional<Raster> enclosed_tissue(const Raster& mask, const Vec2& inside);

/// Largest angle at `inside`, degrees, within which no pixel of the mask lies.
[[nodiscard]] double widest_gap_deg(const Raster& mask, const Vec2& inside);

/// The way out of an open ring.
struct WidestGap {
  double width_mm = 0.0;  ///< of the widest disc that can be rolled to the picture's border without touching the kerf
  std::optional<Vec2> place;  ///< where it just fits; absent if that is `inside` itself
};
/// Returns the widest way from `inside` to the picture's border: of width 0 if there is none or the kerf covers
/// `inside`, of infinite width if `inside` is outside the picture.
[[nodiscard]] WidestGap widest_gap(const Raster& mask, const Vec2& inside);

}  // namespace incise
