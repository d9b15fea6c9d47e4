#pragma once

#include <incise/calibration/calibration.hpp>
#include <incise/calibration/ring_covariates.hpp>
#include <incise/core/describe.hpp>
#include <incise/evaluation/statistics.hpp>
#include <incise/geometry/types.hpp>

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace incise {

/// A photographed cut. Profiles are by sector from the start direction, as in error_profile.
struct RingObservation {
  RingCovariates ring;
  std::vector<double> photographed_mm;  ///< signed error as if cut along the planned path
  std::vector<double> simulated_mm;     ///< signed error of a simulated cut along it, bias added; zeros: none simulated
};

/// Returns the fitted specimens of a calibration as observations. Empty if the calibration has no fit, or comes from an
/// older version without rings or errors.
[[nodiscard]] std::vector<RingObservation> ring_observations(const Calibration& calibration);

/// Returns the mean photographed error by direction in the view, wherever each cut started: signed errors, mm, by
/// sector of a ring that starts at `start_deg` (in the view, counter-clockwise from its x), interpolated between
/// sectors.
/// @throws InvalidArgument without observations, or if their numbers of sectors differ.
[[nodiscard]] std::vector<double> photographed_in_view(std::span<const RingObservation> observations, double start_deg);

/// Range of the simulated share in which a simulation can be used, and range in which the share is no surprise.
inline constexpr Range kUsableShare{-1.0, 3.0};
inline constexpr Range kLikelyShare{0.0, 2.0};

/// Standard deviations, mm, of the causes by which photographs differ from a simulation, and angles, degrees, over
/// which their correlations fall to 1/e. Estimated, unless stated otherwise.
struct RingSpreads {
  double by_start_mm = 0.2;    ///< common to all cuts, by direction from the start
  double in_view_mm = 0.2;     ///< common to all cuts, by direction in the view
  double hand_eye_mm = 0.5;    ///< of the common offset in the view, along each axis
  double own_mm = 0.25;        ///< of each cut alone: along the ring …
  double level_mm = 0.25;      ///< … all round …
  double shift_mm = 0.25;      ///< … and of its offset, along each axis
  double reading_mm = 0.12;    ///< of a sector's reading
  double common_deg = 60.0;    ///< of by_start_mm and in_view_mm
  double own_deg = 40.0;       ///< of own_mm
  double common_mm = 0.5;      ///< of the mean error that all cuts share; not estimated
  double share = 0.5;          ///< of the share of simulated differences about 1; not estimated; 0 without a simulation
  double along_mm = 0.2;       ///< shift of a cut along the pull per step of its place along the pull …
  double aside_mm = 0.2;       ///< … and across the pull per step of its place across it
  CovariateValues slope_mm{};  ///< change of the mean error per step of each covariate (see ring_forecast.cpp)
};
void describe(Visitor& v, RingSpreads& s);

/// Forecast, from photographs of earlier cuts, of a cut that has not been made. The cut is expected to err by
/// simulated_share · (simulated error + bias) + residual_mm, sector by sector.
struct RingForecast {
  double simulated_share = 1.0;          ///< 0 without a simulation
  double share_sd = 0.0;                 ///< standard deviation of that share; not part of the deviations below
  std::vector<double> residual_mm;       ///< by sector
  std::vector<double> sd_mm;             ///< of one photograph about the forecast, by sector, taking the share as exact
  double level_sd_mm = 0.0;              ///< likewise, of its mean round the ring
  std::vector<std::string_view> unlike;  ///< see outside_covariates
};
void describe(Visitor& v, RingForecast& f);

/// Prediction, from photographs of earlier cuts, of how the photograph of a simulated cut will differ from the
/// simulation, with its uncertainty.
struct RingPrediction {
  double simulated_share = 1.0;     ///< expected real difference per simulated difference; contained in residual_mm
  std::vector<double> residual_mm;  ///< expected photographed less simulated error, by sector
  Eigen::MatrixXd covariance_mm2;  ///< of one photograph about that, between sectors: scale of Student's distribution …
  std::size_t degrees = 0;         ///< … with this many degrees of freedom, because the spreads are estimated
  std::vector<std::string_view> unlike;  ///< see outside_covariates
};

/// Estimate of the hand-eye offset, which all photographs of a series share: x and y in the view, mm.
struct HandEyeEstimate {
  Vec2 offset_mm = Vec2::Zero();
  Vec2 sd_mm = Vec2::Zero();
  /// Ends of the 95 % credible interval.
  [[nodiscard]] Vec2 low_mm() const { return offset_mm - kNormal95 * sd_mm; }
  [[nodiscard]] Vec2 high_mm() const { return offset_mm + kNormal95 * sd_mm; }
};
void describe(Visitor& v, HandEyeEstimate& e);

/// Forecasts the photograph of a ring from photographs of earlier cuts. The model of the photographed errors y_s of
/// specimen s, with simulated errors m_s, in waves of at most four per turn, θ from the start:
///     y_s(θ) = m_s(θ) + β (m_s − m̄)(θ) + b + c · x_s + f(θ) + g(θ + α_s) + (h + e_s) · n(θ + α_s) + own_s(θ)
/// b is common to all cuts, x_s are the covariates about their mean, f and g are Gaussian processes round the ring, α_s
/// is the direction of the start in the view, n the unit vector in a direction, h the hand-eye offset, e_s a shift that
/// grows with the tumour's place along and across the pull, and own_s belongs to the cut alone. Given the spreads, the
/// model is linear and normal. The spreads are the most probable ones under half-normal priors (log-normal for angles),
/// found by a pattern search. Without observations the forecast is the simulation. Source: [RasmussenWilliams2006, 2.2,
/// 2.7, 5.4.1].
class RingForecaster {
 public:
  /// @param has_simulation  if false, simulated errors are taken as 0 and β is left out: photographs alone.
  /// @throws InvalidArgument for profiles of different lengths, of fewer than 9 sectors, or not finite.
  /// @note O(evaluations · (9 n)³) for n observations, with up to 2300 evaluations: half a second for 20 observations,
  /// 13 s for 50. A forecast takes O((9 n)²).
  RingForecaster(std::vector<RingObservation> observations, bool has_simulation);
  ~RingForecaster();
  RingForecaster(RingForecaster&&) noexcept;

  /// Forecasts a ring that has not been simulated, in as many sectors as the observations have, or in 36 if there are
  /// none.
  [[nodiscard]] RingForecast forecast(const RingCovariates& ring) const;
  /// Predicts how the photograph of this ring will differ from a simulated cut along the planned path.
  /// @param simulated_mm   signed errors of that cut by sector, 9 or more, the calibration's bias added; empty:
  /// unknown, and assumed to be the observations' mean.
  /// @param ln_modulus_sd  standard deviation of ln(Young's modulus) of the ring if no pull was measured; otherwise 0.
  /// @throws InvalidArgument for fewer than 9 simulated errors, errors that are not finite, or ln_modulus_sd below 0.
  [[nodiscard]] RingPrediction predict(const RingCovariates& ring, const std::vector<double>& simulated_mm,
                                       double ln_modulus_sd = 0.0) const;
  [[nodiscard]] HandEyeEstimate hand_eye() const;
  [[nodiscard]] const RingSpreads& spreads() const;
  /// Whether the search for the spreads converged within its limit of 60 rounds.
  [[nodiscard]] bool is_converged() const;

 private:
  struct Posterior;
  std::unique_ptr<const Posterior> posterior_;
};

}  // namespace incise
