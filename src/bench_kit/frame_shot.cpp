#include "bench_kit/drawn_line.hpp"
#include "bench_kit/tissue_colors.hpp"

#include <incise/bench_kit/pictures.hpp>
#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

constexpr std::uint64_t kNoiseStream = 0x165667b1ULL;
constexpr double kMarkMm = 1.0;          // width of the felt pen's line
constexpr double kGrazingCosine = 0.25;  // of a ray to the surface's normal; below it the sensor sees nothing
constexpr double kSlowNoiseShare = 0.5;  // share of the depth noise that varies slowly over the picture
constexpr double kColorNoise = 3.0;
constexpr int kCloudStride = 3;  // every third pixel of the depth picture becomes a point

/// The surface that each pixel of a pinhole camera sees: a perspective depth buffer.
struct View {
  std::vector<double> depth_mm;        // along the optical axis; infinite: nothing
  std::vector<std::int32_t> triangle;  // of the surface; -1: none
};

Vec2 pixel_of(const Pinhole& camera, const Vec3& p) {
  return {camera.cx + camera.focal_px * p.x() / p.z(), camera.cy + camera.focal_px * p.y() / p.z()};
}
Vec3 ray_of(const Pinhole& camera, int u, int v) {
  return {(u - camera.cx) / camera.focal_px, (v - camera.cy) / camera.focal_px, 1.0};
}
std::size_t place(const Pinhole& camera, int u, int v) {
  return static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(u);
}

/// Returns the depth at which a pixel's ray meets the triangle's plane, mm.
double depth_on(const std::array<Vec3, 3>& corners, const Vec3& ray) {
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  return normal.dot(corners[0]) / normal.dot(ray);
}

View look(const Pinhole& camera, const std::vector<Triangle>& skin, const Points& seen) {
  View view;
  view.depth_mm.assign(place(camera, 0, camera.height), std::numeric_limits<double>::infinity());
  view.triangle.assign(view.depth_mm.size(), -1);
  for (std::size_t f = 0; f < skin.size(); ++f) {
    std::array<Vec3, 3> corners;
    std::array<Vec2, 3> px;
    for (std::size_t c = 0; c < 3; ++c) {
      corners[c] = seen[skin[f][c].index()];
      px[c] = pixel_of(camera, corners[c]);
    }
    const auto cross = [](const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); };
    const double area = cross(px[1] - px[0], px[2] - px[0]);
    if (std::abs(area) < 1e-12) continue;
    const auto [u0, u1] = std::minmax({px[0].x(), px[1].x(), px[2].x()});
    const auto [v0, v1] = std::minmax({px[0].y(), px[1].y(), px[2].y()});
    for (int v = std::max(0, static_cast<int>(std::ceil(v0))); v <= std::min(camera.height - 1, static_cast<int>(v1));
         ++v) {
      for (int u = std::max(0, static_cast<int>(std::ceil(u0))); u <= std::min(camera.width - 1, static_cast<int>(u1));
           ++u) {
        const Vec2 p(u, v);
        bool is_inside = true;
        for (std::size_t c = 0; c < 3; ++c)
          is_inside = is_inside && cross(px[(c + 1) % 3] - px[c], p - px[c]) / area >= 0.0;
        if (!is_inside) continue;
        const double depth = depth_on(corners, ray_of(camera, u, v));
        const std::size_t n = place(camera, u, v);
        if (depth < view.depth_mm[n]) {
          view.depth_mm[n] = depth;
          view.triangle[n] = static_cast<std::int32_t>(f);
        }
      }
    }
  }
  return view;
}

/// Draws patches without a reading until they cover `percent` of the specimen.
std::vector<std::uint8_t> holes(const Pinhole& camera, const View& view, double percent, Random& random) {
  std::vector<std::uint8_t> is_hole(view.depth_mm.size(), 0);
  std::vector<std::size_t> seen;
  for (std::size_t n = 0; n < view.triangle.size(); ++n)
    if (view.triangle[n] >= 0) seen.push_back(n);
  if (seen.empty()) return is_hole;
  std::size_t gone = 0;
  while (static_cast<double>(gone) < 0.01 * percent * static_cast<double>(seen.size())) {
    const std::size_t n = seen[random.below(seen.size())];
    const int u = static_cast<int>(n % static_cast<std::size_t>(camera.width));
    const int v = static_cast<int>(n / static_cast<std::size_t>(camera.width));
    const int r = 1 + static_cast<int>(random.below(6));
    for (int dv = -r; dv <= r; ++dv) {
      for (int du = -r; du <= r; ++du) {
        if (du * du + dv * dv > r * r || u + du < 0 || v + dv < 0 || u + du >= camera.width || v + dv >= camera.height)
          continue;
        std::uint8_t& flag = is_hole[place(camera, u + du, v + dv)];
        if (flag == 0 && view.triangle[place(camera, u + du, v + dv)] >= 0) ++gone;
        flag = 1;
      }
    }
  }
  return is_hole;
}

}  // namespace

