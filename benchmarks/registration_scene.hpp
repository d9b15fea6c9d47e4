#pragma once

#include <incise/core/random.hpp>
#include <incise/core/units.hpp>
#include <incise/geometry/point_cloud.hpp>
#include <incise/geometry/visible_surface.hpp>
#include <incise/imaging/tongue_shape.hpp>
#include <incise/registration/similarity.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace incise::bench {

/// The upper side of a synthetic tongue as triangles, mm, seen from +z.
inline TriMesh synthetic_tongue(std::uint64_t seed, double pitch_mm = 1.0) {
  Random random(seed);
  const TongueShape shape = draw_tongue_shape({}, random);
  const Box3 box = bounds_mm(shape);
  const int nx = static_cast<int>(box.sizes().x() / pitch_mm) + 2;
  const int ny = static_cast<int>(box.sizes().y() / pitch_mm) + 2;
  TriMesh mesh;
  std::vector<VertexId> at(static_cast<std::size_t>(nx * ny));
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const double x = box.min().x() + pitch_mm * i;
      const double y = box.min().y() + pitch_mm * j;
      if (const auto span = span_at(shape, x, y)) {
        at[static_cast<std::size_t>(i + nx * j)] = VertexId(mesh.vertices.size());
        mesh.vertices.emplace_back(x, y, span->high_mm);
      }
    }
  }
  for (int j = 0; j + 1 < ny; ++j) {
    for (int i = 0; i + 1 < nx; ++i) {
      const auto id = [&](int di, int dj) { return at[static_cast<std::size_t>(i + di + nx * (j + dj))]; };
      if (id(0, 0).is_valid() && id(1, 0).is_valid() && id(1, 1).is_valid())
        mesh.triangles.push_back({id(0, 0), id(1, 0), id(1, 1)});
      if (id(0, 0).is_valid() && id(1, 1).is_valid() && id(0, 1).is_valid())
        mesh.triangles.push_back({id(0, 0), id(1, 1), id(0, 1)});
    }
  }
  return mesh;
}

/// Uniform in the space of rotations (Shoemake 1992).
inline Mat3 random_rotation(Random& random) {
  const double u = random.uniform();
  const double a = random.uniform(0.0, 2.0 * units::kPi);
  const double b = random.uniform(0.0, 2.0 * units::kPi);
  const double s = std::sqrt(1.0 - u);
  const double c = std::sqrt(u);
  return Eigen::Quaterniond(c * std::cos(b), s * std::sin(a), s * std::cos(a), c * std::sin(b)).toRotationMatrix();
}

/// Every so many of an even sample, so that about `count` are left at random.
inline PointCloud drawn(const PointCloud& cloud, std::size_t count, Random& random) {
  std::vector<std::size_t> order(cloud.points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  for (std::size_t i = 0; i + 1 < order.size() && i < count; ++i)
    std::swap(order[i], order[i + random.below(order.size() - i)]);
  order.resize(std::min(count, order.size()));
  return subset(cloud, order);
}

inline void add_noise(PointCloud& cloud, double sd_mm, Random& random) {
  for (Vec3& p : cloud.points) p += sd_mm * Vec3(random.normal(), random.normal(), random.normal());
}

}  // namespace incise::bench
