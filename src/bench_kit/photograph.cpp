#include "bench_kit/drawn_line.hpp"
#include "bench_kit/tissue_colors.hpp"

#include <incise/bench_kit/pictures.hpp>
#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/geometry/morphology.hpp>
#include <incise/geometry/raster.hpp>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr double kVisibleHeatMm = 1.0;  // the electrode's diameter: only heat that reaches farther is visible
constexpr double kNeedleMm = 0.5;
constexpr double kWallMm = 1.2;        // from the rim of the kerf to where it is darkest
constexpr double kCoarsePixels = 4.0;  // distances from the rim are computed on a grid coarser by this factor
constexpr int kRays = 720;             // along which an open kerf's inner edge is searched
constexpr double kMostJumpMm = 1.2;    // between neighbouring rays, within one piece of that edge
constexpr double kCharMm = 0.5;        // width of the char beside the rim
constexpr double kRulerMm = 40.0;
constexpr double kTickMm = 0.25;  // width of a tick

Points flat(const Contour& contour, const ViewFrame& view) {
  Points points;
  for (const Vec3& p : contour.points) points.push_back(view.to_view(p));
  return points;
}

/// Returns a place of the grid's plane in pixels of the picture: rows run down in a picture, up in a grid.
Vec2 to_picture(const RasterGrid& grid, const Vec2& p) {
  const Vec2 index = grid.index_of(p);
  return {index.x(), grid.height - 1 - index.y()};
}

/// Returns the pieces of an open kerf's inner edge: the first cut pixels on rays from the tumour's middle.
std::vector<std::vector<Vec2>> open_inner_edge(const Raster& kerf, const Vec2& middle) {
  const double longest = kerf.pixel_mm * std::hypot(kerf.width, kerf.height);
  std::vector<std::vector<Vec2>> pieces(1);
  for (int n = 0; n <= kRays; ++n) {
    const double angle = 2.0 * units::kPi * n / kRays;
    const Vec2 heading(std::cos(angle), std::sin(angle));
    std::optional<Vec2> found;
    for (double r = 0.0; r < longest && !found; r += 0.5 * kerf.pixel_mm) {
      const auto [i, j] = kerf.pixel_near(middle + r * heading);
      if (!kerf.contains(i, j)) break;
      if (kerf.at(i, j) != 0) found = middle + r * heading;
    }
    const bool goes_on = found && !pieces.back().empty() && (*found - pieces.back().back()).norm() < kMostJumpMm;
    if (!goes_on && !pieces.back().empty()) pieces.emplace_back();
    if (found) pieces.back().push_back(*found);
  }
  return pieces;
}

class Painter {
 public:
  Painter(const SeenTissue& tissue, const Marked& marked, const PhotographSettings& settings)
      : tissue_(tissue), marked_(marked), settings_(settings), view_(view_along(marked.approach)), grain_(marked.seed) {
    for (const Vec3& p : tissue.vertices) in_view_.push_back(view_.to_view(p));
    Box3 box = bounding_box(flat(tissue.tumor_edge, view_));
    if (marked.inner_edge)
      box.extend(bounding_box(flat(*marked.inner_edge, view_)));
    else
      box = Box3(box.min() - Vec3::Constant(6.0), box.max() + Vec3::Constant(6.0));
    grid_ = grid_around(box.min().head<2>(), box.max().head<2>(), settings.mm_per_pixel, settings.border_mm);
    seen_ = depth_buffer(grid_, in_view_, tissue_.triangles);
    picture_ = {grid_.width, grid_.height, std::vector<std::uint8_t>(3 * grid_.pixel_count())};
  }

  ColorPicture paint() {
    lay_tissue();
    cooked_rim();
    if (marked_.stains > 0.0) stain();
    line({flat2(tissue_.tumor_edge)}, true, settings_.green_line_mm, kGreenInk, 0.0);
    if (marked_.inner_edge) {
      line({flat2(*marked_.inner_edge)}, true, settings_.line_mm, kRedInk, marked_.hand_mm);
    } else {
      const Vec3 middle = view_.to_view(curve_centroid(tissue_.tumor_edge));
      line(open_inner_edge(kerf(grid_), middle.head<2>()), false, settings_.line_mm, kRedInk, marked_.hand_mm);
    }
    ruler();
    return std::move(picture_);
  }

