#include "report/outline.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/types.hpp>

#include <fmt/format.h>

#include <iterator>
#include <map>
#include <vector>

namespace incise {
namespace {

// A cell lies between the centres of four picture elements. Its corners and sides:
//
//     0 --0-- 1        bit k of the case: corner k is at or above the level
//     |       |
//     3       1        a side is crossed when its two corners differ
//     |       |
//     3 --2-- 2
//
// Segments per case, as pairs of sides; the tissue lies at the right hand of each. The two ambiguous cases (5, 10) are
// taken as separate corners.
constexpr std::array<std::array<int, 4>, 16> kSegments{{{-1, -1, -1, -1},
                                                        {0, 3, -1, -1},
                                                        {1, 0, -1, -1},
                                                        {1, 3, -1, -1},
                                                        {2, 1, -1, -1},
                                                        {0, 3, 2, 1},
                                                        {2, 0, -1, -1},
                                                        {2, 3, -1, -1},
                                                        {3, 2, -1, -1},
                                                        {0, 2, -1, -1},
                                                        {1, 0, 3, 2},
                                                        {1, 2, -1, -1},
                                                        {3, 1, -1, -1},
                                                        {0, 1, -1, -1},
                                                        {3, 0, -1, -1},
                                                        {-1, -1, -1, -1}}};

/// Finds crossings and joins segments that share one into lines.
class Tracer {
 public:
  Tracer(std::span<const double> values, int columns, int rows, double level)
      : values_(values), columns_(columns), rows_(rows), level_(level) {}

  /// Next crossing by crossing; every crossing starts at most one segment because segments keep the tissue at one hand.
  std::map<long, long> segments() const {
    std::map<long, long> next;
    for (int row = 0; row + 1 < rows_; ++row) {
      for (int column = 0; column + 1 < columns_; ++column) {
        const std::array<int, 4>& sides = kSegments[static_cast<std::size_t>(case_of(column, row))];
        for (std::size_t k = 0; k < 4 && sides[k] >= 0; k += 2) {
          next[crossing(column, row, sides[k])] = crossing(column, row, sides[k + 1]);
        }
      }
    }
    return next;
  }

  /// Where the level lies on the grid line that a crossing stands for, in elements.
  [[nodiscard]] Vec2 position(long crossing) const {
    const bool is_vertical = crossing % 2 == 1;
    const auto column = static_cast<int>(crossing / 2 % columns_);
    const auto row = static_cast<int>(crossing / 2 / columns_);
    const double a = value(column, row);
    const double b = is_vertical ? value(column, row + 1) : value(column + 1, row);
    const double f = (level_ - a) / (b - a);
    return is_vertical ? Vec2(column + 0.5, row + 0.5 + f) : Vec2(column + 0.5 + f, row + 0.5);
  }

 private:
  [[nodiscard]] double value(int column, int row) const {
    return values_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                   static_cast<std::size_t>(column)];
  }
  [[nodiscard]] int case_of(int column, int row) const {
    return (value(column, row) >= level_ ? 1 : 0) | (value(column + 1, row) >= level_ ? 2 : 0) |
           (value(column + 1, row + 1) >= level_ ? 4 : 0) | (value(column, row + 1) >= level_ ? 8 : 0);
  }
  /// A number for the grid line between two neighbours: even to the right of an element, odd below it.
  [[nodiscard]] long crossing(int column, int row, int side) const {
    const auto number = [&](int c, int r, int odd) { return 2L * (static_cast<long>(r) * columns_ + c) + odd; };
    switch (side) {
      case 0:
        return number(column, row, 0);
      case 1:
        return number(column + 1, row, 1);
      case 2:
        return number(column, row + 1, 0);
      default:
        return number(column, row, 1);
    }
  }

  std::span<const double> values_;
  int columns_, rows_;
  double level_;
};

}  // namespace

std::string outline_path(std::span<const double> values, int columns, int rows, double level, double dx, double dy) {
  INCISE_REQUIRE(
      columns > 0 && rows > 0 && values.size() == static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows),
      "expected as many values as columns times rows");
  const Tracer tracer(values, columns, rows, level);
  std::map<long, long> next = tracer.segments();
  std::map<long, bool> is_inner;  // crossings that another segment leads to
  for (const auto& [from, to] : next) is_inner[to] = true;

  std::string path;
  const auto append = [&](char command, long crossing) {
    const Vec2 p = tracer.position(crossing);
    fmt::format_to(std::back_inserter(path), "{}{:.2f} {:.2f}", command, dx * p.x(), dy * p.y());
  };
  const auto trace = [&](long start) {
    append('M', start);
    long at = start;
    while (true) {
      const auto step = next.find(at);
      if (step == next.end()) return;
      at = step->second;
      next.erase(step);
      if (at == start) {
        path += 'Z';
        return;
      }
      append('L', at);
    }
  };
  std::vector<long> open_starts;  // lines that come in from the picture's border go first, so that they stay whole
  for (const auto& [from, to] : next) {
    if (!is_inner.contains(from)) open_starts.push_back(from);
  }
  for (const long start : open_starts) trace(start);
  while (!next.empty()) trace(next.begin()->first);
  return path;
}

}  // namespace incise
