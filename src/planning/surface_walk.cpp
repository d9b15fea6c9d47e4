#include "planning/surface_walk.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace incise {
namespace {

constexpr int kRimDirections = 16;
constexpr int kNormalDirections = 8;
constexpr double kNormalRadiusMm = 2.0;
/// Depth inside the tissue at which the search for its far side begins: more than the rounding of a point on the
/// surface.
constexpr double kSkinMm = 1e-4;
constexpr int kMostSheets = 64;

Vec2 direction(int k, int count) {
  const double angle = 2.0 * std::numbers::pi * k / count;
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace

std::string in_words(const Vec3& p) {
  return fmt::format("({:.2f}, {:.2f}, {:.2f})", p.x(), p.y(), p.z());
}

std::optional<SurfacePoint> SurfaceView::at(const Vec2& place) const {
  return surface_->seen_at(view_.from_view(Vec3(place.x(), place.y(), 0.0)), approach());
}

bool SurfaceView::is_clear_of_rim(const Vec2& place, double radius_mm) const {
  if (radius_mm == 0.0) return true;
  for (int k = 0; k < kRimDirections; ++k) {
    if (!at(place + radius_mm * direction(k, kRimDirections))) return false;
  }
  return true;
}

Vec3 SurfaceView::smooth_normal(const Vec2& place) const {
  Vec3 sum = Vec3::Zero();
  const auto add = [&](const Vec2& where) {
    if (const std::optional<SurfacePoint> seen = at(where)) sum += seen->normal;
  };
  add(place);
  for (int k = 0; k < kNormalDirections; ++k) {
    add(place + 0.5 * kNormalRadiusMm * direction(k, kNormalDirections));
    add(place + kNormalRadiusMm * direction(k, kNormalDirections));
  }
  return sum.stableNormalized();
}

Vec3 SurfaceView::tool_axis(const Vec2& place, AxisMode mode) const {
  return mode == AxisMode::Approach ? approach() : Vec3(-smooth_normal(place));
}

std::optional<double> thickness_mm(const SurfaceQuery& surface, const Vec3& point, const Vec3& axis) {
  double passed = kSkinMm;
  for (int sheet = 0; sheet < kMostSheets; ++sheet) {
    const std::optional<SurfacePoint> hit = surface.first_hit(point + passed * axis, axis);
    if (!hit) return std::nullopt;
    passed += hit->distance_mm;
    if (hit->normal.dot(axis) > 0.0) return passed;
    passed += kSkinMm;  // this face leads inwards: the point lay slightly above the surface
  }
  return std::nullopt;
}

}  // namespace incise