FrameShot shoot_frame(const SeenTissue& tissue, const FrameNoise& asked, const Mat4& T_camera_specimen) {
  INCISE_REQUIRE(asked.hole_percent >= 0.0 && asked.hole_percent <= 100.0,
                 fmt::format("expected hole_percent of 0 to 100, found {}", asked.hole_percent));
  INCISE_REQUIRE(!tissue.tumor_edge.points.empty(), "expected a tumour edge with points, found none");
  FrameShot shot;
  const Pinhole& camera = shot.camera;
  const Mat3 R = T_camera_specimen.topLeftCorner<3, 3>();
  const Vec3 t = T_camera_specimen.topRightCorner<3, 1>();
  Points seen;
  for (const Vec3& p : tissue.vertices) seen.push_back(R * p + t);
  const View view = look(camera, tissue.triangles, seen);

  Random random(asked.seed ^ kNoiseStream);
  const SmoothField slow(60.0, random);  // waves in pixels
  const std::vector<std::uint8_t> is_hole = holes(camera, view, asked.hole_percent, random);
  const TissueGrain grain(asked.seed);
  LineDistance mark(camera.width, camera.height, 4.0);
  std::vector<Vec2> line;
  double mark_depth = 0.0;
  for (const Vec3& p : tissue.tumor_edge.points) {
    const Vec3 q = R * p + t;
    line.push_back(pixel_of(camera, q));
    mark_depth += q.z() / static_cast<double>(tissue.tumor_edge.points.size());
  }
  mark.add(line, true);
  const double half_px = 0.5 * kMarkMm * camera.focal_px / mark_depth;

  const std::size_t count = view.depth_mm.size();
  shot.color = {camera.width, camera.height, std::vector<std::uint8_t>(3 * count)};
  shot.depth = {camera.width, camera.height, std::vector<std::uint16_t>(count, 0)};
  shot.is_specimen.assign(count, 0);
  const Vec3 up = R * Vec3::UnitZ();
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const std::size_t n = place(camera, u, v);
      const Vec3 ray = ray_of(camera, u, v);
      double depth = up.dot(t) / up.dot(ray);  // the platform's plane, z = 0
      double cosine = std::abs(up.dot(ray)) / ray.norm();
      Paint paint = kTablePaint;
      if (view.triangle[n] >= 0) {
        const Triangle& corners = tissue.triangles[static_cast<std::size_t>(view.triangle[n])];
        const Vec3& a = seen[corners[0].index()];
        const Vec3 normal = (seen[corners[1].index()] - a).cross(seen[corners[2].index()] - a).normalized();
        depth = view.depth_mm[n];
        cosine = std::abs(normal.dot(ray)) / ray.norm();
        const Vec3 stretched = R.transpose() * (depth * ray - t);
        paint = kTissuePaint * grain.at(stretched) * (0.55 + 0.45 * cosine);
        shot.is_specimen[n] = 1;
      }
      std::uint8_t* pixel = pixel_at(shot.color, u, v);
      put(pixel, paint + Paint(random.normal(), random.normal(), random.normal()) * kColorNoise);
      if (view.triangle[n] >= 0) lay(pixel, kGreenInk, std::clamp(half_px + 0.5 - mark.at(u, v), 0.0, 1.0));
      const double noise =
          asked.depth_noise_mm * (std::sqrt(1.0 - kSlowNoiseShare * kSlowNoiseShare) * random.normal() +
                                  kSlowNoiseShare * slow.at(Vec3(u, v, 0.0)));
      const double measured = (depth * asked.depth_scale + noise) / shot.depth_unit_mm;
      if (is_hole[n] != 0 || cosine < kGrazingCosine || !(measured > 0.0 && measured < 65535.0)) continue;
      shot.depth.counts[n] = static_cast<std::uint16_t>(std::lround(measured));
    }
  }
  return shot;
}

Points cloud_of(const FrameShot& frame) {
  Points cloud;
  for (int v = 0; v < frame.camera.height; v += kCloudStride) {
    for (int u = 0; u < frame.camera.width; u += kCloudStride) {
      const std::size_t n = place(frame.camera, u, v);
      if (frame.is_specimen[n] == 0 || frame.depth.counts[n] == 0) continue;
      cloud.push_back(frame.depth_unit_mm * frame.depth.counts[n] * ray_of(frame.camera, u, v));
    }
  }
  return cloud;
}

}  // namespace incise
