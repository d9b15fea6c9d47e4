#include "report/line_kinds.hpp"

#include "report/snapshot.hpp"

#include <incise/core/error.hpp>
#include <incise/io/picture_io.hpp>
#include <incise/report/html_report.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

constexpr int kSupersampling = 2;  ///< along each side; edges are smooth then
const Vec3 kBackground(0.965, 0.965, 0.955);

Vec3 rgb_of(std::string_view hex) {
  const auto part = [&](std::size_t at) { return std::stoi(std::string(hex.substr(at, 2)), nullptr, 16) / 255.0; };
  return {part(1), part(3), part(5)};
}

/// The observer's axes: x right, y up, z towards the observer, who stands obliquely above the picture along the
/// approach.
Mat3 oblique_view(const Vec3& approach) {
  const ViewFrame top = view_along(approach);
  const double azimuth = -0.6;
  const double elevation = 0.75;
  const Vec3 across = std::cos(azimuth) * top.x + std::sin(azimuth) * top.y;
  const Vec3 away = -std::sin(azimuth) * top.x + std::cos(azimuth) * top.y;
  Mat3 rows;
  rows.row(0) = across;
  rows.row(1) = std::sin(elevation) * away + std::cos(elevation) * top.z;
  rows.row(2) = -std::cos(elevation) * away + std::sin(elevation) * top.z;
  return rows;
}

/// A picture with a depth for each element.
class Canvas {
 public:
  Canvas(int width, int height)
      : width_(width),
        height_(height),
        color_(count(), kBackground),
        depth_(count(), -std::numeric_limits<double>::infinity()) {}

  /// Corners in elements and depth towards the observer.
  void triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& color) {
    const double area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    if (std::abs(area) < 1e-12) return;
    const Vec3 low = a.cwiseMin(b).cwiseMin(c);
    const Vec3 high = a.cwiseMax(b).cwiseMax(c);
    for (int y = std::max(0, static_cast<int>(low.y())); y <= std::min(height_ - 1, static_cast<int>(high.y())); ++y) {
      for (int x = std::max(0, static_cast<int>(low.x())); x <= std::min(width_ - 1, static_cast<int>(high.x())); ++x) {
        const Vec2 p(x + 0.5, y + 0.5);
        const double u = ((p.x() - a.x()) * (c.y() - a.y()) - (p.y() - a.y()) * (c.x() - a.x())) / area;
        const double v = ((b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x())) / area;
        if (u < 0.0 || v < 0.0 || u + v > 1.0) continue;
        put(x, y, a.z() + u * (b.z() - a.z()) + v * (c.z() - a.z()), color);
      }
    }
  }

  /// A round stroke, drawn a little towards the observer so that it lies on a surface and not in it.
  void stroke(const Vec3& a, const Vec3& b, double radius, double lift, const Vec3& color) {
    const int steps = std::max(1, static_cast<int>(std::ceil((b - a).head<2>().norm())));
    for (int k = 0; k <= steps; ++k) {
      const Vec3 p = a + (b - a) * (static_cast<double>(k) / steps);
      for (int y = static_cast<int>(p.y() - radius); y <= static_cast<int>(p.y() + radius); ++y) {
        for (int x = static_cast<int>(p.x() - radius); x <= static_cast<int>(p.x() + radius); ++x) {
          const bool is_inside = std::hypot(x + 0.5 - p.x(), y + 0.5 - p.y()) <= radius;
          if (is_inside && x >= 0 && y >= 0 && x < width_ && y < height_) put(x, y, p.z() + lift, color);
        }
      }
    }
  }

  /// Averaged over blocks of kSupersampling elements.
  [[nodiscard]] std::string png() const {
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < height_; y += kSupersampling) {
      for (int x = 0; x < width_; x += kSupersampling) {
        Vec3 sum = Vec3::Zero();
        for (int k = 0; k < kSupersampling * kSupersampling; ++k) {
          sum += color_[at(x + k % kSupersampling, y + k / kSupersampling)];
        }
        sum *= 255.0 / (kSupersampling * kSupersampling);
        for (int c = 0; c < 3; ++c) pixels.push_back(static_cast<std::uint8_t>(std::lround(sum[c])));
      }
    }
    return encode_png(pixels, width_ / kSupersampling, height_ / kSupersampling, 3);
  }

 private:
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  }
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  void put(int x, int y, double depth, const Vec3& color) {
    if (depth <= depth_[at(x, y)]) return;
    depth_[at(x, y)] = depth;
    color_[at(x, y)] = color;
  }

  int width_, height_;
  std::vector<Vec3> color_;
  std::vector<double> depth_;
};

