#include "registration/levels.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace incise {
namespace {

constexpr double kCoarsest = 0.5;   // largest cubes, in radii
constexpr double kLeastGain = 0.7;  // clusters per point above which a level is not worthwhile
constexpr int kMostLevels = 12;

WeightedPoints clusters_of(std::span<const Vec3> points, const Vec3& low, double cell) {
  std::vector<std::pair<std::array<std::int64_t, 3>, std::uint32_t>> places;
  places.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 q = ((points[i] - low) / cell).array().floor();
    places.push_back(
        {{static_cast<std::int64_t>(q.z()), static_cast<std::int64_t>(q.y()), static_cast<std::int64_t>(q.x())},
         static_cast<std::uint32_t>(i)});
  }
  std::sort(places.begin(), places.end());
  WeightedPoints level;
  level.cell = cell;
  for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end) {
    Vec3 sum = Vec3::Zero();
    for (end = begin; end < places.size() && places[end].first == places[begin].first; ++end)
      sum += points[places[end].second];
    const auto count = static_cast<double>(end - begin);
    level.points.emplace_back(sum / count);
    level.weights.push_back(count);
  }
  return level;
}

}  // namespace

std::vector<WeightedPoints> levels_of(std::span<const Vec3> points) {
  std::vector<WeightedPoints> levels;
  const double radius = measure_of(points).radius;
  Box3 box;
  for (const Vec3& p : points) box.extend(p);
  double cell = kCoarsest * radius;
  for (int k = 0; k < kMostLevels && cell > 0.0; ++k, cell *= 0.5) {
    WeightedPoints level = clusters_of(points, box.min(), cell);
    if (static_cast<double>(level.points.size()) > kLeastGain * static_cast<double>(points.size())) break;
    levels.push_back(std::move(level));
  }
  levels.push_back({Points(points.begin(), points.end()), std::vector<double>(points.size(), 1.0), 0.0});
  return levels;
}

const WeightedPoints& level_for(const std::vector<WeightedPoints>& levels, double sigma) {
  for (const WeightedPoints& level : levels) {
    if (level.cell <= 0.5 * sigma) return level;
  }
  return levels.back();
}

Measure measure_of(std::span<const Vec3> points) {
  Measure measure;
  const auto n = static_cast<double>(points.size());
  for (const Vec3& p : points) measure.center += p;
  measure.center /= n;
  Mat3 scatter = Mat3::Zero();
  for (const Vec3& p : points) scatter += (p - measure.center) * (p - measure.center).transpose();
  measure.variances =
      Eigen::SelfAdjointEigenSolver<Mat3>(scatter / n, Eigen::EigenvaluesOnly).eigenvalues().cwiseMax(0.0);
  measure.radius = std::sqrt(measure.variances.sum());
  return measure;
}

Points normalised(std::span<const Vec3> points, const Vec3& center, double length) {
  Points result;
  result.reserve(points.size());
  for (const Vec3& p : points) result.emplace_back((p - center) / length);
  return result;
}

bool is_line(const Vec3& variances) {
  constexpr double kThin = 1e-12;  // of the largest variance: a millionth in length
  return !(variances[2] > 0.0) || variances[1] < kThin * variances[2];
}

void require_usable(std::span<const Vec3> points, const char* name) {
  INCISE_REQUIRE(!points.empty(), fmt::format("{}: expected at least 1 point, found none", name));
  for (std::size_t i = 0; i < points.size(); ++i) {
    INCISE_REQUIRE(points[i].allFinite(), fmt::format("{}: point {} is not finite", name, i));
  }
}

Points spread_centers(const Points& points, double spacing, std::size_t most) {
  Points centers{points.front()};
  std::vector<double> squared(points.size(), std::numeric_limits<double>::infinity());
  while (centers.size() < std::min(most, points.size())) {
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      squared[i] = std::min(squared[i], (points[i] - centers.back()).squaredNorm());
      if (squared[i] > squared[farthest]) farthest = i;
    }
    if (squared[farthest] < spacing * spacing) break;
    centers.push_back(points[farthest]);
  }
  return centers;
}

Eigen::MatrixXd gaussians(const Points& points, const Points& centers, double width) {
  Eigen::MatrixXd basis(static_cast<Eigen::Index>(points.size()), static_cast<Eigen::Index>(centers.size()));
  for (Eigen::Index c = 0; c < basis.cols(); ++c) {
    for (Eigen::Index i = 0; i < basis.rows(); ++i) {
      const double squared = (points[static_cast<std::size_t>(i)] - centers[static_cast<std::size_t>(c)]).squaredNorm();
      basis(i, c) = std::exp(-0.5 * squared / (width * width));
    }
  }
  return basis;
}

}  // namespace incise
