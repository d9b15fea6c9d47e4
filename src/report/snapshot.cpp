#include "report/snapshot.hpp"

#include "report/line_kinds.hpp"

#include <incise/core/error.hpp>
#include <incise/io/picture_io.hpp>
#include <incise/report/html_report.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
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

struct DrawnTriangle {
  Vec3 a, b, c;  ///< corners in elements, and the depth towards the observer
  std::uint32_t ink = 0;
};

struct DrawnStroke {
  Vec3 a, b;
  double radius = 0.0, lift = 0.0;
  std::uint32_t ink = 0;
};

/// Some rows of a picture, with a depth for each element.
class Band {
 public:
  Band(int width, int first_row, int end_row)
      : width_(width),
        first_(first_row),
        end_(end_row),
        inks_(count(), 0),
        depths_(count(), -std::numeric_limits<double>::infinity()) {}

  void draw(const DrawnTriangle& t) {
    const Vec3 &a = t.a, &b = t.b, &c = t.c;
    const Vec3 low = a.cwiseMin(b).cwiseMin(c);
    const Vec3 high = a.cwiseMax(b).cwiseMax(c);
    const int top = std::max(first_, static_cast<int>(low.y())),
              bottom = std::min(end_ - 1, static_cast<int>(high.y()));
    const double area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    if (std::abs(area) < 1e-12) return;
    for (int y = top; y <= bottom; ++y) {
      for (int x = std::max(0, static_cast<int>(low.x())); x <= std::min(width_ - 1, static_cast<int>(high.x())); ++x) {
        const Vec2 p(x + 0.5, y + 0.5);
        const double u_area = (p.x() - a.x()) * (c.y() - a.y()) - (p.y() - a.y()) * (c.x() - a.x());
        const double v_area = (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
        if (area > 0.0 ? u_area < 0.0 || v_area < 0.0 : u_area > 0.0 || v_area > 0.0) continue;
        const double u = u_area / area, v = v_area / area;
        if (u + v <= 1.0) put(x, y, a.z() + u * (b.z() - a.z()) + v * (c.z() - a.z()), t.ink);
      }
    }
  }

  void draw(const DrawnStroke& s) {
    const int steps = std::max(1, static_cast<int>(std::ceil((s.b - s.a).head<2>().norm())));
    for (int k = 0; k <= steps; ++k) {
      const Vec3 p = s.a + (s.b - s.a) * (static_cast<double>(k) / steps);
      const int top = std::max(first_, static_cast<int>(p.y() - s.radius));
      const int bottom = std::min(end_ - 1, static_cast<int>(p.y() + s.radius));
      for (int y = top; y <= bottom; ++y) {
        for (int x = static_cast<int>(p.x() - s.radius); x <= static_cast<int>(p.x() + s.radius); ++x) {
          const bool is_inside = std::hypot(x + 0.5 - p.x(), y + 0.5 - p.y()) <= s.radius;
          if (is_inside && x >= 0 && x < width_) put(x, y, p.z() + s.lift, s.ink);
        }
      }
    }
  }

  [[nodiscard]] std::uint32_t ink(int x, int y) const { return inks_[at(x, y)]; }

 private:
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(end_ - first_) * static_cast<std::size_t>(width_);
  }
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y - first_) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  void put(int x, int y, double depth, std::uint32_t ink) {
    if (depth <= depths_[at(x, y)]) return;
    depths_[at(x, y)] = depth;
    inks_[at(x, y)] = ink;
  }

  int width_, first_, end_;
  std::vector<std::uint32_t> inks_;  ///< 0: background
  std::vector<double> depths_;
};

/// A picture that is drawn once everything is known: in bands, each small enough for the processor's cache.
class Canvas {
 public:
  Canvas(int width, int height) : width_(width), height_(height) {}

  /// Corners in elements and depth towards the observer.
  void triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& color) {
    triangles_.push_back({a, b, c, ink_of(color)});
  }

  /// A round stroke, drawn a little towards the observer so that it lies on a surface and not in it.
  void stroke(const Vec3& a, const Vec3& b, double radius, double lift, const Vec3& color) {
    strokes_.push_back({a, b, radius, lift, ink_of(color)});
  }

  /// Averaged over blocks of kSupersampling elements.
  [[nodiscard]] std::string png() const {
    constexpr int kBandRows = 32 * kSupersampling;
    std::vector<std::uint8_t> pixels;
    for (int first = 0; first < height_; first += kBandRows) {
      Band band(width_, first, std::min(height_, first + kBandRows));
      for (const DrawnTriangle& t : triangles_) band.draw(t);
      for (const DrawnStroke& s : strokes_) band.draw(s);
      for (int y = first; y < std::min(height_, first + kBandRows); y += kSupersampling) {
        for (int x = 0; x < width_; x += kSupersampling) {
          Vec3 sum = Vec3::Zero();
          for (int k = 0; k < kSupersampling * kSupersampling; ++k)
            sum += colors_[band.ink(x + k % kSupersampling, y + k / kSupersampling)];
          sum *= 255.0 / (kSupersampling * kSupersampling);
          for (int c = 0; c < 3; ++c) pixels.push_back(static_cast<std::uint8_t>(std::lround(sum[c])));
        }
      }
    }
    return encode_png(pixels, width_ / kSupersampling, height_ / kSupersampling, 3);
  }

 private:
  std::uint32_t ink_of(const Vec3& color) {
    colors_.push_back(color);
    return static_cast<std::uint32_t>(colors_.size() - 1);
  }

  int width_, height_;
  std::vector<Vec3> colors_{kBackground};
  std::vector<DrawnTriangle> triangles_;
  std::vector<DrawnStroke> strokes_;
};

/// The map from a frame to its picture.
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