/// How a frame lies in its picture.
struct Projection {
  Mat3 view;
  Vec3 center = Vec3::Zero();  ///< of what is shown, in the view
  double scale = 1.0;          ///< px per mm
};

Projection projection_of(const ReportAnimation& animation, std::size_t frame, const Vec3& approach, int width_px, int height_px) {
  INCISE_REQUIRE(frame < animation.frames.size(),
                 fmt::format("expected a frame below {}, found {}", animation.frames.size(), frame));
  INCISE_REQUIRE(width_px >= 16 && height_px >= 16, "expected a picture of at least 16 by 16");
  const ReportFrame& moment = animation.frames[frame];
  Projection projection;
  projection.view = oblique_view(approach);
  const Mat3& view = projection.view;
  Box3 box;
  for (const Triangle& t : moment.skin) {
    for (const VertexId id : t) box.extend(Vec3(view * vertex(moment.positions_mm, id)));
  }
  for (const ReportLine& line : animation.lines) {
    for (const Vec3& p : line.contour.points) box.extend(Vec3(view * p));
  }
  if (moment.tool_tip_mm) {
    box.extend(Vec3(view * *moment.tool_tip_mm));
    box.extend(Vec3(view * (*moment.tool_tip_mm - animation.tool_length_mm * moment.tool_axis)));
  }
  INCISE_REQUIRE(!box.isEmpty(), "expected a frame with a skin or with lines");
  const Vec3 extent = box.sizes().cwiseMax(1.0);
  projection.scale = 0.92 * std::min(width_px / extent.x(), height_px / extent.y());
  projection.center = box.center();
  return projection;
}

}  // namespace

double frame_px_per_mm(const ReportAnimation& animation, std::size_t frame, const Vec3& approach, int width_px, int height_px) {
  return projection_of(animation, frame, approach, width_px, height_px).scale;
}

std::string frame_png(const ReportAnimation& animation, std::size_t frame, const Vec3& approach, int width_px,
                      int height_px) {
  const Projection projection = projection_of(animation, frame, approach, width_px, height_px);
  const Mat3& view = projection.view;
  const double scale = kSupersampling * projection.scale;
  const ReportFrame& moment = animation.frames[frame];
  const Vec3 tool = animation.tool_length_mm * moment.tool_axis;
  const int width = width_px * kSupersampling;
  const int height = height_px * kSupersampling;
  const auto project = [&](const Vec3& p) {
    const Vec3 q = view * p - projection.center;
    return Vec3(0.5 * width + scale * q.x(), 0.5 * height - scale * q.y(), scale * q.z());
  };

  Canvas canvas(width, height);
  for (std::size_t k = 0; k < moment.skin.size(); ++k) {
    const Vec3& a = vertex(moment.positions_mm, moment.skin[k][0]);
    const Vec3& b = vertex(moment.positions_mm, moment.skin[k][1]);
    const Vec3& c = vertex(moment.positions_mm, moment.skin[k][2]);
    const Vec3 normal = view * (b - a).cross(c - a).normalized();
    const double light = 0.45 + 0.55 * std::max(0.0, normal.dot(Vec3(-0.35, 0.45, 0.82)));
    canvas.triangle(project(a), project(b), project(c), light * (moment.is_kerf[k] != 0 ? still::kKerf : still::kTissue));
  }
  for (const ReportLine& line : animation.lines) {
    const std::size_t n = line.contour.points.size();
    for (std::size_t i = 0; n >= 2 && i + (line.contour.is_closed ? 0 : 1) < n; ++i) {
      canvas.stroke(project(line.contour.points[i]), project(line.contour.points[(i + 1) % n]), 1.6 * kSupersampling,
                    1.5 * scale, rgb_of(look_of(line.kind).color));
    }
  }
  if (moment.tool_tip_mm) {
    canvas.stroke(project(*moment.tool_tip_mm), project(*moment.tool_tip_mm - tool),
                  0.5 * scale * animation.tool_diameter_mm, 0.0, still::kSteel);
  }
  return canvas.png();
}

}  // namespace incise
