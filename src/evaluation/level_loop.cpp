#include <incise/core/error.hpp>
#include <incise/evaluation/level_loop.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace incise {
namespace {

constexpr std::size_t kMostCells = 1'000'000;
constexpr int kMostTrials = 80;  // for the zero on a grid edge; about 6 for a smooth function
constexpr double kZeroMm = 1e-12;
constexpr double kOffsetStepMm = 0.25;

using Node = std::pair<int, int>;

/// Corners of a cell, counter-clockwise; edge k runs from corner k to corner k + 1.
///
///     3 --2-- 2
///     |       |
///     3       1
///     |       |
///     0 --0-- 1
struct Cell {
  int i = 0, j = 0;  // of corner 0
  [[nodiscard]] Node corner(int k) const {
    static constexpr std::array<Node, 4> kStep{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    const Node& step = kStep[static_cast<std::size_t>(k % 4)];
    return {i + step.first, j + step.second};
  }
  [[nodiscard]] Cell beyond(int edge) const {
    static constexpr std::array<Node, 4> kStep{{{0, -1}, {1, 0}, {0, 1}, {-1, 0}}};
    const Node& step = kStep[static_cast<std::size_t>(edge)];
    return {i + step.first, j + step.second};
  }
};

class Grid {
 public:
  Grid(const std::function<double(const Vec2&)>& field, const Vec2& origin, double step)
      : field_(field), origin_(origin), step_(step) {}

  [[nodiscard]] Vec2 position(const Node& node) const { return origin_ + step_ * Vec2(node.first, node.second); }
  [[nodiscard]] Vec2 center(const Cell& cell) const { return position({cell.i, cell.j}) + Vec2::Constant(0.5 * step_); }
  double value(const Node& node) {
    const auto [entry, is_new] = values_.try_emplace(node, 0.0);
    if (is_new) entry->second = field_(position(node));
    return entry->second;
  }
  bool is_inside(const Node& node) { return value(node) < 0.0; }  // false for NaN: no value counts as outside
  bool is_center_inside(const Cell& cell) { return field_(center(cell)) < 0.0; }

  /// The zero between two nodes; nullopt if the search meets a place without a value.
  std::optional<Vec2> zero_between(const Node& inside, const Node& outside) {
    if (std::isnan(value(outside))) return std::nullopt;
    const Vec2 start = position(inside);
    const Vec2 way = position(outside) - start;
    double in = 0.0, f_in = value(inside), out = 1.0, f_out = value(outside);
    if (f_out == 0.0) return start + way;
    int last_side = 0;
    for (int n = 0; n < kMostTrials && (out - in) * step_ > kZeroMm; ++n) {
      // False position, halving the value at an end that stays (Illinois); every fourth trial bisects.
      const double share = n % 4 == 3 ? 0.5 : f_in / (f_in - f_out);
      const double trial = in + share * (out - in);
      const double f = field_(start + trial * way);
      if (std::isnan(f)) return std::nullopt;
      if (std::abs(f) <= kZeroMm) return start + trial * way;
      if (f < 0.0) {
        in = trial, f_in = f;
        if (last_side < 0) f_out *= 0.5;
        last_side = -1;
      } else {
        out = trial, f_out = f;
        if (last_side > 0) f_in *= 0.5;
        last_side = 1;
      }
    }
    return start + out * way;
  }

  /// The edge through which the border leaves a cell that it entered through `entry`, with the inside on its left.
  int exit_edge(const Cell& cell, int entry) {
    const auto leaves = [&](int k) { return !is_inside(cell.corner(k)) && is_inside(cell.corner(k + 1)); };
    const int right = (entry + 1) % 4;
    const int left = (entry + 3) % 4;
    const bool is_saddle = leaves(right) && leaves(left);
    if (is_saddle)
      return is_center_inside(cell) ? right : left;  // joined insides: cut off the outside corner on the right
    for (const int k : {right, (entry + 2) % 4, left}) {
      if (leaves(k)) return k;
    }
    return entry;  // not reached: a border that enters a cell leaves it
  }

