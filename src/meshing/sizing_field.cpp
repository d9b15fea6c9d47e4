#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/meshing/sizing_field.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

constexpr std::size_t kMaxPathPoints = 256;

void append_violations(std::vector<Problem>& violations, const PlannedCut& cut) {
  const std::size_t needed = cut.path.is_closed ? 3 : 2;
  if (cut.path.points.size() < needed) {
    violations.push_back(
        {"path", fmt::format("{} points", cut.path.points.size()), fmt::format("at least {}", needed)});
  }
  const auto bad =
      std::find_if(cut.path.points.begin(), cut.path.points.end(), [](const Vec3& p) { return !p.allFinite(); });
  if (bad != cut.path.points.end()) {
    violations.push_back(
        {fmt::format("path[{}]", bad - cut.path.points.begin()), "a number that is not finite", "finite numbers"});
  } else if (cut.path.points.size() >= needed && !(length_mm(cut.path) > 0.0)) {
    violations.push_back({"path", "length 0", "above 0 mm"});
  }
  if (!cut.approach.allFinite() || !(cut.approach.norm() > 0.0)) {
    violations.push_back({"approach", "a zero or infinite vector", "a direction"});
  }
  const Expect expect(violations);
  expect(cut.depth_mm > 0.0, "depth_mm", cut.depth_mm, "a finite number > 0");
}

/// Returns how far `value` lies outside [low, high].
double excess(double value, double low, double high) {
  return std::max({low - value, value - high, 0.0});
}

/// The nearest point of the path in the picture plane, and the side of a closed path on which q lies.
struct PlaneDistance {
  double squared = std::numeric_limits<double>::infinity();
  double height = 0.0;  ///< of the path at its nearest point
  bool is_inside = false;
};

PlaneDistance plane_distance(const Contour& path, const Vec3& q) {
  PlaneDistance best;
  const std::size_t count = path.points.size();
  for (std::size_t i = path.is_closed ? 0 : 1; i < count; ++i) {
    const Vec3& a = path.points[i == 0 ? count - 1 : i - 1];
    const Vec3& b = path.points[i];
    const Vec2 along = (b - a).head<2>();
    const Vec2 from_a = (q - a).head<2>();
    const double squared_length = along.squaredNorm();
    const double t = squared_length > 0.0 ? std::clamp(along.dot(from_a) / squared_length, 0.0, 1.0) : 0.0;
    const double squared = (from_a - t * along).squaredNorm();
    if (squared < best.squared) {
      best.squared = squared;
      best.height = a.z() + t * (b.z() - a.z());
    }
    // Even-odd rule: count the edges crossed by the ray from q along +x.
    if (path.is_closed && (a.y() > q.y()) != (b.y() > q.y()) &&
        q.x() < a.x() + (b.x() - a.x()) * (q.y() - a.y()) / (b.y() - a.y())) {
      best.is_inside = !best.is_inside;
    }
  }
  return best;
}

}  // namespace

SizingSettings default_lengths(double longest_side_mm) {
  constexpr double kMadeForMm = 40.0;  // as for the default constraints
  const double share = longest_side_mm > 0.0 ? std::min(1.0, longest_side_mm / kMadeForMm) : 1.0;
  SizingSettings settings;
  settings.fine_mm *= share;
  settings.coarse_mm *= share;
  return settings;
}

std::vector<Problem> validate(const SizingSettings& settings) {
  std::vector<Problem> violations = problems_of(settings);
  Expect{violations}(settings.fine_mm <= settings.coarse_mm, "fine_mm", settings.fine_mm,
                     fmt::format("at most coarse_mm = {}", settings.coarse_mm));
  return violations;
}

SizingField SizingField::uniform(double edge_mm) {
  SizingField field;
  field.settings_.fine_mm = edge_mm;
  field.settings_.coarse_mm = edge_mm;
  require_none(validate(field.settings_));
  return field;
}

SizingField SizingField::around_cut(const PlannedCut& cut, const SizingSettings& settings) {
  std::vector<Problem> violations = validate(settings);
  append_violations(violations, cut);
  require_none(violations);

  const double widest_mm = std::max(settings.band_inside_mm, settings.band_outside_mm);
  Band band{.view = view_along(cut.approach),
            .path = cut.path.points.size() > kMaxPathPoints ? resample(cut.path, kMaxPathPoints) : cut.path,
            .inside_mm = settings.band_inside_mm,
            .outside_mm = cut.path.is_closed ? settings.band_outside_mm : widest_mm,
            // There is tissue above the path only where the surface bulges next to it.
            .above_mm = widest_mm,
            .below_mm = cut.depth_mm + settings.band_below_mm};
  for (Vec3& p : band.path.points) p = band.view.to_view(p);

  SizingField field;
  field.settings_ = settings;
  field.band_ = std::move(band);
  return field;
}

double SizingField::distance_to_band_mm(const Vec3& p) const {
  if (!band_) return 0.0;
  const Vec3 q = band_->view.to_view(p);
  const PlaneDistance nearest = plane_distance(band_->path, q);
  const double lateral_mm = (nearest.is_inside ? -1.0 : 1.0) * std::sqrt(nearest.squared);
  const double inner_mm = band_->path.is_closed ? -band_->inside_mm : 0.0;
  return std::hypot(excess(lateral_mm, inner_mm, band_->outside_mm),
                    excess(nearest.height - q.z(), -band_->above_mm, band_->below_mm));
}

double SizingField::edge_length_at_mm(double distance_to_band_mm) const {
  return std::min(settings_.fine_mm + settings_.growth * distance_to_band_mm, settings_.coarse_mm);
}

SizingField SizingField::scaled(double factor) const {
  INCISE_REQUIRE(factor > 0.0 && std::isfinite(factor), fmt::format("factor: found {}, expected > 0", factor));
  SizingField field = *this;
  field.settings_.fine_mm *= factor;
  field.settings_.coarse_mm *= factor;
  return field;
}

}  // namespace incise
