#include <incise/core/error.hpp>
#include <incise/geometry/cloud_surface.hpp>

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace incise {
namespace {

constexpr std::size_t kLeastPoints = 12;  // twice the six numbers of a quadratic
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

Vec6 basis_of(const Vec2& d) {
  Vec6 b;
  b << 1.0, d.x(), d.y(), d.x() * d.x(), d.x() * d.y(), d.y() * d.y();
  return b;
}

/// Fits the height as a quadratic about a place; nullopt if that fails.
std::optional<Vec6> quadratic(const std::vector<Vec3>& near, const std::vector<double>& weights) {
  Mat6 normal = Mat6::Zero();
  Vec6 right = Vec6::Zero();
  for (std::size_t i = 0; i < near.size(); ++i) {
    const Vec6 b = basis_of(near[i].head<2>());
    normal += weights[i] * b * b.transpose();
    right += weights[i] * near[i].z() * b;
  }
  // Points on one or two lines do not determine the curvature: a weak pull to flatness does.
  normal.diagonal().tail<3>().array() += 1e-6 * normal(0, 0);
  const Eigen::LDLT<Mat6> solver(normal);
  const Vec6 result = solver.solve(right);
  if (solver.info() != Eigen::Success || !result.allFinite()) return std::nullopt;
  return result;
}

/// Returns the widest angle about the place, rad, in which no point lies.
double widest_empty_angle(const std::vector<Vec3>& near) {
  std::vector<double> angles;
  for (const Vec3& p : near) {
    if (p.head<2>().norm() > 1e-9) angles.push_back(std::atan2(p.y(), p.x()));
  }
  if (angles.empty()) return 2.0 * std::numbers::pi;
  std::sort(angles.begin(), angles.end());
  double widest = angles.front() + 2.0 * std::numbers::pi - angles.back();
  for (std::size_t i = 0; i + 1 < angles.size(); ++i) widest = std::max(widest, angles[i + 1] - angles[i]);
  return widest;
}

Points seen_in(const ViewFrame& frame, std::span<const Vec3> points) {
  INCISE_REQUIRE(points.size() >= kLeastPoints,
                 fmt::format("expected a cloud of at least {} points, found {}", kLeastPoints, points.size()));
  Points in_view;
  Eigen::AlignedBox2d box;
  for (std::size_t i = 0; i < points.size(); ++i) {
    INCISE_REQUIRE(points[i].allFinite(),
                   fmt::format("expected finite points, found point {} with a coordinate that is not a number", i));
    in_view.push_back(frame.to_view(points[i]));
    box.extend(in_view.back().head<2>());
  }
  constexpr double kWidestMm = 5000.0;
  INCISE_REQUIRE(box.sizes().maxCoeff() < kWidestMm,
                 fmt::format("expected a cloud of millimetres, found one {:.4g} x {:.4g} mm wide", box.sizes().x(),
                             box.sizes().y()));
  return in_view;
}

Points flattened(Points points) {
  for (Vec3& p : points) p.z() = 0.0;
  return points;
}

}  // namespace

CloudSurface::CloudSurface(std::span<const Vec3> points, const Vec3& approach, const CloudSurfaceSettings& settings)
    : frame_(view_along(approach)),
      settings_(settings),
      in_view_(seen_in(frame_, points)),
      in_picture_(flattened(in_view_)) {
  INCISE_REQUIRE(
      settings.radius_mm > 0.0 && settings.max_reach_mm >= settings.radius_mm && std::isfinite(settings.max_reach_mm),
      fmt::format("expected 0 < radius_mm <= max_reach_mm, found {} and {}", settings.radius_mm,
                  settings.max_reach_mm));
}

std::optional<CloudPlace> CloudSurface::at(const Vec2& place) const {
  const Vec3 flat(place.x(), place.y(), 0.0);
  double radius = settings_.radius_mm;
  std::vector<Neighbour> found = in_picture_.within(flat, radius);
  while (found.size() < kLeastPoints && radius < settings_.max_reach_mm) {
    radius = std::min(2.0 * radius, settings_.max_reach_mm);
    found = in_picture_.within(flat, radius);
  }
  if (found.size() < kLeastPoints) return std::nullopt;
  const Vec3 origin(place.x(), place.y(), in_view_[found.front().index].z());
  std::vector<Vec3> near;
  std::vector<double> weights;
  CloudPlace result;
  result.gap_mm = std::numeric_limits<double>::infinity();
  for (const Neighbour& neighbour : found) {
    near.push_back(in_view_[neighbour.index] - origin);
    const double distance = near.back().head<2>().norm();
    result.gap_mm = std::min(result.gap_mm, distance);
    weights.push_back(std::pow(1.0 - std::pow(distance / radius, 2), 2) + 1e-3);
  }
  std::optional<Vec6> height = quadratic(near, weights);
  if (!height) return std::nullopt;
  double square = 0.0;
  for (const Vec3& p : near) square += std::pow(p.z() - height->dot(basis_of(p.head<2>())), 2);
  const double deviation = std::sqrt(square / static_cast<double>(near.size()));
  std::vector<double> kept = weights;
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (std::abs(near[i].z() - height->dot(basis_of(near[i].head<2>()))) > 3.0 * deviation) kept[i] = 0.0;
  }
  if (const std::optional<Vec6> again = quadratic(near, kept)) height = again;
  result.position_mm = frame_.from_view(Vec3(place.x(), place.y(), (*height)(0) + origin.z()));
  result.normal = frame_.from_view(Vec3(-(*height)(1), -(*height)(2), 1.0).normalized());
  constexpr double kEmptySide = 0.9 * std::numbers::pi;
  // At the border of a hole, one side is empty nearby but not farther away: a gap, not the rim.
  if (widest_empty_angle(near) > kEmptySide) {
    near.clear();
    for (const Neighbour& neighbour : in_picture_.within(flat, settings_.max_reach_mm))
      near.push_back(in_view_[neighbour.index] - flat);
    result.is_extrapolated = widest_empty_angle(near) > kEmptySide;
  }
  return result;
}

