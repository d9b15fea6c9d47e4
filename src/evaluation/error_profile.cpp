#include <incise/core/error.hpp>
#include <incise/evaluation/contour_errors.hpp>
#include <incise/evaluation/error_profile.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace incise {
namespace {

constexpr double kProfileStepMm = 0.1;

/// Sectors of equal angle about the middle of the tumour edge, as the camera sees them.
class SectorRing {
 public:
  SectorRing(const Contour& flat_edge, const ViewFrame& view, const ProfileSettings& settings)
      : middle_(curve_centroid(flat_edge)), sectors_(settings.sectors) {
    const Vec2 start(settings.start_direction.dot(view.x), settings.start_direction.dot(view.y));
    INCISE_REQUIRE(start.norm() > 1e-9 * settings.start_direction.norm(),
                   "expected a start direction across the approach");
    first_ = std::atan2(start.y(), start.x()) / (2.0 * std::numbers::pi) + settings.turn_deg / 360.0;
  }

  /// Direction of a place, in sectors from the middle of the first sector: [0, sectors].
  [[nodiscard]] double place_of(const Vec3& seen) const {
    const Vec3 out = seen - middle_;
    const double turn = std::atan2(out.y(), out.x()) / (2.0 * std::numbers::pi) - first_;
    return (turn - std::floor(turn)) * sectors_;
  }

 private:
  Vec3 middle_;
  int sectors_;
  double first_ = 0.0;
};

/// Mean of each sector; nothing if a sector is empty.
std::optional<std::vector<double>> means_of(const SectorRing& ring, const Points& seen, std::span<const double> values,
                                            std::size_t sectors) {
  std::vector<double> sums(sectors, 0.0);
  std::vector<double> counts(sectors, 0.0);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const auto sector = static_cast<std::size_t>(ring.place_of(seen[i]) + 0.5) % sectors;
    sums[sector] += values[i];
    counts[sector] += 1.0;
  }
  for (std::size_t k = 0; k < sectors; ++k) {
    if (counts[k] == 0.0) return std::nullopt;
    sums[k] /= counts[k];
  }
  return sums;
}

void require_sectors(std::size_t count, std::size_t least) {
  constexpr std::size_t kMost = 360;
  INCISE_REQUIRE(count >= least && count <= kMost,
                 fmt::format("expected {} to {} sectors, found {}", least, kMost, count));
}

}  // namespace

std::optional<std::vector<double>> error_profile(const Contour& incision, const Contour& tumor_edge,
                                                 const ProfileSettings& settings) {
  require_sectors(static_cast<std::size_t>(std::max(0, settings.sectors)), 4);
  INCISE_REQUIRE(incision.is_closed, "expected a closed incision, found an open one");
  const ViewFrame view = view_along(settings.approach);
  const Contour edge = flat_in_view(tumor_edge, view);
  const Vec3 down = -Vec3::UnitZ();
  const ContourErrors errors =
      contour_errors(flat_in_view(incision, view), edge, settings.target_mm, down, kProfileStepMm);
  const SectorRing ring(edge, view, settings);
  return means_of(ring, errors.points.points, errors.signed_error_mm, static_cast<std::size_t>(settings.sectors));
}

std::optional<std::vector<double>> sector_means(const Points& places, std::span<const double> values,
                                                const Contour& tumor_edge, const ProfileSettings& settings) {
  require_sectors(static_cast<std::size_t>(std::max(0, settings.sectors)), 1);
  INCISE_REQUIRE(places.size() == values.size(),
                 fmt::format("expected a value for each place, found {} for {}", values.size(), places.size()));
  const ViewFrame view = view_along(settings.approach);
  const SectorRing ring(flat_in_view(tumor_edge, view), view, settings);
  return means_of(ring, flat_in_view({.points = places}, view).points, values,
                  static_cast<std::size_t>(settings.sectors));
}

std::vector<double> values_at(const std::vector<double>& sectors, const Points& places, const Contour& tumor_edge,
                              const ProfileSettings& settings) {
  require_sectors(sectors.size(), 1);
  ProfileSettings own = settings;
  own.sectors = static_cast<int>(sectors.size());
  const ViewFrame view = view_along(settings.approach);
  const SectorRing ring(flat_in_view(tumor_edge, view), view, own);
  std::vector<double> values;
  for (const Vec3& p : places) {
    const Vec3 seen = view.to_view(p);
    const double place = ring.place_of({seen.x(), seen.y(), 0.0});
    const auto before = static_cast<std::size_t>(place) % sectors.size();
    const double share = place - std::floor(place);
    values.push_back((1.0 - share) * sectors[before] + share * sectors[(before + 1) % sectors.size()]);
  }
  return values;
}

}  // namespace incise