 private:
  const std::function<double(const Vec2&)>& field_;
  Vec2 origin_;
  double step_;
  std::map<Node, double> values_;
};

}  // namespace

LevelLoop trace_level_loop(const std::function<double(const Vec2&)>& field, const Vec2& inside, double reach_mm,
                           double step_mm) {
  INCISE_REQUIRE(std::isfinite(step_mm) && step_mm > 0.0, fmt::format("expected a step above 0 mm, found {}", step_mm));
  INCISE_REQUIRE(std::isfinite(reach_mm) && reach_mm > 0.0,
                 fmt::format("expected a reach above 0 mm, found {}", reach_mm));
  Grid grid(field, inside, step_mm);
  INCISE_REQUIRE(grid.is_inside({0, 0}), "the function is not negative at the point given as inside");

  // Search from the end of the reach inwards, along -x: the first border found is the outermost one.
  int column = static_cast<int>(std::ceil(reach_mm / step_mm)) + 1;
  INCISE_REQUIRE(!grid.is_inside({column, 0}), "the function is still negative at the end of the reach");
  while (!grid.is_inside({column - 1, 0})) --column;
  const Cell first{column - 1, 0};

  LevelLoop loop;
  Cell cell = first;
  int entry = 0;
  for (std::size_t n = 0; n < kMostCells; ++n) {
    const std::optional<Vec2> zero = grid.zero_between(cell.corner(entry), cell.corner(entry + 1));
    if (!zero) {
      loop.undefined_at = 0.5 * (grid.position(cell.corner(entry)) + grid.position(cell.corner(entry + 1)));
      return loop;
    }
    if (loop.points.empty() || *zero != loop.points.back()) loop.points.push_back(*zero);
    const int exit = grid.exit_edge(cell, entry);
    cell = cell.beyond(exit);
    entry = (exit + 2) % 4;
    if (cell.i == first.i && cell.j == first.j && entry == 0) {
      if (loop.points.size() > 1 && loop.points.front() == loop.points.back()) loop.points.pop_back();
      return loop;
    }
  }
  throw InvalidArgument(fmt::format("trace_level_loop: the border does not close within {} cells", kMostCells));
}

Contour outer_offset(const Contour& contour, double distance_mm, const Vec3& approach) {
  INCISE_REQUIRE(contour.is_closed && contour.points.size() >= 3,
                 fmt::format("expected a closed contour of at least 3 points, found {}", contour.points.size()));
  INCISE_REQUIRE(std::isfinite(distance_mm) && distance_mm > 0.0,
                 fmt::format("expected a distance above 0 mm, found {}", distance_mm));
  const ViewFrame view = view_along(approach);
  Contour flat{.points = {}, .is_closed = true};
  double height = 0.0;
  for (const Vec3& p : contour.points) {
    INCISE_REQUIRE(p.allFinite(), "a point of the contour is not finite");
    const Vec3 q = view.to_view(p);
    flat.points.emplace_back(q.x(), q.y(), 0.0);
    height += q.z() / static_cast<double>(contour.points.size());
  }
  const auto rightmost = std::max_element(flat.points.begin(), flat.points.end(),
                                          [](const Vec3& a, const Vec3& b) { return a.x() < b.x(); });
  // Deep inside the contour the field is positive again, but the outer border never leads there.
  const auto field = [&](const Vec2& p) { return nearest_on(flat, Vec3(p.x(), p.y(), 0.0)).distance_mm - distance_mm; };
  const double step = std::min(kOffsetStepMm, distance_mm / 4.0);
  const LevelLoop loop = trace_level_loop(field, rightmost->head<2>(), distance_mm, step);
  Contour result{.points = {}, .is_closed = true};
  for (const Vec2& p : loop.points) result.points.push_back(view.from_view(Vec3(p.x(), p.y(), height)));
  return result;
}

}  // namespace incise
