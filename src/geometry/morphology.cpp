#include <incise/core/error.hpp>
#include <incise/geometry/distance_line.hpp>
#include <incise/geometry/morphology.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace incise {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Slack, mm: pixels at exactly the radius stay on the same side whatever the rounding.
constexpr double kRadiusSlack = 1e-9;

void require_radius(double radius_mm) {
  INCISE_REQUIRE(std::isfinite(radius_mm) && radius_mm >= 0.0,
                 fmt::format("expected a radius of 0 mm or more, found {}", radius_mm));
}

}  // namespace

ScalarRaster distance_to(const Raster& raster, std::uint8_t value) {
  ScalarRaster distance(raster, kInfinity);
  const auto width = static_cast<std::size_t>(raster.width);
  const auto height = static_cast<std::size_t>(raster.height);
  DistanceLine line;
  line.values.resize(height);
  for (std::size_t i = 0; i < width; ++i) {
    for (std::size_t j = 0; j < height; ++j) line.values[j] = raster.pixels[i + width * j] == value ? 0.0 : kInfinity;
    line.transform();
    for (std::size_t j = 0; j < height; ++j) distance.pixels[i + width * j] = line.result[j];
  }
  line.values.resize(width);
  for (std::size_t j = 0; j < height; ++j) {
    const auto row = distance.pixels.begin() + static_cast<std::ptrdiff_t>(width * j);
    std::copy(row, row + static_cast<std::ptrdiff_t>(width), line.values.begin());
    line.transform();
    std::transform(line.result.begin(), line.result.end(), row,
                   [&](double squared) { return raster.pixel_mm * std::sqrt(squared); });
  }
  return distance;
}

Raster dilated(const Raster& raster, double radius_mm) {
  require_radius(radius_mm);
  const ScalarRaster distance = distance_to(raster, 1);
  return set_where(raster, [&](std::size_t p) { return distance.pixels[p] <= radius_mm + kRadiusSlack; });
}

Raster eroded(const Raster& raster, double radius_mm) {
  require_radius(radius_mm);
  const ScalarRaster distance = distance_to(raster, 0);
  return set_where(raster, [&](std::size_t p) { return distance.pixels[p] > radius_mm + kRadiusSlack; });
}

Raster closed(const Raster& raster, double radius_mm) {
  return eroded(dilated(raster, radius_mm), radius_mm);
}

Raster opened(const Raster& raster, double radius_mm) {
  return dilated(eroded(raster, radius_mm), radius_mm);
}

Components find_components(const Raster& raster, std::uint8_t value, Connectivity connectivity) {
  constexpr std::array<std::array<int, 2>, 8> kSteps{
      {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
  const std::size_t steps = connectivity == Connectivity::Four ? 4 : 8;
  Components components;
  components.labels.assign(raster.pixel_count(), -1);
  std::vector<std::array<int, 2>> waiting;
  for (int j = 0; j < raster.height; ++j) {
    for (int i = 0; i < raster.width; ++i) {
      if (raster.at(i, j) != value || components.labels[raster.offset(i, j)] >= 0) continue;
      const auto label = static_cast<std::int32_t>(components.parts.size());
      Components::Part part;
      components.labels[raster.offset(i, j)] = label;
      waiting.push_back({i, j});
      while (!waiting.empty()) {
        const auto [x, y] = waiting.back();
        waiting.pop_back();
        ++part.pixels;
        if (x == 0 || y == 0 || x == raster.width - 1 || y == raster.height - 1) part.touches_border = true;
        for (std::size_t s = 0; s < steps; ++s) {
          const int nx = x + kSteps[s][0];
          const int ny = y + kSteps[s][1];
          if (!raster.contains(nx, ny) || raster.at(nx, ny) != value) continue;
          std::int32_t& neighbour = components.labels[raster.offset(nx, ny)];
          if (neighbour >= 0) continue;
          neighbour = label;
          waiting.push_back({nx, ny});
        }
      }
      components.parts.push_back(part);
    }
  }
  return components;
}

Raster part_of(const Raster& raster, const Components& components, std::int32_t part) {
  INCISE_REQUIRE(components.labels.size() == raster.pixels.size(), "the parts belong to another picture");
  return set_where(raster, [&](std::size_t p) { return components.labels[p] == part; });
}

std::optional<std::int32_t> largest_part(const Components& components) {
  if (components.parts.empty()) return std::nullopt;
  const auto largest = std::max_element(components.parts.begin(), components.parts.end(),
                                        [](const auto& a, const auto& b) { return a.pixels < b.pixels; });
  return static_cast<std::int32_t>(largest - components.parts.begin());
}

Raster holes_filled(const Raster& raster, double max_area_mm2) {
  const Components background = find_components(raster, 0, Connectivity::Four);
  const double pixel_area = raster.pixel_mm * raster.pixel_mm;
  Raster result = raster;
  for (std::size_t p = 0; p < result.pixels.size(); ++p) {
    const std::int32_t label = background.labels[p];
    if (label < 0) continue;
    const Components::Part& part = background.parts[static_cast<std::size_t>(label)];
    if (!part.touches_border && static_cast<double>(part.pixels) * pixel_area <= max_area_mm2) result.pixels[p] = 1;
  }
  return result;
}

}  // namespace incise
