#include "geometry/box_tree.hpp"

#include <incise/geometry/surface_query.hpp>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

using TriangleCorners = std::array<Vec3, 3>;

/// A volume below this share of (size of both triangles)³ is rounding: its points lie in one plane.
constexpr double kFlat = 1e-12;

double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) { return (b - a).cross(c - a).dot(d - a); }

/// Whether the segment from p to q has its ends on both sides of the triangle's plane and passes through the triangle,
/// edges included.
bool pierces(const Vec3& p, const Vec3& q, const TriangleCorners& t, double flat) {
  const double below = volume(t[0], t[1], t[2], p);
  const double above = volume(t[0], t[1], t[2], q);
  if (std::abs(below) <= flat || std::abs(above) <= flat || (below > 0.0) == (above > 0.0)) return false;
  bool is_left = false;
  bool is_right = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const double side = volume(p, q, t[i], t[(i + 1) % 3]);
    is_left = is_left || side > flat;
    is_right = is_right || side < -flat;
  }
  return !(is_left && is_right);
}

bool share_a_corner(const TriangleCorners& one, const TriangleCorners& other) {
  return std::any_of(one.begin(), one.end(),
                     [&](const Vec3& p) { return std::find(other.begin(), other.end(), p) != other.end(); });
}

/// Whether two triangles that share no corner cross: an edge of one passes through the other.
bool cross(const TriangleCorners& one, const TriangleCorners& other) {
  Box3 box;
  for (std::size_t i = 0; i < 3; ++i) box.extend(one[i]).extend(other[i]);
  const double size = box.diagonal().norm();
  const double flat = kFlat * size * size * size;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    if (pierces(one[i], one[next], other, flat) || pierces(other[i], other[next], one, flat)) return true;
  }
  return false;
}

}  // namespace

std::optional<std::array<TriangleId, 2>> find_self_crossing(const TriMesh& surface) {
  const std::size_t count = surface.triangles.size();
  if (count == 0) return std::nullopt;
  std::vector<TriangleCorners> corners;
  std::vector<Box3> boxes;
  for (const Triangle& triangle : surface.triangles) {
    corners.push_back(corners_of(surface.vertices, triangle));
    boxes.push_back(bounding_box(corners.back()));
  }
  const BoxTree tree(boxes);
  for (std::size_t t = 0; t < count; ++t) {
    std::size_t lowest = count;
    tree.traverse([&](const Box3& box) { return box.intersects(boxes[t]); }, [](const Box3&) { return 0.0; },
                  [&](std::uint32_t item) {
                    const std::size_t other = item;
                    if (other <= t || other >= lowest || !boxes[other].intersects(boxes[t])) return;
                    if (!share_a_corner(corners[t], corners[other]) && cross(corners[t], corners[other])) lowest = other;
                  });
    if (lowest < count) return std::array<TriangleId, 2>{TriangleId(t), TriangleId(lowest)};
  }
  return std::nullopt;
}

}  // namespace incise
