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

/// A cut that was photographed. Profiles are those of error_profile: sectors from the start direction on.
struct RingObservation {
  RingCovariates ring;
  std::vector<double> photographed_mm;  ///< signed error as if cut along the planned path
  std::vector<double> simulated_mm;     ///< of a simulated cut along it, its bias added; zeros: no simulation
};

/// The fitted specimens of a calibration. Empty: it has no fit, or is of an older version and lacks rings or errors.
[[nodiscard]] std::vector<RingObservation> ring_observations(const Calibration& calibration);

/// Mean of what was photographed by direction in the view, wherever each cut started, for a ring that starts there: by
/// sector from its start on, linear between sectors, mm. @throws InvalidArgument without observations, or where their
/// sectors differ in number.
[[nodiscard]] std::vector<double> photographed_in_view(std::span<const RingObservation> observations, double start_deg);

/// The share of simulated differences with which a simulation can be used, and with which it is no surprise.
inline constexpr Range kUsableShare{-1.0, 3.0};
inline constexpr Range kLikelyShare{0.0, 2.0};

/// Standard deviations, mm, of what makes photographs differ from a simulation, and angles over which correlations fall
/// to 1/e; estimated.
struct RingSpreads {
  double by_start_mm = 0.2;  ///< common to all cuts, by direction from the start
  double in_view_mm = 0.2;   ///< common to all cuts, by direction in the view
  double hand_eye_mm = 0.5;  ///< of the common offset in the view, along each axis
  double own_mm = 0.25;      ///< of each cut by itself: along the ring …
  double level_mm = 0.25;    ///< … all round …
  double shift_mm = 0.25;    ///< … and of its offset, along each axis
  double reading_mm = 0.12;  ///< of a sector's reading
  double common_deg = 60.0;  ///< of the two common ones
  double own_deg = 40.0;
  double common_mm = 0.5;      ///< of the mean error that all cuts have in common; not estimated
  double share = 0.5;          ///< of the share of simulated differences about 1; not estimated; 0 without a simulation
  double along_mm = 0.2;       ///< what a cut is shifted along the pull per step of its place along it …
  double aside_mm = 0.2;       ///< … and across it per step of its place across it
  CovariateValues slope_mm{};  ///< what the mean error gains per step of each covariate (see ring_forecast.cpp)
};
void describe(Visitor& v, RingSpreads& s);

/// What photographs say of a cut that is not made yet. It is expected to err by
/// simulated_share · (simulated error + bias) + residual_mm, sector by sector.
struct RingForecast {
  double simulated_share = 1.0;     ///< 0 without a simulation
  double share_sd = 0.0;            ///< with which that share is known; not a part of the deviations below
  std::vector<double> residual_mm;  ///< by sector
  std::vector<double> sd_mm;  ///< of one photograph about the forecast, by sector, as if the share were known exactly
  double level_sd_mm = 0.0;   ///< likewise of its mean round the ring
  std::vector<std::string_view> unlike;  ///< see outside_covariates
};
void describe(Visitor& v, RingForecast& f);

/// What photographs say of a cut that has been simulated: by how much its photograph is expected to differ from the
/// simulation, and how far that is known.
struct RingPrediction {
  double simulated_share = 1.0;     ///< how much of simulated differences is expected; it is in the residual already
  std::vector<double> residual_mm;  ///< expected photographed less simulated error, by sector
  Eigen::MatrixXd covariance_mm2;  ///< of one photograph about that, between sectors: scale of Student's distribution …
  std::size_t degrees = 0;         ///< … of so many degrees of freedom, because the spreads are estimated
  std::vector<std::string_view> unlike;  ///< see outside_covariates
};

/// The offset that all photographs of a series have in common in the view, x and y, mm.
struct HandEyeEstimate {
  Vec2 offset_mm = Vec2::Zero();
  Vec2 sd_mm = Vec2::Zero();
  /// Ends of the 95 % credible interval.
  [[nodiscard]] Vec2 low_mm() const { return offset_mm - kNormal95 * sd_mm; }
  [[nodiscard]] Vec2 high_mm() const { return offset_mm + kNormal95 * sd_mm; }
};
void describe(Visitor& v, HandEyeEstimate& e);

/// Photographs y of specimens s with simulated errors m, as waves of at most four to a turn, θ from the start:
///     y_s(θ) = m_s(θ) + β (m_s − m̄)(θ) + b + c · x_s + f(θ) + g(θ + α_s) + (h + e_s) · n(θ + α_s) + own_s(θ)
/// b is common, x_s are the covariates about their mean, f and g Gaussian processes round the ring, α_s the start's
/// direction in the view, h the hand-eye offset, e_s a shift that grows with the tumour's place along and across the
/// pull, own_s of each cut by itself. All is linear and normal given the spreads; these are the most probable ones
/// under half-normal priors, found by a pattern search. Without observations it is the simulation. Source:
/// [RasmussenWilliams2006, 2.2, 2.7, 5.4.1].
class RingForecaster {
 public:
  /// @param has_simulation  else simulated errors are taken for 0 and β is left out: photographs alone.
  /// @throws InvalidArgument for profiles of different lengths, of fewer than 9 sectors, or not finite.
  /// @note O(evaluations · (9 n)³), n observations, up to 2300 evaluations: half a second for 20, 13 s for 50; a
  /// forecast O((9 n)²).
  RingForecaster(std::vector<RingObservation> observations, bool has_simulation);
  ~RingForecaster();
  RingForecaster(RingForecaster&&) noexcept;

  /// @param sectors  of the forecast's lists; that of the observations where there are some.
  [[nodiscard]] RingForecast forecast(const RingCovariates& ring, std::size_t sectors = 36) const;
  /// What the photograph of this ring is expected to show beyond a simulated cut along the planned path.
  /// @param simulated_mm   its errors by sector, 9 or more, the calibration's bias added; empty: not known, and taken
  /// for the observations' mean.
  /// @param ln_modulus_sd  of the logarithm of the ring's Young's modulus, where no pull tells it; else 0.
  /// @throws InvalidArgument for fewer sectors, errors that are not finite, or a spread below 0.
  [[nodiscard]] RingPrediction predict(const RingCovariates& ring, const std::vector<double>& simulated_mm,
                                       double ln_modulus_sd = 0.0, std::size_t sectors = 36) const;
  [[nodiscard]] HandEyeEstimate hand_eye() const;
  [[nodiscard]] const RingSpreads& spreads() const;
  /// Whether the search for the spreads ended by itself, and not by its limit of 60 rounds.
  [[nodiscard]] bool is_converged() const;

 private:
  struct Posterior;
  std::unique_ptr<const Posterior> posterior_;
};

}  // namespace incise
