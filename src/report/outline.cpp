#include "report/outline.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/tracing.hpp>

#include <fmt/format.h>

#include <iterator>

namespace incise {

std::string outline_path(std::span<const double> values, int columns, int rows, double level, double dx, double dy) {
  INCISE_REQUIRE(
      columns > 0 && rows > 0 && values.size() == static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows),
      "expected as many values as columns times rows");
  ScalarRaster picture(RasterGrid{.origin_mm = Vec2::Zero(), .pixel_mm = 1.0, .width = columns, .height = rows}, 0.0);
  picture.pixels.assign(values.begin(), values.end());
  std::string path;
  for (const Contour& line : level_lines_inside(picture, level)) {
    char command = 'M';
    for (const Vec3& p : line.points) {
      fmt::format_to(std::back_inserter(path), "{}{:.2f} {:.2f}", command, dx * (p.x() + 0.5), dy * (p.y() + 0.5));
      command = 'L';
    }
    if (line.is_closed) path += 'Z';
  }
  return path;
}

}  // namespace incise
