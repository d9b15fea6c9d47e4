#include "steps/cloud_input.hpp"

#include <incise/core/error.hpp>
#include <incise/io/surface_io.hpp>

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace incise::steps {

PointCloud read_points(const std::filesystem::path& path, std::size_t fewest) {
  PointCloud cloud = cloud_of(read_cloud(path));
  if (cloud.points.size() < fewest) {
    throw DataError(path, "points", fmt::format("{}", cloud.points.size()),
                    fmt::format("at least {} points of a surface", fewest));
  }
  return cloud;
}

void require_extent(const Points& points, const std::filesystem::path& path) {
  constexpr double kFarthestMm = 1e9, kWidestMm = 1e5;
  Box3 box;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].cwiseAbs().maxCoeff() > kFarthestMm) {
      throw DataError(path, fmt::format("point {}", i),
                      fmt::format("a coordinate of {:.3g}", points[i].cwiseAbs().maxCoeff()),
                      fmt::format("at most {:.0e} mm", kFarthestMm));
    }
    box.extend(points[i]);
  }
  if (points.empty()) return;  // reported where points are counted
  if (box.sizes().maxCoeff() > kWidestMm) {
    throw DataError(path, "points", fmt::format("a cloud {:.4g} wide", box.sizes().maxCoeff()),
                    fmt::format("at most {:.0f} mm of tissue", kWidestMm), "Is the unit mm?");
  }
}

void require_surface(const Points& points, const std::filesystem::path& path) {
  constexpr double kLeastShare = 1e-3;  // of the width: narrower is a line
  require_extent(points, path);
  if (points.empty()) return;
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : points) mean += p / static_cast<double>(points.size());
  Mat3 scatter = Mat3::Zero();
  for (const Vec3& p : points) scatter += (p - mean) * (p - mean).transpose() / static_cast<double>(points.size());
  const Vec3 spread_mm =
      Eigen::SelfAdjointEigenSolver<Mat3>(scatter).eigenvalues().cwiseMax(0.0).cwiseSqrt();  // ascending
  const double tiny_mm = 1e-9 * std::max(1.0, mean.norm());
  const char* expected = "points that extend in two directions, as those of a surface";
  if (spread_mm[2] <= tiny_mm)
    throw DataError(path, "points", fmt::format("all {} in one place", points.size()), expected);
  if (spread_mm[1] <= std::max(kLeastShare * spread_mm[2], tiny_mm))
    throw DataError(path, "points", fmt::format("all {} on a line", points.size()), expected);
}

}  // namespace incise::steps
