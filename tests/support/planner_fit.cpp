#include "support/planner_fit.hpp"

#include "support/phantom_inputs.hpp"

#include <incise/bench_studies/planned_bench_cut.hpp>
#include <incise/core/error.hpp>
#include <incise/core/units.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace incise::testing {
namespace {

constexpr std::size_t kBins = 36;                           // of the angle about the tumour's middle, seen from above
constexpr std::array kDullness{3.0, 6.0, 9.0, 12.0, 15.0};  // at 13 mm/s
constexpr std::array kModulusKpa{70.0, 35.0};

using Profile = std::array<double, kBins>;

/// Signed error of an inner edge by the direction from the tumour's middle, seen from above.
Profile profile_of(Contour inner_edge, Contour tumor) {
  for (Contour* contour : {&inner_edge, &tumor})
    for (Vec3& p : contour->points) p.z() = 0.0;
  const Vec3 middle = curve_centroid(tumor);
  Profile sums{};
  Profile counts{};
  for (const Vec3& p : resample(inner_edge, 1440).points) {
    const double turn = std::atan2(p.y() - middle.y(), p.x() - middle.x()) / (2.0 * units::kPi);
    const auto bin = static_cast<std::size_t>((turn - std::floor(turn)) * kBins) % kBins;
    const double distance = nearest_on(tumor, p).distance_mm;
    sums[bin] += (contains_in_view(tumor, p, -Vec3::UnitZ()) ? -distance : distance) - kInnerEdgeTargetMm;
    counts[bin] += 1.0;
  }
  for (std::size_t i = 0; i < kBins; ++i) {
    INCISE_REQUIRE(counts[i] > 0.0, "expected an inner edge round the tumour's middle");
    sums[i] /= counts[i];
  }
  return sums;
}

double mean_of(const Profile& p) {
  double sum = 0.0;
  for (const double e : p) sum += e / kBins;
  return sum;
}

struct Fit {
  double rms_mm = std::numeric_limits<double>::infinity();
  double dullness = 0.0, modulus_kpa = 0.0, bias_mm = 0.0;
};

/// Least squares of seen = a + t (b - a) + bias over t in [0, 1] and the bias.
void fit_between(const Profile& seen, const Profile& a, const Profile& b, double from, double to, double modulus_kpa,
                 Fit& best) {
  Profile way{};
  Profile rest{};
  for (std::size_t i = 0; i < kBins; ++i) {
    way[i] = b[i] - a[i];
    rest[i] = seen[i] - a[i];
  }
  const double way_mean = mean_of(way);
  const double rest_mean = mean_of(rest);
  double above = 0.0;
  double below = 0.0;
  for (std::size_t i = 0; i < kBins; ++i) {
    above += (way[i] - way_mean) * (rest[i] - rest_mean);
    below += (way[i] - way_mean) * (way[i] - way_mean);
  }
  const double t = below > 0.0 ? std::clamp(above / below, 0.0, 1.0) : 0.0;
  const double bias = rest_mean - t * way_mean;
  double squares = 0.0;
  for (std::size_t i = 0; i < kBins; ++i) squares += std::pow(rest[i] - t * way[i] - bias, 2) / kBins;
  if (std::sqrt(squares) < best.rms_mm) best = {std::sqrt(squares), from + t * (to - from), modulus_kpa, bias};
}

/// The bench's cut along the path that its own stretched tissue asks for.
std::optional<Profile> cut_on_bench(const Specimen& specimen, Workers& workers) {
  Monitor silent;
  const BenchBody body = make_body(specimen, {}, workers, silent);
  if (body.outcome == Outcome::NotConverged) return std::nullopt;
  const BenchCut cut = cut_as_planned(body, {}, workers, silent);
  if (!cut.inner_edge) return std::nullopt;
  return profile_of(*cut.inner_edge, cut.tumor_edge);
}

}  // namespace

std::optional<PlannerFit> fit_planner_to_bench(std::uint64_t seed, int tets, const CutSettings& cut) {
  Workers workers(1);
  Monitor silent;
  const Specimen specimen = draw_specimen(seed);
  const auto seen = cut_on_bench(specimen, workers);
  if (!seen) return std::nullopt;
  const Phantom phantom = make_phantom(phantom_settings(specimen), silent);
  PhantomInputs inputs(phantom);
  Cache cache;
  Fit best;
  int open = 0;
  for (const double modulus_kpa : kModulusKpa) {
    Case settings;
    settings.is_virtual = true;
    settings.meshing.tets = tets;
    settings.frames = 0;
    settings.cut = cut;
    settings.tumor_configuration = TumorConfiguration::Rest;
    settings.material.youngs_modulus_kpa = modulus_kpa;
    const Study study = run_study(settings, inputs, cache, {.until = Stage::Plan}, workers, silent);
    std::optional<Profile> last;
    double last_dullness = 0.0;
    for (const double dullness : kDullness) {
      settings.cut.dullness = dullness;
      const SimulatedCut done =
          cut_and_judge(settings, *study.model, study.stretched->state, *study.plan, *study.plan, workers, silent);
      if (!done.incision.inner_edge) {
        ++open;
        last.reset();
        continue;
      }
      const Profile now = profile_of(*done.incision.inner_edge, done.incision.final_tumor_edge);
      fit_between(*seen, now, now, dullness, dullness, modulus_kpa, best);
      if (last) fit_between(*seen, *last, now, last_dullness, dullness, modulus_kpa, best);
      last = now;
      last_dullness = dullness;
    }
  }
  double seen_mean_abs_mm = 0.0;
  double seen_squares = 0.0;
  for (const double e : *seen) {
    seen_mean_abs_mm += std::abs(e) / kBins;
    seen_squares += std::pow(e - mean_of(*seen), 2) / kBins;
  }
  return PlannerFit{
      seen_mean_abs_mm, std::sqrt(seen_squares), best.rms_mm, best.dullness, best.modulus_kpa, best.bias_mm, open};
}

}  // namespace incise::testing
