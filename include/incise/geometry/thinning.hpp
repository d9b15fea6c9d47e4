#pragma once

#include <incise/geometry/raster.hpp>

namespace incise {

/// Returns the mid-line of a set, one pixel wide, with its ends kept: Zhang and Suen's parallel thinning, then removal
/// of the corner pixels that it leaves on slanting lines, so that every pixel that is neither an end nor a fork has two
/// neighbours. Parts stay connected (by eight) and holes stay. Departs from the source, in which squares of 2 x 2
/// pixels and slanting lines two pixels wide vanish. O(pixels x width of the set). Source: Zhang and Suen,
/// Communications of the ACM 27(3), 1984.
[[nodiscard]] Raster thinned(Raster raster);

}  // namespace incise