 private:
  [[nodiscard]] std::vector<Vec2> flat2(const Contour& contour) const {
    std::vector<Vec2> points;
    for (const Vec3& p : flat(contour, view_)) points.push_back(p.head<2>());
    return points;
  }
  std::uint8_t* pixel(int i, int j) { return pixel_at(picture_, i, grid_.height - 1 - j); }

  [[nodiscard]] RasterGrid coarse_grid() const {
    RasterGrid coarse = grid_;
    coarse.pixel_mm = kCoarsePixels * grid_.pixel_mm;
    coarse.width = static_cast<int>(std::ceil(grid_.width / kCoarsePixels));
    coarse.height = static_cast<int>(std::ceil(grid_.height / kCoarsePixels));
    return coarse;
  }

  /// Returns the pixels of the kerf: those that show tissue but not skin, whether a wall or the bottom of the kerf.
  [[nodiscard]] Raster kerf(const RasterGrid& grid) const {
    Raster raster(grid, 0);
    for (int j = 0; j < grid.height; ++j) {
      for (int i = 0; i < grid.width; ++i) {
        const Vec2 index = grid_.index_of(grid.centre(i, j));
        const int u = static_cast<int>(std::lround(index.x()));
        const int v = static_cast<int>(std::lround(index.y()));
        if (!grid_.contains(u, v)) continue;
        const std::int32_t triangle = seen_.triangles[grid_.offset(u, v)];
        raster.at(i, j) = triangle >= 0 && tissue_.is_skin[static_cast<std::size_t>(triangle)] == 0 ? 1 : 0;
      }
    }
    return raster;
  }

  void lay_tissue() {
    Random random(marked_.seed ^ 0x85ebca6bULL);
    const ScalarRaster within = distance_to(kerf(coarse_grid()), 0);
    for (int j = 0; j < grid_.height; ++j) {
      for (int i = 0; i < grid_.width; ++i) {
        const std::int32_t n = seen_.triangles[grid_.offset(i, j)];
        const Paint noise(random.normal(), random.normal(), random.normal());
        if (n < 0) {
          put(pixel(i, j), kTablePaint + 2.5 * noise);
          continue;
        }
        const Triangle& t = tissue_.triangles[static_cast<std::size_t>(n)];
        const Vec3 weights = weights_seen_at(in_view_, t, grid_.centre(i, j));
        Vec3 rest = Vec3::Zero();
        for (std::size_t c = 0; c < 3; ++c) rest += weights[static_cast<Eigen::Index>(c)] * tissue_.rest[t[c].index()];
        const Vec3& a = in_view_[t[0].index()];
        const Vec3 normal = (in_view_[t[1].index()] - a).cross(in_view_[t[2].index()] - a).normalized();
        const double light = 0.6 + 0.4 * std::abs(normal.z());
        if (tissue_.is_skin[static_cast<std::size_t>(n)] != 0) {
          put(pixel(i, j), kTissuePaint * (grain_.at(rest) * light) + 2.5 * noise);
          continue;
        }
        // Walls of cut muscle, darker farther from the rim. Real tissue shows no flat facets of tets.
        const Vec2 place = grid_.centre(i, j);
        const double depth = std::clamp(sample(within, place) / kWallMm, 0.0, 1.0);
        const double grain = grain_.at(2.0 * Vec3(place.x(), place.y(), 0.0));
        put(pixel(i, j), ((1.0 - depth) * kWallPaint + depth * kDeepPaint) * grain + 2.5 * noise);
      }
    }
  }

  /// Paints the skin beside the kerf that heat has denatured, if the heat reached farther than kVisibleHeatMm.
  void cooked_rim() {
    if (marked_.thermal_width_mm <= kVisibleHeatMm) return;
    const ScalarRaster away = distance_to(kerf(coarse_grid()), 1);
    const double reach = marked_.thermal_width_mm - kNeedleMm;
    for (int j = 0; j < grid_.height; ++j) {
      for (int i = 0; i < grid_.width; ++i) {
        const std::int32_t n = seen_.triangles[grid_.offset(i, j)];
        if (n < 0 || tissue_.is_skin[static_cast<std::size_t>(n)] == 0) continue;
        const double distance = sample(away, grid_.centre(i, j));
        if (distance < reach) lay(pixel(i, j), kCookedPaint, 0.85 * (1.0 - 0.5 * distance / reach));
      }
    }
  }

