#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/core/median.hpp>
#include <incise/core/units.hpp>
#include <incise/geometry/neighbours.hpp>
#include <incise/geometry/point_cloud.hpp>

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace incise {
namespace {

constexpr std::size_t kMostAsked = 2000;  // a median over a larger cloud uses at least this many, fewer than twice
constexpr std::size_t kChunk = 256;

/// Mean of a set of points, variances along its principal axes, and the axis of least variance.
struct LocalPlane {
  Vec3 mean = Vec3::Zero();
  Vec3 variances = Vec3::Zero();  // ascending
  Vec3 normal = Vec3::UnitZ();
};

template <class PointOf>
LocalPlane plane_through(std::size_t count, const PointOf& point_of) {
  LocalPlane plane;
  for (std::size_t i = 0; i < count; ++i) plane.mean += point_of(i);
  plane.mean /= static_cast<double>(count);
  Mat3 scatter = Mat3::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 d = point_of(i) - plane.mean;
    scatter += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(scatter / static_cast<double>(count));
  plane.variances = solver.eigenvalues();
  plane.normal = solver.eigenvectors().col(0);
  return plane;
}

/// Returns the step between the points that a median over the cloud uses.
std::size_t stride_of(std::size_t count) {
  return std::max<std::size_t>(1, count / kMostAsked);
}

}  // namespace

PointCloud cloud_of(const TriMesh& mesh) {
  PointCloud cloud{mesh.vertices, {}};
  const auto found = mesh.point_data.find("normals");
  if (found == mesh.point_data.end() || found->second.components != 3 ||
      found->second.values.size() != 3 * mesh.vertices.size()) {
    return cloud;
  }
  cloud.normals.reserve(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3 normal = Eigen::Map<const Vec3>(found->second.values.data() + 3 * i);
    const double length = normal.norm();
    if (!(length > 1e-6)) return {mesh.vertices, {}};
    cloud.normals.emplace_back(normal / length);
  }
  return cloud;
}

TriMesh mesh_of(const PointCloud& cloud) {
  TriMesh mesh;
  mesh.vertices = cloud.points;
  if (cloud.normals.empty()) return mesh;
  DataArray& normals = mesh.point_data["normals"];
  normals.components = 3;
  for (const Vec3& n : cloud.normals) normals.values.insert(normals.values.end(), {n.x(), n.y(), n.z()});
  return mesh;
}

PointCloud subset(const PointCloud& cloud, std::span<const std::size_t> indices) {
  PointCloud part;
  part.points.reserve(indices.size());
  for (const std::size_t i : indices) {
    INCISE_REQUIRE(i < cloud.points.size(), fmt::format("index {} of {} points", i, cloud.points.size()));
    part.points.push_back(cloud.points[i]);
    if (!cloud.normals.empty()) part.normals.push_back(cloud.normals[i]);
  }
  return part;
}

PointCloud crop(const PointCloud& cloud, const Box3& box) {
  std::vector<std::size_t> inside;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (box.contains(cloud.points[i])) inside.push_back(i);
  }
  return subset(cloud, inside);
}

PointCloud downsample(const PointCloud& cloud, double voxel_mm) {
  INCISE_REQUIRE(std::isfinite(voxel_mm) && voxel_mm > 0.0,
                 fmt::format("expected a voxel above 0 mm, found {}", voxel_mm));
  PointCloud thinned;
  if (cloud.points.empty()) return thinned;
  const Vec3 low = bounding_box(cloud.points).min();
  using Key = std::array<std::int64_t, 3>;  // z, y, x
  std::vector<std::pair<Key, std::size_t>> places;
  places.reserve(cloud.points.size());
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Vec3 q = (cloud.points[i] - low) / voxel_mm;
    INCISE_REQUIRE(q.allFinite() && q.maxCoeff() < 1e15,
                   fmt::format("point {} is not finite or too far for this voxel", i));
    const auto floor = [](double value) { return static_cast<std::int64_t>(std::floor(value)); };
    places.push_back({{floor(q.z()), floor(q.y()), floor(q.x())}, i});
  }
  std::sort(places.begin(), places.end());
  for (std::size_t begin = 0; begin < places.size();) {
    std::size_t end = begin;
    Vec3 sum = Vec3::Zero();
    Vec3 normal = Vec3::Zero();
    for (; end < places.size() && places[end].first == places[begin].first; ++end) {
      sum += cloud.points[places[end].second];
      if (!cloud.normals.empty()) normal += cloud.normals[places[end].second];
    }
    thinned.points.emplace_back(sum / static_cast<double>(end - begin));
    if (!cloud.normals.empty()) {
      // Opposite sides of a thin sheet in one cube cancel; then the first point's normal is used.
      const bool has_mean = normal.norm() > 1e-6;
      thinned.normals.emplace_back(has_mean ? Vec3(normal.normalized()) : cloud.normals[places[begin].second]);
    }
    begin = end;
  }
  return thinned;
}

