#include "calibration/sector_noise.hpp"

#include <incise/calibration/ring_forecast.hpp>
#include <incise/core/error.hpp>
#include <incise/core/units.hpp>

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace incise {

using SlowWaves = Eigen::Matrix<double, static_cast<Eigen::Index>(kEntriesThatCount), 1>;

/// One observation, or the ring to forecast, ready for the covariance.
struct RingPlace {
  double start_deg = 0.0;
  double pull_deg = 90.0;
  CovariateValues steps{};                  ///< its covariates minus their mean, in steps
  double aside_steps = 0.0;                 ///< its signed place across the pull, from the body's middle, in steps
  SlowWaves simulated = SlowWaves::Zero();  ///< slow waves of the simulated error, minus the observations' mean
};

namespace {

constexpr auto kWaves = static_cast<Eigen::Index>(kEntriesThatCount);
using WaveMatrix = Eigen::Matrix<double, kWaves, kWaves>;

/// Steps of the covariates that are worth distinguishing: a quarter of the radius, a tenth of the body's length, half
/// of the modulus …; in the order of kRingCovariateNames.
constexpr CovariateValues kSteps{0.25, 0.05, 0.1, 3.0, 0.5, 1.0, 1.0, 0.4};

constexpr std::size_t kAlong = 2, kAside = 3, kModulus = 4;
static_assert(kRingCovariateNames[kAlong] == "along" && kRingCovariateNames[kAside] == "aside" &&
              kRingCovariateNames[kModulus] == "youngs_modulus");
/// The priors of the spreads count as this many observations. Chosen, as in distance_from.
constexpr std::size_t kPriorDegrees = 3;
/// Spread of the mean error common to all cuts, mm, without a simulation: anything that a cut can err.
constexpr double kCommonAloneMm = 2.0;

/// Scale of the half-normal prior of slopes; the other scales are in kEntries. Angles are log-normal about theirs.
constexpr double kSlopePriorMm = 0.15;
constexpr double kAngleSd = 0.5;

/// The spreads as a list, for the search over their logarithms.
struct SpreadEntry {
  double RingSpreads::*member;
  double prior;
  bool is_angle;
};
constexpr std::array kEntries{
    SpreadEntry{&RingSpreads::by_start_mm, 0.3, false}, SpreadEntry{&RingSpreads::in_view_mm, 0.3, false},
    SpreadEntry{&RingSpreads::hand_eye_mm, 1.0, false}, SpreadEntry{&RingSpreads::own_mm, 0.35, false},
    SpreadEntry{&RingSpreads::level_mm, 0.35, false},   SpreadEntry{&RingSpreads::shift_mm, 0.35, false},
    SpreadEntry{&RingSpreads::reading_mm, 0.2, false},  SpreadEntry{&RingSpreads::common_deg, 60.0, true},
    SpreadEntry{&RingSpreads::own_deg, 40.0, true},     SpreadEntry{&RingSpreads::along_mm, 0.2, false},
    SpreadEntry{&RingSpreads::aside_mm, 0.2, false}};

auto& entry_of(auto& spreads, std::size_t k) {
  return k < kEntries.size() ? spreads.*kEntries[k].member : spreads.slope_mm[k - kEntries.size()];
}
constexpr std::size_t kSpreads = kEntries.size() + std::tuple_size_v<CovariateValues>;

/// Log density of the prior of the spreads' logarithms, up to a constant.
double log_prior(const RingSpreads& spreads) {
  double sum = 0.0;
  for (std::size_t k = 0; k < kSpreads; ++k) {
    const double value = entry_of(spreads, k);
    if (k < kEntries.size() && kEntries[k].is_angle) {
      const double z = std::log(value / kEntries[k].prior) / kAngleSd;
      sum -= 0.5 * z * z;
    } else {
      const double z = value / (k < kEntries.size() ? kEntries[k].prior : kSlopePriorMm);
      sum += std::log(value) - 0.5 * z * z;
    }
  }
  return sum;
}

SlowWaves slow_waves(const std::vector<double>& profile) {
  return Eigen::Map<const SlowWaves>(ring_spectrum(profile).data());
}

std::vector<double> profile_of(const SlowWaves& waves, std::size_t sectors) {
  std::vector<double> spectrum(sectors, 0.0);
  for (Eigen::Index i = 0; i < kWaves; ++i) spectrum[static_cast<std::size_t>(i)] = waves[i];
  return ring_values(spectrum);
}

SlowWaves slow_eigenvalues(std::size_t sectors, double length_deg) {
  return Eigen::Map<const SlowWaves>(ring_eigenvalues(sectors, length_deg, kEntriesThatCount).data());
}

/// Returns the matrix that maps the waves of f(θ) to those of f(θ − angle).
WaveMatrix turned(double angle_deg) {
  WaveMatrix turn = WaveMatrix::Identity();
  for (Eigen::Index order = 1; 2 * order < kWaves; ++order) {
    const double angle = static_cast<double>(order) * units::rad_from_deg(angle_deg);
    turn.block<2, 2>(2 * order - 1, 2 * order - 1) << std::cos(angle), -std::sin(angle), std::sin(angle),
        std::cos(angle);
  }
  return turn;
}

/// Covariances between two cuts of everything that they have in common, for given spreads.
class CommonCovariance {
 public:
  CommonCovariance(const RingSpreads& spreads, std::size_t sectors)
      : spreads_(spreads), sectors_(static_cast<double>(sectors)) {
    const SlowWaves shape = slow_eigenvalues(sectors, spreads.common_deg);
    by_start_ = spreads.by_start_mm * spreads.by_start_mm * shape;
    in_view_ = spreads.in_view_mm * spreads.in_view_mm * shape;
    in_view_.segment<2>(1).array() += 0.5 * sectors_ * spreads.hand_eye_mm * spreads.hand_eye_mm;
  }
  [[nodiscard]] WaveMatrix between(const RingPlace& a, const RingPlace& b) const {
    WaveMatrix covariance = in_view_.asDiagonal() * turned(b.start_deg - a.start_deg);
    covariance.diagonal() += by_start_;
    for (std::size_t k = 0; k < a.steps.size(); ++k)
      covariance(0, 0) += sectors_ * spreads_.slope_mm[k] * spreads_.slope_mm[k] * a.steps[k] * b.steps[k];
    covariance(0, 0) += sectors_ * spreads_.common_mm * spreads_.common_mm;
    covariance.block<2, 2>(1, 1) += shift_between(spreads_.along_mm, a, 0.0, a.steps[kAlong], b, b.steps[kAlong]) +
                                    shift_between(spreads_.aside_mm, a, 90.0, a.aside_steps, b, b.aside_steps);
    covariance += spreads_.share * spreads_.share * a.simulated * b.simulated.transpose();
    return covariance;
  }
  /// Between a cut and the hand-eye offset, mm.
  [[nodiscard]] Eigen::Matrix<double, kWaves, 2> with_hand_eye(const RingPlace& a) const {
    Eigen::Matrix<double, kWaves, 2> covariance = Eigen::Matrix<double, kWaves, 2>::Zero();
    const double variance = spreads_.hand_eye_mm * spreads_.hand_eye_mm;
    covariance.block<2, 2>(1, 0) = std::sqrt(0.5 * sectors_) * variance * turned(-a.start_deg).block<2, 2>(1, 1);
    return covariance;
  }

 private:
  /// Covariance of shifts in a direction, counter-clockwise from the pull, by the given steps.
  [[nodiscard]] Eigen::Matrix2d shift_between(double spread_mm, const RingPlace& a, double from_pull_deg,
                                              double a_steps, const RingPlace& b, double b_steps) const {
    const auto direction = [from_pull_deg](const RingPlace& place) {
      const double angle = units::rad_from_deg(place.pull_deg + from_pull_deg - place.start_deg);
      return Eigen::Vector2d(std::cos(angle), std::sin(angle));
    };
    return 0.5 * sectors_ * spread_mm * spread_mm * a_steps * b_steps * direction(a) * direction(b).transpose();
  }

  const RingSpreads& spreads_;
  double sectors_;
  SlowWaves by_start_, in_view_;
};

/// Variance of each wave of the part that belongs to one cut alone.
SlowWaves own_variances(const RingSpreads& spreads, std::size_t sectors) {
  SlowWaves own = spreads.own_mm * spreads.own_mm * slow_eigenvalues(sectors, spreads.own_deg);
  const auto count = static_cast<double>(sectors);
  own.array() += spreads.reading_mm * spreads.reading_mm;
  own[0] += count * spreads.level_mm * spreads.level_mm;
  own.segment<2>(1).array() += 0.5 * count * spreads.shift_mm * spreads.shift_mm;
  return own;
}

Eigen::MatrixXd covariance_of(const std::vector<RingPlace>& places, const RingSpreads& spreads, std::size_t sectors) {
  const CommonCovariance common(spreads, sectors);
  const SlowWaves own = own_variances(spreads, sectors);
  const auto count = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd covariance(count * kWaves, count * kWaves);
  for (Eigen::Index a = 0; a < count; ++a) {
    for (Eigen::Index b = 0; b <= a; ++b)
      covariance.block<kWaves, kWaves>(a * kWaves, b * kWaves) =
          common.between(places[static_cast<std::size_t>(a)], places[static_cast<std::size_t>(b)]);
    covariance.block<kWaves, kWaves>(a * kWaves, a * kWaves).diagonal() += own;
  }
  return covariance;  // only its lower half is set
}

/// Log density of the spreads' posterior, up to a constant; minus infinity if the covariance is not positive definite.
double log_posterior(const std::vector<RingPlace>& places, const Eigen::VectorXd& rest, const RingSpreads& spreads,
                     std::size_t sectors) {
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance_of(places, spreads, sectors));
  if (factor.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
  const double misfit = factor.matrixL().solve(rest).squaredNorm();
  const double log_determinant = factor.matrixLLT().diagonal().array().log().sum();
  return log_prior(spreads) - 0.5 * misfit - log_determinant;
}

/// Finds the most probable spreads by a pattern search: each in turn is multiplied or divided by a factor, which
/// shrinks when nothing improves. Returns whether not even a factor as small as the last one improves any spread.
bool find_spreads(const std::vector<RingPlace>& places, const Eigen::VectorXd& rest, RingSpreads& spreads,
                  std::size_t sectors) {
  constexpr double kFirstFactor = 2.0, kLastFactor = 1.1;
  constexpr int kMostRounds = 60;
  double best = log_posterior(places, rest, spreads, sectors), factor = kFirstFactor;
  for (int round = 0; round < kMostRounds && factor > kLastFactor; ++round) {
    bool is_better = false;
    for (std::size_t k = 0; k < kSpreads; ++k) {
      for (const double change : {factor, 1.0 / factor}) {
        RingSpreads tried = spreads;
        entry_of(tried, k) *= change;
        const double found = log_posterior(places, rest, tried, sectors);
        if (found <= best) continue;
        best = found;
        spreads = tried;
        is_better = true;
        break;
      }
    }
    if (!is_better) factor = std::sqrt(factor);
  }
  return factor <= kLastFactor;
}

}  // namespace

std::vector<RingObservation> ring_observations(const Calibration& calibration) {
  std::vector<RingObservation> observations;
  if (!calibration.fit) return observations;
  const std::vector<SpecimenFit>& fitted = calibration.fit->specimens;
  for (std::size_t s = 0; s < fitted.size(); ++s) {
    const std::optional<RingCovariates>& ring = calibration.specimens[s].ring;
    if (ring) observations.push_back({*ring, fitted[s].observed_mm, fitted[s].fitted_mm});
  }
  return observations;
}

std::vector<double> photographed_in_view(std::span<const RingObservation> observations, double start_deg) {
  INCISE_REQUIRE(!observations.empty(), "expected at least one photograph");
  const std::size_t sectors = observations.front().photographed_mm.size();
  std::vector<double> mean(sectors, 0.0);
  for (const RingObservation& one : observations) {
    INCISE_REQUIRE(one.photographed_mm.size() == sectors,
                   fmt::format("expected {} sectors, found {}", sectors, one.photographed_mm.size()));
    const double shift = (start_deg - one.ring.start_deg) * static_cast<double>(sectors) / 360.0;
    const double whole = std::floor(shift), part = shift - whole;
    const auto at = [&](std::size_t i, double by) {
      const auto n = static_cast<double>(sectors), place = static_cast<double>(i) + by;
      return one.photographed_mm[static_cast<std::size_t>(place - n * std::floor(place / n)) % sectors];
    };
    for (std::size_t i = 0; i < sectors; ++i)
      mean[i] += ((1.0 - part) * at(i, whole) + part * at(i, whole + 1.0)) / static_cast<double>(observations.size());
  }
  return mean;
}

struct RingForecaster::Posterior {
  std::vector<RingObservation> observations;
  bool has_simulation = false;
  std::size_t sectors = 36;  ///< of all lists: that of the observations; 36 without any
  RingSpreads spreads;
  bool is_converged = true;
  CovariateValues mean{};
  SlowWaves simulated_mean = SlowWaves::Zero();
  std::vector<RingPlace> places;
  Eigen::LLT<Eigen::MatrixXd> factor;
  Eigen::VectorXd weights;  ///< covariance⁻¹ · (photographed − simulated)
  double fast_mm = 0.12;    ///< rms, per sector, of the fast waves, which are not forecast

  [[nodiscard]] RingPlace place_of(const RingCovariates& ring) const {
    RingPlace place{.start_deg = ring.start_deg, .pull_deg = ring.pull_deg};
    place.aside_steps = ring.aside_mm / kSteps[kAside];
    const CovariateValues values = values_of(ring);
    for (std::size_t k = 0; k < values.size(); ++k) place.steps[k] = (values[k] - mean[k]) / kSteps[k];
    return place;
  }
  /// Returns the expected simulated share minus 1; 0 without observations.
  [[nodiscard]] double share() const {
    double share = 0.0;
    for (std::size_t s = 0; s < places.size(); ++s)
      share += places[s].simulated.dot(weights.segment<kWaves>(static_cast<Eigen::Index>(s) * kWaves));
    return share * spreads.share * spreads.share;
  }
  /// Slow waves expected of one more photograph minus its simulation, and their covariance.
  struct Expected {
    SlowWaves mean = SlowWaves::Zero();
    WaveMatrix covariance = WaveMatrix::Zero();
  };
  [[nodiscard]] Expected expect(const RingPlace& place) const {
    const CommonCovariance common(spreads, sectors);
    Expected expected;
    expected.covariance = common.between(place, place);
    expected.covariance.diagonal() += own_variances(spreads, sectors);
    if (places.empty()) return expected;
    Eigen::MatrixXd cross(kWaves, weights.size());  // covariances with all observations
    for (std::size_t s = 0; s < places.size(); ++s)
      cross.middleCols<kWaves>(static_cast<Eigen::Index>(s) * kWaves) = common.between(place, places[s]);
    expected.mean = cross * weights;
    expected.covariance -= cross * factor.solve(cross.transpose());
    return expected;
  }
  /// Returns the covariance between sectors of the slow waves and of the fast ones, which are not forecast.
  [[nodiscard]] Eigen::MatrixXd between_sectors(const WaveMatrix& covariance) const {
    const auto rows = static_cast<Eigen::Index>(sectors);
    Eigen::MatrixXd basis(rows, kWaves);
    for (Eigen::Index k = 0; k < kWaves; ++k) {
      const std::vector<double> wave = profile_of(SlowWaves::Unit(k), sectors);
      basis.col(k) = Eigen::Map<const Eigen::VectorXd>(wave.data(), rows);
    }
    Eigen::MatrixXd sectors_covariance = basis * covariance * basis.transpose();
    sectors_covariance.diagonal().array() += fast_mm * fast_mm;
    return sectors_covariance;
  }
  /// Returns the names of the covariates outside the observations' range; empty without observations.
  [[nodiscard]] std::vector<std::string_view> unlike(const RingCovariates& ring) const {
    if (observations.empty()) return {};
    std::vector<RingCovariates> rings;
    for (const RingObservation& one : observations) rings.push_back(one.ring);
    std::vector<std::string_view> names;
    for (const std::size_t k : outside_covariates(ring, rings)) names.push_back(kRingCovariateNames[k]);
    return names;
  }
};

RingForecaster::RingForecaster(std::vector<RingObservation> observations, bool has_simulation) {
  auto made = std::make_unique<Posterior>();
  Posterior& p = *made;
  posterior_ = std::move(made);
  p.has_simulation = has_simulation;
  p.spreads.slope_mm.fill(0.1);
  if (!has_simulation) {
    p.spreads.share = 0.0;
    p.spreads.common_mm = kCommonAloneMm;
  }
  if (observations.empty()) return;
  p.sectors = observations.front().photographed_mm.size();
  INCISE_REQUIRE(p.sectors >= kEntriesThatCount,
                 fmt::format("expected at least {} sectors, found {}", kEntriesThatCount, p.sectors));
  const auto count = static_cast<double>(observations.size());
  double fast_squares = 0.0;
  for (RingObservation& one : observations) {
    if (!has_simulation) one.simulated_mm.assign(p.sectors, 0.0);
    INCISE_REQUIRE(one.photographed_mm.size() == p.sectors && one.simulated_mm.size() == p.sectors,
                   fmt::format("expected {} sectors, found {} photographed and {} simulated", p.sectors,
                               one.photographed_mm.size(), one.simulated_mm.size()));
    for (const double value : one.photographed_mm) INCISE_REQUIRE(std::isfinite(value), "expected finite errors");
    for (const double value : one.simulated_mm) INCISE_REQUIRE(std::isfinite(value), "expected finite errors");
    const std::vector<double> slow = without_fast_waves(one.photographed_mm);
    for (std::size_t i = 0; i < p.sectors; ++i)
      fast_squares += std::pow(one.photographed_mm[i] - slow[i], 2) / (count * static_cast<double>(p.sectors));
    const CovariateValues values = values_of(one.ring);
    for (std::size_t k = 0; k < values.size(); ++k) p.mean[k] += values[k] / count;
    p.simulated_mean += slow_waves(one.simulated_mm) / count;
  }
  p.fast_mm = std::sqrt(fast_squares);
  Eigen::VectorXd rest(static_cast<Eigen::Index>(observations.size()) * kWaves);
  for (std::size_t s = 0; s < observations.size(); ++s) {
    const SlowWaves simulated = slow_waves(observations[s].simulated_mm);
    RingPlace place = p.place_of(observations[s].ring);
    place.simulated = simulated - p.simulated_mean;
    p.places.push_back(place);
    rest.segment<kWaves>(static_cast<Eigen::Index>(s) * kWaves) =
        slow_waves(observations[s].photographed_mm) - simulated;
  }
  p.is_converged = find_spreads(p.places, rest, p.spreads, p.sectors);
  p.factor.compute(covariance_of(p.places, p.spreads, p.sectors));
  p.weights = p.factor.solve(rest);
  p.observations = std::move(observations);
}

RingForecaster::~RingForecaster() = default;
RingForecaster::RingForecaster(RingForecaster&&) noexcept = default;

const RingSpreads& RingForecaster::spreads() const {
  return posterior_->spreads;
}

bool RingForecaster::is_converged() const {
  return posterior_->is_converged;
}

RingForecast RingForecaster::forecast(const RingCovariates& ring) const {
  const Posterior& p = *posterior_;
  RingForecast forecast{.simulated_share = p.has_simulation ? 1.0 + p.share() : 0.0, .share_sd = p.spreads.share};
  const std::size_t count = p.sectors;
  // The ring is taken as an average simulated one: the share covers its difference.
  const Posterior::Expected expected = p.expect(p.place_of(ring));
  if (!p.places.empty()) {
    const double prior = p.spreads.share * p.spreads.share;
    Eigen::VectorXd differences(p.weights.size());
    for (std::size_t s = 0; s < p.places.size(); ++s)
      differences.segment<kWaves>(static_cast<Eigen::Index>(s) * kWaves) = p.places[s].simulated;
    forecast.share_sd = std::sqrt(std::max(0.0, prior - prior * prior * differences.dot(p.factor.solve(differences))));
  }
  forecast.unlike = p.unlike(ring);
  forecast.residual_mm = profile_of(expected.mean - p.share() * p.simulated_mean, count);
  forecast.level_sd_mm = std::sqrt(std::max(0.0, expected.covariance(0, 0)) / static_cast<double>(count));
  const Eigen::MatrixXd covariance = p.between_sectors(expected.covariance);
  for (const double variance : covariance.diagonal()) forecast.sd_mm.push_back(std::sqrt(std::max(0.0, variance)));
  return forecast;
}

RingPrediction RingForecaster::predict(const RingCovariates& ring, const std::vector<double>& simulated_mm,
                                       double ln_modulus_sd) const {
  const Posterior& p = *posterior_;
  const std::size_t count = p.sectors;
  INCISE_REQUIRE(simulated_mm.empty() || simulated_mm.size() >= kEntriesThatCount,
                 fmt::format("expected at least {} sectors, found {}", kEntriesThatCount, simulated_mm.size()));
  for (const double value : simulated_mm) INCISE_REQUIRE(std::isfinite(value), "expected finite errors");
  INCISE_REQUIRE(ln_modulus_sd >= 0.0 && std::isfinite(ln_modulus_sd), "expected a spread of 0 or more");
  RingPlace place = p.place_of(ring);
  if (!simulated_mm.empty()) {
    // A wave's entry grows with the root of the number of sectors.
    const double scale = std::sqrt(static_cast<double>(count) / static_cast<double>(simulated_mm.size()));
    place.simulated = scale * slow_waves(simulated_mm) - p.simulated_mean;
  }
  Posterior::Expected expected = p.expect(place);
  expected.covariance(0, 0) +=
      static_cast<double>(count) * std::pow(p.spreads.slope_mm[kModulus] * ln_modulus_sd / kSteps[kModulus], 2);
  return {.simulated_share = p.has_simulation ? 1.0 + p.share() : 0.0,
          .residual_mm = profile_of(expected.mean, count),
          .covariance_mm2 = p.between_sectors(expected.covariance),
          .degrees = p.places.size() + kPriorDegrees,
          .unlike = p.unlike(ring)};
}

HandEyeEstimate RingForecaster::hand_eye() const {
  const Posterior& p = *posterior_;
  HandEyeEstimate estimate;
  Eigen::Matrix2d variance = Eigen::Matrix2d::Identity() * p.spreads.hand_eye_mm * p.spreads.hand_eye_mm;
  if (!p.places.empty()) {
    const CommonCovariance common(p.spreads, p.sectors);
    Eigen::MatrixXd cross(2, p.weights.size());
    for (std::size_t s = 0; s < p.places.size(); ++s)
      cross.middleCols<kWaves>(static_cast<Eigen::Index>(s) * kWaves) = common.with_hand_eye(p.places[s]).transpose();
    estimate.offset_mm = cross * p.weights;
    variance -= cross * p.factor.solve(cross.transpose());
  }
  estimate.sd_mm = variance.diagonal().cwiseMax(0.0).cwiseSqrt();
  return estimate;
}

void describe(Visitor& v, RingSpreads& s) {
  v({"by_start_mm", "Spread of the error common to all cuts, by direction from the start.", "mm"}, s.by_start_mm);
  v({"in_view_mm", "Spread of the error common to all cuts, by direction in the view.", "mm"}, s.in_view_mm);
  v({"hand_eye_mm", "Spread of the common offset in the view, along each axis.", "mm"}, s.hand_eye_mm);
  v({"own_mm", "Spread of each cut's own error, along the ring.", "mm"}, s.own_mm);
  v({"level_mm", "Spread of the part of that error that is the same all round.", "mm"}, s.level_mm);
  v({"shift_mm", "Spread of each cut's own offset, along each axis.", "mm"}, s.shift_mm);
  v({"reading_mm", "Spread of a sector's reading.", "mm"}, s.reading_mm);
  v({"common_deg", "Angle over which the correlation of the errors common to all cuts falls to 1/e.", "deg"},
    s.common_deg);
  v({"own_deg", "Angle over which the correlation of each cut's own error falls to 1/e.", "deg"}, s.own_deg);
  v({"common_mm", "Spread of the mean error that all cuts have in common; not estimated.", "mm"}, s.common_mm);
  v("share", s.share, "Spread of the share of simulated differences about 1; not estimated.");
  v({"along_mm", "Spread of a cut's shift along the pull per step of its place along the pull.", "mm"}, s.along_mm);
  v({"aside_mm", "Spread of a cut's shift across the pull per step of its place across it.", "mm"}, s.aside_mm);
  v.begin({"slope_mm", "Change of the mean error per step of each covariate, standard deviation.", "mm"});
  for (std::size_t k = 0; k < s.slope_mm.size(); ++k)
    v({kRingCovariateNames[k], "Change of the mean error per step of this covariate.", "mm"}, s.slope_mm[k]);
  v.end();
}

void describe(Visitor& v, HandEyeEstimate& e) {
  v.derived("offset_mm", std::vector{e.offset_mm.x(), e.offset_mm.y()}, "Hand-eye offset along x and y of the view.");
  v.derived("sd_mm", std::vector{e.sd_mm.x(), e.sd_mm.y()}, "Standard deviations of the offset.");
  v.derived("low_mm", std::vector{e.low_mm().x(), e.low_mm().y()}, "Lower ends of the 95 % intervals.");
  v.derived("high_mm", std::vector{e.high_mm().x(), e.high_mm().y()}, "Upper ends of the 95 % intervals.");
}

void describe(Visitor& v, RingForecast& f) {
  v.derived("simulated_share", f.simulated_share, "Share of the simulated error, its bias included, that is expected.");
  v.derived("share_sd", f.share_sd, "Standard deviation of that share.");
  v.derived("residual_mm", f.residual_mm, "Error expected beyond that share, by sector from the start direction on.");
  v.derived("sd_mm", f.sd_mm,
            "Standard deviation of one photograph about the forecast, by sector, taking the share as exact.");
  v.derived(
      "level_sd_mm", f.level_sd_mm,
      "Standard deviation of the photograph's mean round the ring about the forecast, taking the share as exact.");
  std::vector<std::string> unlike(f.unlike.begin(), f.unlike.end());
  v.derived("unlike", unlike, "Covariates outside the observations' 10th to 90th percentile, except the outline.");
}

}  // namespace incise
