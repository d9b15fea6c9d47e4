#pragma once

#include <incise/geometry/raster.hpp>

#include <optional>

namespace incise {

/// Which pixels touch: those that share a side, or also those that share a corner. A set and its complement take one
/// each.
enum class Connectivity { Four, Eight };

/// Distance, mm, from each pixel's centre to the nearest centre of a pixel of the given value (0 or 1); infinite if
/// there is none. Exact Euclidean distance transform, O(pixels). Source: Felzenszwalb and Huttenlocher, Theory of
/// Computing 8 (2012).
[[nodiscard]] ScalarRaster distance_to(const Raster& raster, std::uint8_t value);

/// Every pixel within `radius_mm` of the set.
[[nodiscard]] Raster dilated(const Raster& raster, double radius_mm);
/// Every pixel farther than `radius_mm` from the complement; what lies beyond the picture takes nothing away.
[[nodiscard]] Raster eroded(const Raster& raster, double radius_mm);
/// Closing by a disc: fills gaps narrower than twice the radius; never removes a pixel. Needs a border of one radius.
[[nodiscard]] Raster closed(const Raster& raster, double radius_mm);
/// Opening by a disc: removes parts narrower than twice the radius; never adds a pixel.
[[nodiscard]] Raster opened(const Raster& raster, double radius_mm);

/// The connected parts of the pixels of one value.
struct Components {
  struct Part {
    std::size_t pixels = 0;
    bool touches_border = false;  ///< has a pixel in the first or last row or column
  };
  std::vector<std::int32_t>
      labels;  ///< per pixel the part's number, in order of each part's first pixel; -1 for other pixels
  std::vector<Part> parts;
};
[[nodiscard]] Components find_components(const Raster& raster, std::uint8_t value, Connectivity connectivity);

/// The pixels of one part.
[[nodiscard]] Raster part_of(const Raster& raster, const Components& components, std::int32_t part);

/// The part with the most pixels (the first of equals); nullopt when there is none.
[[nodiscard]] std::optional<std::int32_t> largest_part(const Components& components);

/// Adds the holes (parts of the complement, by four-connectivity, that do not touch the border) of at most
/// `max_area_mm2`.
[[nodiscard]] Raster holes_filled(const Raster& raster, double max_area_mm2);

}  // namespace incise
