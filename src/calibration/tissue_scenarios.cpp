#include <incise/calibration/tissue_scenarios.hpp>
#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace incise {
namespace {

constexpr double kMiddleWeight = 1.0 / 3.0;
constexpr double kSideWeight = 1.0 / 6.0;
/// Keeps a posterior without spread in one direction (one stiffness, say) invertible.
constexpr double kLeastVariance = 1e-12;

struct ScenarioMoments {
  Vec3 mean = Vec3::Zero();  ///< drag length, ln stiffness factor, bias
  Mat3 covariance = Mat3::Zero();
};

Vec3 coordinates(const PosteriorSample& s) {
  return {s.drag_length_mm, std::log(s.stiffness_factor), s.bias_mm};
}

ScenarioMoments moments_of(const std::vector<PosteriorSample>& samples) {
  ScenarioMoments moments;
  double weights = 0.0;
  for (const PosteriorSample& s : samples) {
    INCISE_REQUIRE(
        s.weight > 0.0 && s.drag_length_mm > 0.0 && s.stiffness_factor > 0.0 && std::isfinite(s.bias_mm),
        fmt::format("expected samples with numbers above 0, found weight {}, drag length {} mm, stiffness {}", s.weight,
                    s.drag_length_mm, s.stiffness_factor));
    weights += s.weight;
    moments.mean += s.weight * coordinates(s);
  }
  moments.mean /= weights;
  for (const PosteriorSample& s : samples) {
    const Vec3 off = coordinates(s) - moments.mean;
    moments.covariance += s.weight / weights * off * off.transpose();
  }
  return moments;
}

}  // namespace

TissueScenarios tissue_scenarios(const std::vector<PosteriorSample>& samples, const ResidualEstimate& residual,
                                 double own_stiffness_sd) {
  INCISE_REQUIRE(!samples.empty(), "expected at least one sample of a posterior");
  INCISE_REQUIRE(own_stiffness_sd >= 0.0 && std::isfinite(own_stiffness_sd),
                 fmt::format("expected a spread of 0 or more, found {}", own_stiffness_sd));
  ScenarioMoments moments = moments_of(samples);
  moments.covariance(1, 1) += own_stiffness_sd * own_stiffness_sd;
  const auto by_drag = [](const PosteriorSample& a, const PosteriorSample& b) {
    return a.drag_length_mm < b.drag_length_mm;
  };
  const auto range = std::minmax_element(samples.begin(), samples.end(), by_drag);
  const double least_mm = range.first->drag_length_mm;
  const double most_mm = range.second->drag_length_mm;

  using Mat2 = Eigen::Matrix2d;
  const Mat2 simulated = moments.covariance.topLeftCorner<2, 2>() + kLeastVariance * Mat2::Identity();
  const Mat2 axes = simulated.llt().matrixL();
  const Vec2 bias_slope = simulated.ldlt().solve(moments.covariance.topRightCorner<2, 1>());
  TissueScenarios scenarios;
  const auto add = [&](double weight, const Vec2& off) {
    const double drag = std::clamp(moments.mean[0] + off[0], least_mm, most_mm);
    scenarios.points.push_back(
        {weight, drag, std::exp(moments.mean[1] + off[1]), moments.mean[2] + bias_slope.dot(off)});
  };
  add(kMiddleWeight, Vec2::Zero());
  for (const Eigen::Index axis : {0, 1}) {
    for (const double side : {-1.0, 1.0}) add(kSideWeight, side * std::numbers::sqrt3 * axes.col(axis));
  }
  const double left = moments.covariance(2, 2) - bias_slope.dot(moments.covariance.topRightCorner<2, 1>());
  scenarios.drag_length_sd_mm = std::sqrt(moments.covariance(0, 0));
  scenarios.ln_stiffness_sd = std::sqrt(moments.covariance(1, 1));
  scenarios.bias_sd_mm = std::hypot(std::sqrt(moments.covariance(2, 2)), residual.specimen_spread_mm);
  scenarios.common_sd_mm = std::hypot(std::sqrt(std::max(0.0, left)), residual.specimen_spread_mm);
  return scenarios;
}

}  // namespace incise