double spacing_mm(std::span<const Vec3> points) {
  if (points.size() < 2) return 0.0;
  const NeighbourSearch search(points);
  std::vector<double> distances;
  for (std::size_t i = 0; i < points.size(); i += stride_of(points.size())) {
    distances.push_back(std::sqrt(search.nearest(points[i], 2).back().squared_mm2));
  }
  return median(distances);
}

double sampled_area_mm2(std::span<const Vec3> points) {
  constexpr std::size_t kNeighbours = 8;
  if (points.size() < kNeighbours + 2) return 0.0;
  const NeighbourSearch search(points);
  double area = 0.0;
  // A disc between the eighth and the ninth neighbour: accurate to 6 % for points on a grid (1.05) and random points
  // (0.94).
  for (const Vec3& p : points) {
    const std::vector<Neighbour> near = search.nearest(p, kNeighbours + 2);
    area += 0.5 * units::kPi * (near[kNeighbours].squared_mm2 + near.back().squared_mm2) / (kNeighbours + 1.0);
  }
  return area;
}

PointCloud with_normals(PointCloud cloud, const Vec3& seen_along, int neighbours, Workers& workers) {
  INCISE_REQUIRE(neighbours >= 3, fmt::format("expected at least 3 neighbours, found {}", neighbours));
  INCISE_REQUIRE(seen_along.allFinite() && seen_along.norm() > 0.0, "expected a direction");
  cloud.normals.assign(cloud.points.size(), Vec3(-seen_along.normalized()));
  if (cloud.points.size() < 3) return cloud;
  const NeighbourSearch search(cloud.points);
  workers.for_each(cloud.points.size(), kChunk, [&](std::size_t i) {
    const std::vector<Neighbour> near = search.nearest(cloud.points[i], static_cast<std::size_t>(neighbours));
    const LocalPlane plane = plane_through(near.size(), [&](std::size_t k) { return cloud.points[near[k].index]; });
    cloud.normals[i] = plane.normal.dot(seen_along) > 0.0 ? Vec3(-plane.normal) : plane.normal;
  });
  return cloud;
}

double roughness_mm(std::span<const Vec3> points, int neighbours) {
  INCISE_REQUIRE(neighbours >= 4, fmt::format("expected at least 4 neighbours, found {}", neighbours));
  if (points.size() < 4) return 0.0;
  const NeighbourSearch search(points);
  std::vector<double> deviations;
  for (std::size_t i = 0; i < points.size(); i += stride_of(points.size())) {
    const std::vector<Neighbour> near = search.nearest(points[i], static_cast<std::size_t>(neighbours));
    const LocalPlane plane = plane_through(near.size(), [&](std::size_t k) { return points[near[k].index]; });
    // A plane through n points takes three degrees of freedom.
    const auto n = static_cast<double>(near.size());
    deviations.push_back(std::sqrt(std::max(0.0, plane.variances[0]) * n / (n - 3.0)));
  }
  return median(deviations);
}

PointCloud without_outliers(const PointCloud& cloud, int neighbours, double deviations, Workers& workers) {
  INCISE_REQUIRE(neighbours >= 1, fmt::format("expected at least 1 neighbour, found {}", neighbours));
  INCISE_REQUIRE(deviations >= 0.0, fmt::format("expected 0 or more deviations, found {}", deviations));
  const std::size_t n = cloud.points.size();
  if (n < 3) return cloud;
  const NeighbourSearch search(cloud.points);
  std::vector<double> mean_distance(n);
  workers.for_each(n, kChunk, [&](std::size_t i) {
    const std::vector<Neighbour> near = search.nearest(cloud.points[i], static_cast<std::size_t>(neighbours) + 1);
    double sum = 0.0;
    for (const Neighbour& neighbour : near) sum += std::sqrt(neighbour.squared_mm2);
    mean_distance[i] = sum / static_cast<double>(near.size() - 1);
  });
  const double mean = std::accumulate(mean_distance.begin(), mean_distance.end(), 0.0) / static_cast<double>(n);
  double squares = 0.0;
  for (const double d : mean_distance) squares += (d - mean) * (d - mean);
  const double limit = mean + deviations * std::sqrt(squares / static_cast<double>(n - 1));
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < n; ++i) {
    if (mean_distance[i] <= limit) kept.push_back(i);
  }
  return subset(cloud, kept);
}