TriMesh CloudSurface::body(const Vec2& low, const Vec2& high, double step_mm, double max_gap_mm,
                           double depth_mm) const {
  INCISE_REQUIRE(step_mm > 0.0 && depth_mm > 0.0 && (high - low).minCoeff() > 0.0,
                 "expected a box, a step and a depth above 0");
  constexpr double kMostCells = 4e6;
  const Vec2 cells = (high - low) / step_mm;
  INCISE_REQUIRE(cells.prod() < kMostCells,
                 fmt::format("expected at most {:.0e} cells, found {:.2e}", kMostCells, cells.prod()));
  const int nx = static_cast<int>(std::ceil(cells.x())) + 1;
  const int ny = static_cast<int>(std::ceil(cells.y())) + 1;
  TriMesh mesh;
  std::vector<int> top(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny), -1);
  const auto corner = [&](int i, int j) -> int& {
    return top[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i)];
  };
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const std::optional<CloudPlace> place = at(low + step_mm * Vec2(i, j));
      if (!place || place->gap_mm > max_gap_mm || place->is_extrapolated) continue;
      corner(i, j) = static_cast<int>(mesh.vertices.size());
      mesh.vertices.push_back(place->position_mm);
      mesh.vertices.push_back(place->position_mm + depth_mm * approach());  // each bottom corner follows its top corner
    }
  }
  const auto has_cell = [&](int i, int j) {
    return i >= 0 && j >= 0 && i + 1 < nx && j + 1 < ny && corner(i, j) >= 0 && corner(i + 1, j) >= 0 &&
           corner(i, j + 1) >= 0 && corner(i + 1, j + 1) >= 0;
  };
  const auto add = [&](int a, int b, int c) {
    mesh.triangles.push_back({VertexId(static_cast<std::size_t>(a)), VertexId(static_cast<std::size_t>(b)),
                              VertexId(static_cast<std::size_t>(c))});
  };
  // A wall under the edge from a to b, with the body on its left: top corners a, b; bottom corners a + 1, b + 1.
  const auto add_wall = [&](int a, int b) {
    add(a, a + 1, b);
    add(b, a + 1, b + 1);
  };
  for (int j = 0; j + 1 < ny; ++j) {
    for (int i = 0; i + 1 < nx; ++i) {
      if (!has_cell(i, j)) continue;
      const int a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1), d = corner(i, j + 1);
      add(a, b, c);
      add(a, c, d);
      add(a + 1, c + 1, b + 1);
      add(a + 1, d + 1, c + 1);
      if (!has_cell(i, j - 1)) add_wall(a, b);
      if (!has_cell(i + 1, j)) add_wall(b, c);
      if (!has_cell(i, j + 1)) add_wall(c, d);
      if (!has_cell(i - 1, j)) add_wall(d, a);
    }
  }
  if (mesh.triangles.empty()) return {};
  return mesh;
}

}  // namespace incise
