#include "geometry/box_tree.hpp"
#include "geometry/triangle_distance.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/surface_query.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

/// Slack, as a share of a triangle's size, by which a ray may miss it, so that there is no crack between neighbours.
constexpr double kRaySlack = 1e-9;
/// Upper limit of this slack, as a share of a triangle's sides, where the ray grazes the triangle.
constexpr double kMaxBarycentricSlack = 1e-3;

struct Ray {
  Vec3 origin;
  Vec3 direction;
};

/// Returns where the ray enters the box grown by `slack`: a distance in [0, limit], or infinity if it misses the box.
double entry_distance(const Box3& box, const Ray& ray, double slack, double limit) {
  double near = 0.0;
  double far = limit;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double low = box.min()[axis] - slack - ray.origin[axis];
    const double high = box.max()[axis] + slack - ray.origin[axis];
    const double speed = ray.direction[axis];
    if (speed == 0.0) {
      if (low > 0.0 || high < 0.0) return std::numeric_limits<double>::infinity();
      continue;
    }
    const double first = low / speed;
    const double last = high / speed;
    near = std::max(near, std::min(first, last));
    far = std::min(far, std::max(first, last));
    if (near > far) return std::numeric_limits<double>::infinity();
  }
  return near;
}

struct Hit {
  double distance = 0.0;
  Vec3 barycentric;
};

std::optional<Hit> hit_triangle(const Ray& ray, const std::array<Vec3, 3>& corners) {
  const Vec3 e1 = corners[1] - corners[0];
  const Vec3 e2 = corners[2] - corners[0];
  const Vec3 p = ray.direction.cross(e2);
  const double determinant = e1.dot(p);
  const double size = std::max(e1.squaredNorm(), e2.squaredNorm());
  if (std::abs(determinant) <= 1e-14 * size) return std::nullopt;  // seen edge-on: its neighbours are hit instead
  const Vec3 to_origin = ray.origin - corners[0];
  const double v = to_origin.dot(p) / determinant;
  const Vec3 q = to_origin.cross(e1);
  const double w = ray.direction.dot(q) / determinant;
  // The slack is a length beside the triangle; seen at a grazing angle it covers more of the barycentric range.
  const double slack = std::min(kMaxBarycentricSlack, kRaySlack * size / std::abs(determinant));
  if (v < -slack || w < -slack || v + w > 1.0 + slack) return std::nullopt;
  const Vec3 inside = Vec3(1.0 - v - w, v, w).cwiseMax(0.0);  // a hit within the slack counts as a hit on the edge
  return Hit{e2.dot(q) / determinant, inside / inside.sum()};
}

}  // namespace

struct SurfaceQuery::Tree {
  std::vector<std::array<Vec3, 3>> corners;
  BoxTree boxes;
  double slack_mm = 0.0;  // by which boxes are grown for rays

  [[nodiscard]] SurfacePoint point(std::size_t triangle, const Vec3& barycentric, double distance) const {
    const auto& [a, b, c] = corners[triangle];
    const Vec3 normal = (b - a).cross(c - a);
    const Vec3 position = barycentric[0] * a + barycentric[1] * b + barycentric[2] * c;
    return {TriangleId{triangle}, barycentric, position, normal.stableNormalized(), distance};
  }
};

SurfaceQuery::SurfaceQuery(const TriMesh& surface) : tree_(std::make_shared<Tree>()) {
  INCISE_REQUIRE(!surface.triangles.empty(), "expected a surface with at least 1 triangle, found none");
  std::vector<Box3> boxes;
  boxes.reserve(surface.triangles.size());
  tree_->corners.reserve(surface.triangles.size());
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    for (const VertexId id : surface.triangles[i]) {
      INCISE_REQUIRE(
          id.is_valid() && id.index() < surface.vertices.size(),
          fmt::format("triangle {} names vertex {}, expected one of {}", i, id.value, surface.vertices.size()));
      INCISE_REQUIRE(vertex(surface.vertices, id).allFinite(), fmt::format("vertex {} is not finite", id.value));
    }
    tree_->corners.push_back(corners_of(surface.vertices, surface.triangles[i]));
    boxes.push_back(bounding_box(tree_->corners.back()));
  }
  tree_->boxes = BoxTree(boxes);
  const Box3& all = tree_->boxes.box();
  tree_->slack_mm = kRaySlack * (1.0 + all.sizes().maxCoeff() + all.center().norm());
}

