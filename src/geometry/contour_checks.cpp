#include "plane_cross.hpp"

#include <incise/geometry/contour_checks.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <fmt/format.h>

#include <vector>

namespace incise {
namespace {

bool lies_between(const Vec2& a, const Vec2& b, const Vec2& p) {
  return (p.array() >= a.cwiseMin(b).array()).all() && (p.array() <= a.cwiseMax(b).array()).all();
}

/// Whether the closed segments ab and cd share a point.
bool segments_meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  if ((a.cwiseMax(b).array() < c.cwiseMin(d).array()).any()) return false;
  if ((c.cwiseMax(d).array() < a.cwiseMin(b).array()).any()) return false;
  const double c_side = plane_cross(b - a, c - a);
  const double d_side = plane_cross(b - a, d - a);
  const double a_side = plane_cross(d - c, a - c);
  const double b_side = plane_cross(d - c, b - c);
  if (((c_side > 0 && d_side < 0) || (c_side < 0 && d_side > 0)) &&
      ((a_side > 0 && b_side < 0) || (a_side < 0 && b_side > 0))) {
    return true;
  }
  return (c_side == 0 && lies_between(a, b, c)) || (d_side == 0 && lies_between(a, b, d)) ||
         (a_side == 0 && lies_between(c, d, a)) || (b_side == 0 && lies_between(c, d, b));
}

/// A point that two segments share. @pre they meet.
Vec2 meeting_point(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const double turn = plane_cross(b - a, d - c);
  if (turn != 0.0) return a + plane_cross(c - a, d - c) / turn * (b - a);
  return lies_between(a, b, c) ? c : lies_between(a, b, d) ? d : a;
}

}  // namespace

std::optional<Vec3> first_crossing_in_view(const Contour& contour, const Vec3& approach) {
  const ViewFrame view = view_along(approach);
  // Repeated points would make a segment touch the neighbour of its neighbour.
  std::vector<Vec2> flat;
  std::vector<double> height;
  for (const Vec3& p : contour.points) {
    const Vec3 q = view.to_view(p);
    if (!flat.empty() && flat.back() == q.head<2>()) continue;
    flat.emplace_back(q.head<2>());
    height.push_back(q.z());
  }
  if (contour.is_closed && flat.size() > 1 && flat.front() == flat.back()) flat.pop_back();
  const std::size_t n = flat.size();
  if (n < 4) return std::nullopt;
  const std::size_t segments = contour.is_closed ? n : n - 1;
  for (std::size_t i = 0; i < segments; ++i) {
    const Vec2& a = flat[i];
    const Vec2& b = flat[(i + 1) % n];
    for (std::size_t j = i + 2; j < segments; ++j) {
      if (contour.is_closed && i == 0 && j == segments - 1) continue;  // neighbours through the seam
      const Vec2& c = flat[j];
      const Vec2& d = flat[(j + 1) % n];
      if (!segments_meet(a, b, c, d)) continue;
      const Vec2 at = meeting_point(a, b, c, d);
      return view.from_view({at.x(), at.y(), height[i]});
    }
  }
  return std::nullopt;
}

std::optional<Problem> size_problem(const Contour& contour, const std::string& what, double largest_mm) {
  const double extent = contour.points.empty() ? 0.0 : bounding_box(contour.points).sizes().maxCoeff();
  if (extent >= kSmallestTumorMm && extent <= largest_mm) return std::nullopt;
  return Problem{.path = {},
                 .found = fmt::format("{} {:.4g} mm across", what, extent),
                 .expected = fmt::format("{} to {} mm", kSmallestTumorMm, largest_mm)};
}

}  // namespace incise
