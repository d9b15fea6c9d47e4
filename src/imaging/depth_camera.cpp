#include <incise/core/error.hpp>
#include <incise/core/median.hpp>
#include <incise/imaging/depth_camera.hpp>

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace incise {
namespace {

/// Returns where lens distortion moves (x, y) of a direction (x, y, 1).
Vec2 distorted(const CameraIntrinsics& camera, const Vec2& p) {
  const auto [k1, k2, p1, p2, k3] = camera.distortion;
  const double r2 = p.squaredNorm();
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {p.x() * radial + 2.0 * p1 * p.x() * p.y() + p2 * (r2 + 2.0 * p.x() * p.x()),
          p.y() * radial + p1 * (r2 + 2.0 * p.y() * p.y()) + 2.0 * p2 * p.x() * p.y()};
}

void require_sound(const CameraIntrinsics& camera, const char* which) {
  const bool is_finite =
      std::isfinite(camera.fx + camera.fy + camera.cx + camera.cy) &&
      std::all_of(camera.distortion.begin(), camera.distortion.end(), [](double k) { return std::isfinite(k); });
  INCISE_REQUIRE(is_finite && camera.fx > 0.0 && camera.fy > 0.0 && camera.width > 0 && camera.height > 0,
                 fmt::format("expected a {} camera with a size and focal lengths above 0, found {} x {}, fx {}, fy {}",
                             which, camera.width, camera.height, camera.fx, camera.fy));
}

struct Near {
  Vec2 offset;
  Vec3 point;
};

std::vector<Near> points_around(const OrganizedCloud& cloud, const Vec2& pixel, int window_px) {
  std::vector<Near> near;
  const int u0 = static_cast<int>(std::lround(pixel.x())), v0 = static_cast<int>(std::lround(pixel.y()));
  for (int v = std::max(0, v0 - window_px); v <= std::min(cloud.height - 1, v0 + window_px); ++v) {
    for (int u = std::max(0, u0 - window_px); u <= std::min(cloud.width - 1, u0 + window_px); ++u) {
      if (cloud.is_measured[cloud.index(u, v)] != 0)
        near.push_back({Vec2(u, v) - pixel, cloud.points[cloud.index(u, v)]});
    }
  }
  return near;
}

/// Drops flying pixels: points between a near and a far surface that belong to neither.
void drop_outliers(std::vector<Near>& near) {
  constexpr double kLeastToleranceMm = 0.2;
  std::vector<double> depths;
  for (const Near& n : near) depths.push_back(n.point.z());
  const double middle = median(depths);
  for (double& z : depths) z = std::abs(z - middle);
  const double spread = 1.4826 * median(depths);
  std::erase_if(near, [&](const Near& n) { return std::abs(n.point.z() - middle) > 3.0 * spread + kLeastToleranceMm; });
}

}  // namespace

Vec3 ray_through(const CameraIntrinsics& camera, const Vec2& pixel) {
  const Vec2 seen((pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy);
  Vec2 p = seen;
  for (int i = 0; i < 50; ++i) {
    const Vec2 rest = seen - distorted(camera, p);
    p += rest;
    if (rest.norm() < 1e-12) return p.homogeneous();
  }
  INCISE_REQUIRE((seen - distorted(camera, p)).norm() < 1e-6,
                 fmt::format("the distortion cannot be undone at pixel ({:.1f}, {:.1f})", pixel.x(), pixel.y()));
  return p.homogeneous();
}

Vec2 pixel_of(const CameraIntrinsics& camera, const Vec3& p) {
  INCISE_REQUIRE(p.z() > 0.0, "expected a point in front of the camera");
  const Vec2 q = distorted(camera, p.hnormalized());
  return {camera.cx + camera.fx * q.x(), camera.cy + camera.fy * q.y()};
}

std::size_t OrganizedCloud::measured() const {
  return static_cast<std::size_t>(std::count(is_measured.begin(), is_measured.end(), 1));
}

OrganizedCloud cloud_seen_in_color(const DepthPicture& depth, const DepthCamera& camera) {
  require_sound(camera.color, "colour");
  require_sound(camera.depth, "depth");
  INCISE_REQUIRE(depth.width == camera.depth.width && depth.height == camera.depth.height,
                 fmt::format("expected a depth picture of {} x {} pixels, found {} x {}", camera.depth.width,
                             camera.depth.height, depth.width, depth.height));
  INCISE_REQUIRE(camera.depth_unit_mm > 0.0 && std::isfinite(camera.depth_unit_mm),
                 fmt::format("expected a depth unit above 0 mm, found {}", camera.depth_unit_mm));
  OrganizedCloud cloud{camera.color.width, camera.color.height, {}, {}};
  const auto count = static_cast<std::size_t>(cloud.width) * static_cast<std::size_t>(cloud.height);
  cloud.points.assign(count, Vec3::Zero());
  cloud.is_measured.assign(count, 0);
  const Mat3 R = camera.T_color_depth.topLeftCorner<3, 3>();
  const Vec3 t = camera.T_color_depth.topRightCorner<3, 1>();
  for (int v = 0; v < depth.height; ++v) {
    for (int u = 0; u < depth.width; ++u) {
      const std::uint16_t counts = depth.counts[static_cast<std::size_t>(v) * static_cast<std::size_t>(depth.width) +
                                                static_cast<std::size_t>(u)];
      if (counts == 0) continue;
      const Vec3 p = R * (counts * camera.depth_unit_mm * ray_through(camera.depth, {u, v})) + t;
      if (!(p.z() > 0.0)) continue;
      const Vec2 seen = pixel_of(camera.color, p);
      if (!(seen.x() > -0.5 && seen.y() > -0.5 && seen.x() < cloud.width - 0.5 && seen.y() < cloud.height - 0.5))
        continue;
      const std::size_t k =
          cloud.index(static_cast<int>(std::lround(seen.x())), static_cast<int>(std::lround(seen.y())));
      if (cloud.is_measured[k] != 0 && cloud.points[k].z() <= p.z()) continue;
      cloud.points[k] = p;
      cloud.is_measured[k] = 1;
    }
  }
  return cloud;
}

void require_camera_frame(const OrganizedCloud& cloud, const std::filesystem::path& name) {
  constexpr const char* kHint = "Is the cloud in the camera's frame: x to the right, y down, z forward, mm?";
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (cloud.is_measured[i] == 0 || cloud.points[i].z() > 0.0) continue;
    throw DataError(name,
                    fmt::format("pixel ({}, {})", i % static_cast<std::size_t>(cloud.width),
                                i / static_cast<std::size_t>(cloud.width)),
                    fmt::format("a point behind the camera, z {:.4g} mm", cloud.points[i].z()),
                    "points in front of the camera, z above 0", kHint);
  }
  // Seen from the camera, the right neighbour lies to the same side of the lower one everywhere, except at edges that
  // hide something.
  std::size_t as_seen = 0, mirrored = 0;
  for (int v = 0; v + 1 < cloud.height; ++v) {
    for (int u = 0; u + 1 < cloud.width; ++u) {
      const std::size_t here = cloud.index(u, v), right = cloud.index(u + 1, v), below = cloud.index(u, v + 1);
      if (cloud.is_measured[here] == 0 || cloud.is_measured[right] == 0 || cloud.is_measured[below] == 0) continue;
      const Vec2 place = cloud.points[here].hnormalized();
      const Vec2 along = cloud.points[right].hnormalized() - place, down = cloud.points[below].hnormalized() - place;
      const double turn = along.x() * down.y() - along.y() * down.x();
      as_seen += turn > 0.0 ? 1 : 0;
      mirrored += turn < 0.0 ? 1 : 0;  // neither where coordinates were rounded to the same place
    }
  }
  if (mirrored > as_seen) {
    throw DataError(name, "vertices",
                    fmt::format("mirrored columns and rows at {} of {} places", mirrored, mirrored + as_seen),
                    "columns to the right and rows downwards, as the camera sees them", kHint);
  }
}

std::optional<Vec3> position_at(const OrganizedCloud& cloud, const Vec2& pixel, int window_px) {
  constexpr double kLeastShare = 0.4;
  INCISE_REQUIRE(window_px >= 1, fmt::format("expected a window of 1 pixel or more, found {}", window_px));
  std::vector<Near> near = points_around(cloud, pixel, window_px);
  const double whole = std::pow(2.0 * window_px + 1.0, 2);
  if (static_cast<double>(near.size()) < kLeastShare * whole) return std::nullopt;
  drop_outliers(near);
  if (static_cast<double>(near.size()) < 0.75 * kLeastShare * whole) return std::nullopt;
  Mat3 normal = Mat3::Zero(), right = Mat3::Zero();
  for (const Near& n : near) {
    const Vec3 basis(1.0, n.offset.x(), n.offset.y());
    normal += basis * basis.transpose();
    right += basis * n.point.transpose();
  }
  // A large mean offset means that only one side of the pixel was measured.
  if (Vec2(normal(0, 1), normal(0, 2)).norm() / normal(0, 0) > 0.6 * window_px) return std::nullopt;
  const Mat3 solution = normal.ldlt().solve(right);
  if (!solution.allFinite()) return std::nullopt;
  return solution.row(0).transpose();
}

LiftedLine lift_to_space(const std::vector<Vec2>& points_px, bool is_closed, const OrganizedCloud& cloud,
                         const LiftSettings& settings, const std::filesystem::path& name) {
  const std::size_t n = points_px.size();
  INCISE_REQUIRE(n >= 2, "expected a line of at least 2 points");
  INCISE_REQUIRE(settings.max_hole_mm >= 0.0,
                 fmt::format("expected max_hole_mm of 0 or more, found {}", settings.max_hole_mm));
  std::vector<std::optional<Vec3>> found;
  for (const Vec2& p : points_px) found.push_back(position_at(cloud, p, settings.window_px));
  const auto refuse = [&](std::size_t i, const std::string& size) {
    throw DataError(name, fmt::format("pixel ({:.0f}, {:.0f})", points_px[i].x(), points_px[i].y()),
                    fmt::format("a hole in the depth under the mark, {}", size),
                    fmt::format("at most {} mm without depth", settings.max_hole_mm),
                    "Wet spots hide depth: dry the surface or turn the camera, or allow more with --max-hole-mm.");
  };
  const auto first = static_cast<std::size_t>(
      std::find_if(found.begin(), found.end(), [](const auto& p) { return p.has_value(); }) - found.begin());
  if (first == n) refuse(0, "all along it");
  if (!is_closed && first > 0) refuse(0, "at its end");
  LiftedLine line{{.points = Points(n), .is_closed = is_closed}, 0, 0.0};
  line.contour.points[first] = *found[first];
  std::size_t previous = first;
  for (std::size_t k = 1; k <= (is_closed ? n : n - 1 - first); ++k) {
    const std::size_t i = (first + k) % n;
    if (!found[i]) {
      if (!is_closed && i + 1 == n) refuse(i, "at its end");
      continue;
    }
    const std::size_t run = (i + n - previous - 1) % n + 1;
    const double span = run == n ? 0.0 : (*found[i] - *found[previous]).norm();
    if (run == n && n > 1) refuse(previous, "all along it");
    if (run > 1) {
      if (span > settings.max_hole_mm) refuse((previous + run / 2) % n, fmt::format("{:.2f} mm wide", span));
      line.max_hole_mm = std::max(line.max_hole_mm, span);
      line.bridged_points += run - 1;
    }
    for (std::size_t j = 1; j <= run; ++j) {
      const double share = static_cast<double>(j) / static_cast<double>(run);
      line.contour.points[(previous + j) % n] = (1.0 - share) * *found[previous] + share * *found[i];
    }
    previous = i;
  }
  return line;
}

}  // namespace incise