std::optional<PlaneFit> find_plane(std::span<const Vec3> points, double tolerance_mm, int trials, Random& random) {
  INCISE_REQUIRE(tolerance_mm > 0.0 && trials > 0, "expected a tolerance and a number of trials above 0");
  if (points.size() < 3) return std::nullopt;
  const auto within = [&](const Vec3& normal, double offset) {
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (std::abs(normal.dot(points[i]) - offset) <= tolerance_mm) near.push_back(i);
    }
    return near;
  };
  PlaneFit best;
  for (int trial = 0; trial < trials; ++trial) {
    const Vec3& a = points[random.below(points.size())];
    const Vec3& b = points[random.below(points.size())];
    const Vec3& c = points[random.below(points.size())];
    const Vec3 cross = (b - a).cross(c - a);
    if (!(cross.norm() > 1e-9 * (b - a).norm() * (c - a).norm())) continue;
    const Vec3 normal = cross.normalized();
    const double offset = normal.dot(a);
    std::size_t count = 0;
    for (const Vec3& p : points) count += std::abs(normal.dot(p) - offset) <= tolerance_mm ? 1 : 0;
    if (count > best.inliers.size()) best = {normal, offset, within(normal, offset)};
  }
  if (best.inliers.size() < 3) return std::nullopt;
  const LocalPlane plane = plane_through(best.inliers.size(), [&](std::size_t k) { return points[best.inliers[k]]; });
  best.normal = plane.normal;
  best.offset_mm = plane.normal.dot(plane.mean);
  best.inliers = within(best.normal, best.offset_mm);
  return best;
}

std::vector<Problem> validate(const CleaningSettings& s) {
  std::vector<Problem> problems = problems_of(s);
  const Expect expect(problems);
  if (s.box) expect(!s.box->isEmpty(), "box", s.box->sizes().minCoeff(), "the low corner below the high one");
  expect(s.normal_neighbours == 0 || s.normal_neighbours >= 3, "normal_neighbours", s.normal_neighbours,
         "0, or 3 or more");
  return problems;
}

CleanedCloud clean_cloud(const PointCloud& cloud, const CleaningSettings& settings, Random& random, Workers& workers) {
  constexpr int kPlaneTrials = 300;  // finds a plane of a fifth of the points with a chance of 0.9
  require_none(validate(settings));
  CleanedCloud result;
  result.cloud = settings.box ? crop(cloud, *settings.box) : cloud;
  result.cropped = cloud.points.size() - result.cloud.points.size();
  for (int k = 0; k < settings.planes; ++k) {
    std::optional<PlaneFit> plane = find_plane(result.cloud.points, settings.plane_tolerance_mm, kPlaneTrials, random);
    const auto left = static_cast<double>(result.cloud.points.size());
    if (!plane || static_cast<double>(plane->inliers.size()) < settings.plane_least_share * left) break;
    if (plane->normal.dot(settings.seen_along) > 0.0) {
      plane->normal = -plane->normal;
      plane->offset_mm = -plane->offset_mm;
    }
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < result.cloud.points.size(); ++i) {
      const double height = plane->normal.dot(result.cloud.points[i]) - plane->offset_mm;
      const bool is_beneath = height < -settings.plane_tolerance_mm && settings.drop_beneath_planes;
      result.beneath_planes += is_beneath ? 1 : 0;
      if (std::abs(height) > settings.plane_tolerance_mm && !is_beneath) kept.push_back(i);
    }
    result.cloud = subset(result.cloud, kept);
    result.planes.push_back(std::move(*plane));
  }
  if (settings.outlier_neighbours > 0) {
    const std::size_t before = result.cloud.points.size();
    result.cloud = without_outliers(result.cloud, settings.outlier_neighbours, settings.outlier_deviations, workers);
    result.outliers = before - result.cloud.points.size();
  }
  if (settings.voxel_mm > 0.0) result.cloud = downsample(result.cloud, settings.voxel_mm);
  if (settings.normal_neighbours > 0) {
    result.cloud = with_normals(std::move(result.cloud), settings.seen_along, settings.normal_neighbours, workers);
  }
  return result;
}

}  // namespace incise