  /// Paints char along the kerf's rim, blood that has run out of it, and reflections of lamps on the tissue.
  void stain() {
    Random random(marked_.seed ^ 0x2c1b3c6dULL);
    const SmoothField blood(5.0, random), glare(2.2, random);
    const ScalarRaster away = distance_to(kerf(coarse_grid()), 1);
    for (int j = 0; j < grid_.height; ++j) {
      for (int i = 0; i < grid_.width; ++i) {
        const std::int32_t n = seen_.triangles[grid_.offset(i, j)];
        if (n < 0 || tissue_.is_skin[static_cast<std::size_t>(n)] == 0) continue;
        const Vec2 at = grid_.centre(i, j);
        const Vec3 place(at.x(), at.y(), 0.0);
        const double distance = sample(away, at);
        if (!std::isfinite(distance)) continue;  // no kerf, no stains
        lay(pixel(i, j), kCharPaint, marked_.stains * std::clamp(1.0 - distance / kCharMm, 0.0, 1.0));
        const double run = std::clamp(blood.at(place) - 0.6 - 0.35 * distance, 0.0, 1.0);
        lay(pixel(i, j), kBloodPaint, 0.8 * marked_.stains * run);
        lay(pixel(i, j), kGlarePaint, marked_.stains * std::clamp(4.0 * (glare.at(place) - 2.2), 0.0, 1.0));
      }
    }
  }

  void line(const std::vector<std::vector<Vec2>>& pieces, bool is_closed, double width_mm, const Paint& ink,
            double hand_mm) {
    Random random(marked_.seed ^ 0xc2b2ae3dULL);
    const SmoothField along_x(marked_.hand_wave_mm, random);
    const SmoothField along_y(marked_.hand_wave_mm, random);
    const double half_px = 0.5 * width_mm / grid_.pixel_mm;
    LineDistance distance(grid_.width, grid_.height, half_px + 2.0);
    for (const std::vector<Vec2>& piece : pieces) {
      std::vector<Vec2> drawn;
      for (const Vec2& p : piece) {
        const Vec3 place(p.x(), p.y(), 0.0);
        drawn.push_back(to_picture(grid_, p + hand_mm * Vec2(along_x.at(place), along_y.at(place))));
      }
      distance.add(drawn, is_closed);
    }
    for (int v = 0; v < picture_.height; ++v)
      for (int u = 0; u < picture_.width; ++u) {
        const double cover = std::clamp(half_px + 0.5 - distance.at(u, v), 0.0, 1.0);
        if (cover > 0.0) lay(pixel_at(picture_, u, v), ink, cover);
      }
  }

  /// Draws a white steel rule along the picture's lower border: ticks every millimetre, longer ones every five.
  void ruler() {
    const double px = 1.0 / grid_.pixel_mm;
    const double length = std::min(kRulerMm, std::floor(0.9 * grid_.width / px - 2.0));
    const int left = static_cast<int>(0.5 * (grid_.width - length * px));
    const int top = grid_.height - static_cast<int>(4.6 * px);
    for (int v = top; v < grid_.height - static_cast<int>(0.4 * px); ++v) {
      for (int u = left - static_cast<int>(px); u < left + static_cast<int>((length + 1.0) * px); ++u) {
        if (u < 0 || v < 0 || u >= picture_.width) continue;
        const double mm = (u - left) / px;
        const double nearest = std::round(mm);
        const bool is_long = static_cast<int>(nearest) % 5 == 0;
        const bool is_tick = nearest >= 0.0 && nearest <= length && std::abs(mm - nearest) < 0.5 * kTickMm &&
                             v - top < static_cast<int>((is_long ? 3.2 : 2.2) * px);
        put(pixel_at(picture_, u, v), is_tick ? Paint(24.0, 24.0, 24.0) : Paint(236.0, 236.0, 234.0));
      }
    }
  }

  const SeenTissue& tissue_;
  const Marked& marked_;
  const PhotographSettings& settings_;
  ViewFrame view_;
  Points in_view_;
  TissueGrain grain_;
  RasterGrid grid_;
  DepthBuffer seen_;
  ColorPicture picture_;
};

}  // namespace

ColorPicture photograph(const SeenTissue& tissue, const Marked& marked, const PhotographSettings& settings) {
  INCISE_REQUIRE(settings.mm_per_pixel > 0.0 && settings.border_mm >= 6.0 && settings.line_mm > 0.0 &&
                     settings.green_line_mm > 0.0,
                 "expected a scale and widths above 0 and a border of at least 6 mm");
  return Painter(tissue, marked, settings).paint();
}

}  // namespace incise
