#pragma once

#include <incise/geometry/raster.hpp>

#include <optional>

namespace incise {

/// Which pixels are connected: those that share a side (Four), or also those that share a corner (Eight). Use one for a
/// set and the other for its complement.
enum class Connectivity { Four, Eight };

/// Returns the distance, mm, from each pixel's centre to the nearest centre of a pixel of the given value (0 or 1);
/// infinite if there is none. Exact Euclidean distance transform, O(pixels). Source: Felzenszwalb and Huttenlocher,
/// Theory of Computing 8 (2012).
[[nodiscard]] ScalarRaster distance_to(const Raster& raster, std::uint8_t value);

/// Returns every pixel within `radius_mm` of the set.
[[nodiscard]] Raster dilated(const Raster& raster, double radius_mm);
/// Returns every pixel farther than `radius_mm` from the complement; the picture's border does not erode the set.
[[nodiscard]] Raster eroded(const Raster& raster, double radius_mm);
/// Closing by a disc: fills gaps narrower than twice the radius; never removes a pixel. Needs a border of one radius.
[[nodiscard]] Raster closed(const Raster& raster, double radius_mm);
/// Opening by a disc: removes parts narrower than twice the radius; never adds a pixel.
[[nodiscard]] Raster opened(const Raster& raster, double radius_mm);

/// The connected parts of the pixels of one value, found by find_components.
struct Components {
  struct Part {
    std::size_t pixels = 0;
    bool touches_border = false;  ///< has a pixel in the first or last row or column
  };
  std::vector<std::int32_t>
      labels;  ///< per pixel, the number of its part, in order of each part's first pixel; -1 for other pixels
  std::vector<Part> parts;
};
[[nodiscard]] Components find_components(const Raster& raster, std::uint8_t value, Connectivity connectivity);

/// Returns the pixels of one part.
[[nodiscard]] Raster part_of(const Raster& raster, const Components& components, std::int32_t part);

/// Returns the part with the most pixels (the first of equals); nullopt if there is none.
[[nodiscard]] std::optional<std::int32_t> largest_part(const Components& components);

/// Returns the set with its holes of at most `max_area_mm2` filled. A hole is a part of the complement, by
/// four-connectivity, that does not touch the border.
[[nodiscard]] Raster holes_filled(const Raster& raster, double max_area_mm2);

}  // namespace incise
