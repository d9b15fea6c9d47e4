#include "calibration/sector_noise.hpp"

#include <incise/calibration/drag_response.hpp>
#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

void require_profiles(const std::vector<SimulatedProfile>& profiles) {
  std::size_t sectors = 0;
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    const SimulatedProfile& p = profiles[i];
    INCISE_REQUIRE(p.drag_length_mm > 0.0 && p.stiffness_factor > 0.0,
                   fmt::format("profile {}: expected a drag length and a stiffness above 0", i));
    if (p.signed_error_mm.empty()) continue;
    if (sectors == 0) sectors = p.signed_error_mm.size();
    INCISE_REQUIRE(p.signed_error_mm.size() == sectors,
                   fmt::format("profile {}: expected {} sectors, found {}", i, sectors, p.signed_error_mm.size()));
  }
}

/// Root mean square of the entries of all spectra above the order of tissue, up to twice that order: the grain of slow
/// waves is needed, and grain is stronger there than in the fastest waves.
double fast_waves_rms(const std::vector<SimulatedProfile>& knots) {
  double squares = 0.0;
  double count = 0.0;
  for (const SimulatedProfile& knot : knots) {
    const std::vector<double> spectrum = ring_spectrum(knot.signed_error_mm);
    const std::size_t end = std::min(spectrum.size(), 2 * kEntriesThatCount - 1);
    for (std::size_t j = kEntriesThatCount; j < end; ++j, count += 1.0) squares += spectrum[j] * spectrum[j];
  }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

/// Linear between neighbours; constant beyond the ends.
std::vector<double> between(const std::vector<SimulatedProfile>& knots, double drag_length_mm) {
  const auto above = std::find_if(knots.begin(), knots.end(), [drag_length_mm](const SimulatedProfile& knot) {
    return knot.drag_length_mm >= drag_length_mm;
  });
  if (above == knots.end()) return knots.back().signed_error_mm;
  if (above == knots.begin()) return above->signed_error_mm;
  const auto below = std::prev(above);
  const double t = (drag_length_mm - below->drag_length_mm) / (above->drag_length_mm - below->drag_length_mm);
  std::vector<double> result = below->signed_error_mm;
  for (std::size_t i = 0; i < result.size(); ++i) result[i] += t * (above->signed_error_mm[i] - result[i]);
  return result;
}

void sort_by_drag_length(std::vector<SimulatedProfile>& profiles) {
  std::sort(profiles.begin(), profiles.end(),
            [](const SimulatedProfile& a, const SimulatedProfile& b) { return a.drag_length_mm < b.drag_length_mm; });
}

/// The rings at the reference stiffness before the first that did not close. @pre sorted.
std::vector<SimulatedProfile> knots_of(const std::vector<SimulatedProfile>& profiles) {
  std::vector<SimulatedProfile> knots;
  for (const SimulatedProfile& profile : profiles) {
    if (!is_reference_stiffness(profile.stiffness_factor)) continue;
    if (profile.signed_error_mm.empty()) break;  // a longer drag that closed again would be luck
    knots.push_back(profile);
  }
  return knots;
}

}  // namespace

bool is_reference_stiffness(double stiffness_factor) {
  return std::abs(stiffness_factor - 1.0) < 1e-9;
}

bool DragResponse::can_be_made_of(std::vector<SimulatedProfile> profiles) {
  sort_by_drag_length(profiles);
  return knots_of(profiles).size() >= 2;
}

DragResponse::DragResponse(std::vector<SimulatedProfile> profiles) {
  require_profiles(profiles);
  sort_by_drag_length(profiles);
  knots_ = knots_of(profiles);
  INCISE_REQUIRE(
      knots_.size() >= 2,
      fmt::format("expected at least two closed simulated rings before the first open one, found {}", knots_.size()));
  grain_mm_ = fast_waves_rms(knots_);
  for (const SimulatedProfile& profile : profiles) {
    if (is_reference_stiffness(profile.stiffness_factor) || profile.signed_error_mm.empty()) continue;
    const auto partner = std::find_if(knots_.begin(), knots_.end(), [&profile](const SimulatedProfile& knot) {
      return std::abs(knot.drag_length_mm - profile.drag_length_mm) < 1e-9;
    });
    if (partner == knots_.end()) continue;
    SimulatedProfile slope = profile;
    const double step = std::log(profile.stiffness_factor);
    for (std::size_t i = 0; i < slope.signed_error_mm.size(); ++i) {
      slope.signed_error_mm[i] = (profile.signed_error_mm[i] - partner->signed_error_mm[i]) / step;
    }
    slopes_.push_back(std::move(slope));
  }
}

std::vector<double> DragResponse::at(double drag_length_mm) const {
  INCISE_REQUIRE(
      drag_length_mm >= least_mm() - 1e-9 && drag_length_mm <= most_mm() + 1e-9,
      fmt::format("expected a drag length from {} to {} mm, found {}", least_mm(), most_mm(), drag_length_mm));
  return between(knots_, drag_length_mm);
}

double DragResponse::grain_share(double drag_length_mm) const {
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    const double from = knots_[i - 1].drag_length_mm;
    const double to = knots_[i].drag_length_mm;
    if (drag_length_mm > to || drag_length_mm < from) continue;
    const double t = (drag_length_mm - from) / (to - from);
    return (1.0 - t) * (1.0 - t) + t * t;
  }
  return 1.0;
}

std::vector<double> DragResponse::stiffness_slope(double drag_length_mm) const {
  if (slopes_.empty()) return std::vector<double>(sectors(), 0.0);
  return between(slopes_, drag_length_mm);
}

}  // namespace incise