SurfacePoint SurfaceQuery::nearest(const Vec3& p) const {
  INCISE_REQUIRE(p.allFinite(), "the query point is not finite");
  double best_squared = std::numeric_limits<double>::infinity();
  std::uint32_t best_triangle = 0;
  Vec3 best = Vec3::Zero();
  const auto squared_distance = [&](const Box3& box) { return box.squaredExteriorDistance(p); };
  tree_->boxes.traverse([&](const Box3& box) { return squared_distance(box) <= best_squared; }, squared_distance,
                        [&](std::uint32_t triangle) {
                          const auto& [a, b, c] = tree_->corners[triangle];
                          const Vec3 weights = nearest_barycentric(a, b, c, p);
                          const double squared = (weights[0] * a + weights[1] * b + weights[2] * c - p).squaredNorm();
                          // Of equally near triangles the first one counts, whatever the order of the search.
                          if (squared > best_squared || (squared == best_squared && triangle > best_triangle)) return;
                          best_squared = squared;
                          best_triangle = triangle;
                          best = weights;
                        });
  return tree_->point(best_triangle, best, std::sqrt(best_squared));
}

std::optional<SurfacePoint> SurfaceQuery::first_hit(const Vec3& origin, const Vec3& direction, double max_mm) const {
  INCISE_REQUIRE(origin.allFinite() && direction.allFinite(), "the ray is not finite");
  INCISE_REQUIRE(std::abs(direction.squaredNorm() - 1.0) < 1e-6,
                 fmt::format("expected a direction of length 1, found {}", direction.norm()));
  const Ray ray{origin, direction};
  const double slack = tree_->slack_mm;
  double best_distance = max_mm;
  std::optional<std::uint32_t> best_triangle;
  Vec3 best = Vec3::Zero();
  const auto entry = [&](const Box3& box) { return entry_distance(box, ray, slack, best_distance + slack); };
  tree_->boxes.traverse([&](const Box3& box) { return std::isfinite(entry(box)); }, entry,
                        [&](std::uint32_t triangle) {
                          const std::optional<Hit> hit = hit_triangle(ray, tree_->corners[triangle]);
                          if (!hit || hit->distance < -slack || hit->distance > best_distance) return;
                          const double distance = std::max(0.0, hit->distance);
                          if (best_triangle && distance == best_distance && triangle > *best_triangle) return;
                          best_distance = distance;
                          best_triangle = triangle;
                          best = hit->barycentric;
                        });
  if (!best_triangle) return std::nullopt;
  return tree_->point(*best_triangle, best, best_distance);
}

std::optional<SurfacePoint> SurfaceQuery::seen_at(const Vec3& p, const Vec3& approach) const {
  INCISE_REQUIRE(approach.allFinite() && approach.norm() > 0.0, "expected a finite approach that is not zero");
  const Vec3 direction = approach.normalized();
  const Box3& box = tree_->boxes.box();
  // Start one diameter in front of the box's centre, where no part of the surface can be.
  const double start = direction.dot(box.center() - p) - box.diagonal().norm() - 1.0;
  std::optional<SurfacePoint> hit = first_hit(p + start * direction, direction, 2.0 * box.diagonal().norm() + 2.0);
  if (hit) hit->distance_mm += start;
  return hit;
}

bool SurfaceQuery::contains(const Vec3& p, const Vec3& direction) const {
  if (!tree_->boxes.box().contains(p)) return false;
  const std::optional<SurfacePoint> hit = first_hit(p, direction);
  return hit && hit->normal.dot(direction) > 0.0;
}

}  // namespace incise
