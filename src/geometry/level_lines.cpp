#include <incise/core/error.hpp>
#include <incise/geometry/tracing.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace incise {
namespace {

// A cell lies between four pixel centres; its corners and sides are numbered counter-clockwise:
//
//   3 --2-- 2
//   |       |
//   3       1
//   |       |
//   0 --0-- 1
//
// A line enters the cell through a side on which the value falls below the level from corner k to k + 1, and leaves
// through a side on which it rises above it, so higher values stay on its left.
constexpr std::array<std::array<int, 2>, 4> kCorners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

/// Follows the level through the grid of cells, which reaches one pixel beyond the picture if there is a value outside.
class Tracer {
 public:
  Tracer(const ScalarRaster& raster, double level, std::optional<double> outside)
      : raster_(raster),
        level_(level),
        outside_(outside),
        columns_(raster.width + 2),
        next_(2 * static_cast<std::size_t>(columns_) * static_cast<std::size_t>(raster.height + 2), kNone) {}

  std::vector<Contour> run() {
    const int beyond = outside_ ? 1 : 0;
    for (int j = -beyond; j + 1 < raster_.height + beyond; ++j) {
      for (int i = -beyond; i + 1 < raster_.width + beyond; ++i) join_sides(i, j);
    }
    std::vector<Contour> lines;
    for (const std::size_t first : open_starts()) lines.push_back(follow(first));
    for (std::size_t first = 0; first < next_.size(); ++first) {
      if (next_[first] != kNone) lines.push_back(follow(first));
    }
    return lines;
  }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  [[nodiscard]] double value(int i, int j) const { return raster_.at_or(i, j, outside_.value_or(0.0)); }

  [[nodiscard]] std::vector<std::size_t> open_starts() const {
    if (outside_) return {};  // all lines are closed
    std::vector<std::uint8_t> is_reached(next_.size(), 0);
    for (const std::size_t edge : next_) {
      if (edge != kNone) is_reached[edge] = 1;
    }
    std::vector<std::size_t> starts;
    for (std::size_t edge = 0; edge < next_.size(); ++edge) {
      if (next_[edge] != kNone && is_reached[edge] == 0) starts.push_back(edge);
    }
    return starts;
  }

  /// Returns the line that begins at an edge, and removes it from `next_`.
  [[nodiscard]] Contour follow(std::size_t first) {
    Contour line;
    std::size_t edge = first;
    while (next_[edge] != kNone) {
      line.points.push_back(crossing(edge));
      edge = std::exchange(next_[edge], kNone);
    }
    line.is_closed = edge == first;
    if (!line.is_closed) line.points.push_back(crossing(edge));
    return line;
  }

  /// Number of the grid edge from pixel (i, j) to its right (0) or upper (1) neighbour.
  [[nodiscard]] std::size_t edge(int i, int j, std::size_t direction) const {
    return 2 * (static_cast<std::size_t>(i + 1) +
                static_cast<std::size_t>(columns_) * static_cast<std::size_t>(j + 1)) +
           direction;
  }

  [[nodiscard]] std::size_t side(int i, int j, std::size_t k) const {
    return edge(i + (k == 1 ? 1 : 0), j + (k == 2 ? 1 : 0), k % 2);
  }

  void join_sides(int i, int j) {
    std::array<bool, 4> is_high{};
    double sum = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      const double corner = value(i + kCorners[k][0], j + kCorners[k][1]);
      is_high[k] = corner >= level_;
      sum += corner;
    }
    // In a saddle, the middle decides which pair of corners is joined; without a value outside, the high ones never
    // are.
    const bool joins_high = outside_ && 0.25 * sum >= level_;
    for (std::size_t k = 0; k < 4; ++k) {
      if (!(is_high[k] && !is_high[(k + 1) % 4])) continue;
      // Of the two ways out of a saddle, the next side cuts off the low corner ahead, the side before the high corner
      // behind.
      const std::size_t entry = side(i, j, k);
      for (const std::size_t turn :
           joins_high ? std::array<std::size_t, 3>{1, 2, 3} : std::array<std::size_t, 3>{3, 2, 1}) {
        const std::size_t s = (k + turn) % 4;
        if (!is_high[s] && is_high[(s + 1) % 4]) {
          next_[entry] = side(i, j, s);
          break;
        }
      }
    }
  }

  [[nodiscard]] Vec3 crossing(std::size_t edge_number) const {
    const std::size_t cell = edge_number / 2;
    const int i = static_cast<int>(cell % static_cast<std::size_t>(columns_)) - 1;
    const int j = static_cast<int>(cell / static_cast<std::size_t>(columns_)) - 1;
    const bool is_up = edge_number % 2 == 1;
    const double here = value(i, j);
    const double there = is_up ? value(i, j + 1) : value(i + 1, j);
    const double fraction = (level_ - here) / (there - here);
    const Vec2 p =
        raster_.origin_mm + raster_.pixel_mm * Vec2(i + (is_up ? 0.0 : fraction), j + (is_up ? fraction : 0.0));
    return {p.x(), p.y(), 0.0};
  }

  const ScalarRaster& raster_;
  double level_;
  std::optional<double> outside_;
  int columns_;
  std::vector<std::size_t> next_;  // per edge that a line crosses: the edge that it crosses next
};

void require_finite(const ScalarRaster& raster) {
  for (std::size_t p = 0; p < raster.pixels.size(); ++p) {
    INCISE_REQUIRE(std::isfinite(raster.pixels[p]), fmt::format("pixel {} is not finite", p));
  }
}

}  // namespace

std::vector<Contour> level_lines(const ScalarRaster& raster, double level, double outside) {
  INCISE_REQUIRE(std::isfinite(level) && std::isfinite(outside) && outside < level,
                 fmt::format("expected an outside value below the level, found {} and {}", outside, level));
  require_finite(raster);
  return Tracer(raster, level, outside).run();
}

std::vector<Contour> level_lines_inside(const ScalarRaster& raster, double level) {
  INCISE_REQUIRE(std::isfinite(level), fmt::format("expected a finite level, found {}", level));
  require_finite(raster);
  return Tracer(raster, level, std::nullopt).run();
}

}  // namespace incise
