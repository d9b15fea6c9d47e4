#pragma once

#include <incise/core/random.hpp>
#include <incise/geometry/point_cloud.hpp>
#include <incise/registration/similarity.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace incise::testing {

/// Rows of two or three numbers, with commas or blanks between them; two: z = 0.
inline Points read_rows(const std::filesystem::path& path) {
  std::ifstream in(path);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  Points points;
  for (std::string line; std::getline(in, line);) {
    for (char& c : line) c = c == ',' ? ' ' : c;
    std::istringstream numbers(line);
    Vec3 p = Vec3::Zero();
    if (!(numbers >> p.x() >> p.y())) continue;
    if (!(numbers >> p.z())) p.z() = 0.0;
    points.push_back(p);
  }
  return points;
}

/// Height, mm, of the hill below.
inline double hill_height(double u, double v) {
  return 14.0 * std::exp(-(u * u / 500.0 + v * v / 220.0)) +
         5.0 * std::exp(-((u - 14.0) * (u - 14.0) / 60.0 + (v - 7.0) * (v - 7.0) / 25.0)) + 0.04 * u;
}

/// A hill with a ridge to one side, 60 x 40 mm, without symmetry: `count` points at random, with outward normals (+z).
inline PointCloud hill(std::size_t count, Random& random, double noise_mm = 0.0) {
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.uniform(-30.0, 30.0);
    const double y = random.uniform(-20.0, 20.0);
    constexpr double kStep = 1e-5;
    const double dx = (hill_height(x + kStep, y) - hill_height(x - kStep, y)) / (2.0 * kStep);
    const double dy = (hill_height(x, y + kStep) - hill_height(x, y - kStep)) / (2.0 * kStep);
    cloud.points.emplace_back(x, y, hill_height(x, y));
    cloud.normals.push_back(Vec3(-dx, -dy, 1.0).normalized());
    cloud.points.back() += noise_mm * Vec3(random.normal(), random.normal(), random.normal());
  }
  return cloud;
}

inline PointCloud moved_cloud(const Similarity& t, PointCloud cloud) {
  cloud.points = moved(t, cloud.points);
  for (Vec3& n : cloud.normals) n = t.rotation * n;
  return cloud;
}

}  // namespace incise::testing
