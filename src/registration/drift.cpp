#include "registration/gauss_field.hpp"
#include "registration/matching.hpp"

#include <incise/core/anderson.hpp>
#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/core/units.hpp>

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace incise {
namespace {

constexpr std::size_t kPointsInAChunk = 64;
constexpr double kSlow = 0.03;        // relative change of the width per step below which steps are accelerated
constexpr double kLeastRatio = 0.9;   // of successive steps: no fit of surfaces converges faster for long
constexpr double kWide = 0.25;        // in radii of the target: above this width the scale is held

/// Adds the contribution of one target point.
void add(MatchSums& sums, const Vec3& x, double weight, const GaussSum& near, double noise) {
  const double all = near.weight + noise;
  if (!(all > 0.0)) return;
  const double share = weight / all;
  const double matched = share * near.weight;
  sums.count += matched;
  sums.target += matched * x;
  sums.source += share * near.first;
  sums.cross += share * x * near.first.transpose();
  sums.target_squares += matched * x.squaredNorm();
  sums.source_squares += share * near.second;
}

void add(MatchSums& sums, const MatchSums& part) {
  sums.count += part.count;
  sums.target += part.target;
  sums.source += part.source;
  sums.cross += part.cross;
  sums.target_squares += part.target_squares;
  sums.source_squares += part.source_squares;
}

/// The rotation R that best turns y onto x, given cross = Σ x yᵀ: it maximises the gain tr(crossᵀ R).
struct BestRotation {
  Mat3 rotation = Mat3::Identity();
  double gain = 0.0;
  bool is_degenerate = false;
};

BestRotation best_rotation(const Mat3& cross, int dimensions) {
  BestRotation best;
  if (dimensions == 2) {
    const double along = cross(0, 0) + cross(1, 1);
    const double across = cross(1, 0) - cross(0, 1);
    best.gain = std::hypot(along, across);
    best.is_degenerate = !(best.gain > 0.0);
    best.rotation = Eigen::AngleAxisd(std::atan2(across, along), Vec3::UnitZ()).toRotationMatrix();
    return best;
  }
  const Eigen::JacobiSVD<Mat3> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 signs = Vec3::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0)
    signs[2] = -1.0;  // a reflection is never the answer
  best.rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  best.gain = svd.singularValues().dot(signs);
  best.is_degenerate = !(svd.singularValues()[1] > 1e-12 * svd.singularValues()[0]);
  return best;
}

/// Returns the mean squared distance of all pairs divided by the number of dimensions: the square of the first width.
double all_pairs_variance(const WeightedPoints& source, const WeightedPoints& target, const Similarity& t,
                          int dimensions) {
  const auto moments = [](const WeightedPoints& cloud) {
    double count = 0.0;
    Vec3 mean = Vec3::Zero();
    double squares = 0.0;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      count += cloud.weights[i];
      mean += cloud.weights[i] * cloud.points[i];
      squares += cloud.weights[i] * cloud.points[i].squaredNorm();
    }
    mean /= count;
    return std::pair(mean, squares / count - mean.squaredNorm());
  };
  const auto [source_mean, source_spread] = moments(source);
  const auto [target_mean, target_spread] = moments(target);
  return (t.scale * t.scale * source_spread + target_spread + (t(source_mean) - target_mean).squaredNorm()) /
         dimensions;
}

/// Returns the root mean square distance between two transforms of centred points with this scatter (mean of y yᵀ).
double rms_step(const Similarity& a, const Similarity& b, const Mat3& scatter) {
  const Mat3 change = a.scale * a.rotation - b.scale * b.rotation;
  return std::sqrt(std::max(0.0, (change * scatter * change.transpose()).trace()) +
                   (a.translation_mm - b.translation_mm).squaredNorm());
}

using Acceleration = Anderson<8>;  // of scale, rotation, translation and width

/// EM in normalised coordinates: both clouds centred and divided by the target's radius.
class Expectation {
 public:
  Expectation(const Points& source, const Points& target, const DriftSettings& settings, Workers& workers)
      : settings_(settings), workers_(workers) {
    if (settings.coarse_to_fine) {
      source_ = levels_of(source);
      target_ = levels_of(target);
    } else {
      source_ = {{source, std::vector<double>(source.size(), 1.0), 0.0}};
      target_ = {{target, std::vector<double>(target.size(), 1.0), 0.0}};
    }
    for (const Vec3& p : source) scatter_ += p * p.transpose() / static_cast<double>(source.size());
  }

  void run(CoherentPointDrift& drift, Monitor& monitor) {
    Similarity& t = drift.T_target_source;
    double sigma = settings_.first_sigma
                       ? *settings_.first_sigma
                       : std::sqrt(all_pairs_variance(source_.front(), target_.front(), t, settings_.dimensions));
    const WeightedPoints* last_source = nullptr;
    bool sees_all = false;  // the last steps use every point, whatever the width
    Acceleration acceleration;
    Mat3 origin = t.rotation;  // origin of the acceleration's rotation vectors
    double plain_step = 0.0;
    double ratio = 0.0;  // of two plain steps
    for (drift.iterations = 0; drift.iterations < settings_.max_iterations;) {
      if (monitor.is_cancelled()) return finish(drift, sigma, DriftOutcome::Cancelled);
      const WeightedPoints& source = sees_all ? source_.back() : level_for(source_, sigma / t.scale);
      const WeightedPoints& target = sees_all ? target_.back() : level_for(target_, sigma);
      const MatchedTransform next =
          best_transform(match(source, target, t, sigma, settings_, workers_), held_while_wide(t.scale, sigma));
      drift.matched_share = next.matched / target_count();
      if (next.is_degenerate) return finish(drift, sigma, DriftOutcome::Degenerate);
      ++drift.iterations;
      const double step = rms_step(next.transform, t, scatter_);
      const double new_sigma = std::sqrt(std::max(0.0, next.variance));
      const double shrinking = std::abs(new_sigma - sigma);
      drift.last_step_mm = step;
      // EM converges linearly: the remaining steps form a geometric series. Its ratio is that of the plain steps;
      // accelerated steps hide it.
      if (plain_step > 0.0) ratio = std::clamp(step / plain_step, 0.0, 0.98);
      const bool is_still =
          step / (1.0 - std::max(ratio, kLeastRatio)) < settings_.tolerance && shrinking < 1e-3 * sigma;
      if (new_sigma < kLeastSigma || (is_still && sees_everything(source, target))) {
        t = next.transform;
        return finish(drift, new_sigma, DriftOutcome::Converged);
      }
      const bool may_accelerate = shrinking < kSlow * sigma && &source == last_source;
      last_source = &source;
      if (!may_accelerate || is_still) {
        acceleration.forget();
        origin = next.transform.rotation;
        plain_step = is_still ? 0.0 : step;
        sees_all = sees_all || is_still;
        t = next.transform;
        sigma = new_sigma;
        continue;
      }
      plain_step = 0.0;
      const Acceleration::Vector ahead =
          acceleration.next(vector_of(t, sigma, origin), vector_of(next.transform, new_sigma, origin));
      sigma = std::max(ahead[7], 0.5 * new_sigma);
      t = {std::clamp(std::exp(ahead[0]), settings_.scale.low, settings_.scale.high),
           rotation_of(ahead.segment<3>(1)) * origin, ahead.segment<3>(4)};
    }
    finish(drift, sigma, DriftOutcome::IterationLimit);
  }

 private:
  /// Returns settings that hold the scale while the Gaussians are as wide as the clouds. Every point then belongs to
  /// every other, and the likeliest scale is near 0, from which EM does not recover.
  [[nodiscard]] DriftSettings held_while_wide(double scale, double sigma) const {
    DriftSettings settings = settings_;
    if (sigma > kWide && !settings_.first_sigma) settings.scale = ScaleRange::fixed(scale);
    return settings;
  }
  /// Returns the unknowns: logarithm of the scale, rotation vector from `origin`, translation, width.
  static Acceleration::Vector vector_of(const Similarity& t, double sigma, const Mat3& origin) {
    Acceleration::Vector v;
    v << std::log(t.scale), rotation_vector(t.rotation * origin.transpose()), t.translation_mm, sigma;
    return v;
  }
  [[nodiscard]] bool sees_everything(const WeightedPoints& source, const WeightedPoints& target) const {
    return &source == &source_.back() && &target == &target_.back();
  }
  [[nodiscard]] double target_count() const { return static_cast<double>(target_.back().points.size()); }

  static void finish(CoherentPointDrift& drift, double sigma, DriftOutcome outcome) {
    drift.sigma_mm = sigma;
    drift.outcome = outcome;
  }

  const DriftSettings& settings_;
  Workers& workers_;
  std::vector<WeightedPoints> source_;
  std::vector<WeightedPoints> target_;
  Mat3 scatter_ = Mat3::Zero();
};

}  // namespace

ScaleRange ScaleRange::free() {
  return {0.0, std::numeric_limits<double>::infinity()};
}

std::vector<Problem> validate(const DriftSettings& s) {
  std::vector<Problem> problems = problems_of(s);
  Expect{problems}(s.scale.low <= s.scale.high, "scale.low", s.scale.low, fmt::format("at most {}", s.scale.high));
  return problems;
}

double background(double sigma, double outlier_weight, int dimensions, double source_count, double target_count) {
  const double volume = std::pow(2.0 * units::kPi * sigma * sigma, 0.5 * dimensions);
  return volume * outlier_weight / (1.0 - outlier_weight) * source_count / target_count;
}

MatchSums match(const WeightedPoints& source, const WeightedPoints& target, const Similarity& t, double sigma,
                const DriftSettings& settings, Workers& workers) {
  const auto total = [](const std::vector<double>& w) { return std::accumulate(w.begin(), w.end(), 0.0); };
  const double source_count = total(source.weights);
  const double target_count = total(target.weights);
  const double noise = background(sigma, settings.outlier_weight, settings.dimensions, source_count, target_count);
  const GaussField field(source.points, source.weights, sigma / t.scale);
  const Similarity back = inverse(t);
  std::vector<MatchSums> parts(Workers::chunk_count(target.points.size(), kPointsInAChunk));
  workers.for_chunks(target.points.size(), kPointsInAChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const GaussSum near = field.at(back(target.points[i]));
      add(parts[chunk], target.points[i], target.weights[i], near, noise);
    }
  });
  MatchSums sums;
  for (const MatchSums& part : parts) add(sums, part);
  return sums;
}

MatchedTransform best_transform(const MatchSums& sums, const DriftSettings& settings) {
  MatchedTransform best;
  const double n = sums.count;
  best.matched = n;
  if (!(n > 0.0)) return {{}, 0.0, n, true};
  const Vec3 x = sums.target / n;
  const Vec3 y = sums.source / n;
  const Mat3 cross = sums.cross - n * x * y.transpose();
  const double x_spread = sums.target_squares - n * x.squaredNorm();
  const double y_spread = sums.source_squares - n * y.squaredNorm();
  const BestRotation turn = best_rotation(cross, settings.dimensions);
  best.is_degenerate = turn.is_degenerate || !(y_spread > 0.0);
  Similarity& t = best.transform;
  t.rotation = turn.rotation;
  t.scale = best.is_degenerate ? 1.0 : std::clamp(turn.gain / y_spread, settings.scale.low, settings.scale.high);
  best.is_degenerate = best.is_degenerate || !(t.scale > 0.0);
  t.translation_mm = x - t.scale * (t.rotation * y);
  const double misfit = x_spread - 2.0 * t.scale * turn.gain + t.scale * t.scale * y_spread;
  best.variance = std::max(0.0, misfit) / (n * settings.dimensions);
  return best;
}

CoherentPointDrift rigid_drift(std::span<const Vec3> source, std::span<const Vec3> target, const Similarity& start,
                               const DriftSettings& settings, Workers& workers, Monitor& monitor) {
  require_usable(source, "source");
  require_usable(target, "target");
  require_none(validate(settings));
  INCISE_REQUIRE(start.scale > 0.0, "expected a start with a scale above 0");
  CoherentPointDrift drift;
  drift.T_target_source = start;
  const Measure source_measure = measure_of(source);
  const Measure target_measure = measure_of(target);
  if (is_line(source_measure.variances) || is_line(target_measure.variances)) {
    drift.outcome = DriftOutcome::Degenerate;
    return drift;
  }
  const double length = target_measure.radius;
  const SearchFrame frame{source_measure.center, target_measure.center, length};
  drift.T_target_source = frame.to_search(start);
  if (!settings.first_sigma) {
    // As published: centroids coincide, and sizes are equal as far as the range allows.
    drift.T_target_source.scale = std::clamp(length / source_measure.radius, settings.scale.low, settings.scale.high);
    drift.T_target_source.translation_mm = Vec3::Zero();
  }
  Expectation(normalised(source, source_measure.center, length), normalised(target, target_measure.center, length),
              settings, workers)
      .run(drift, monitor);
  drift.T_target_source = frame.from_search(drift.T_target_source);
  drift.sigma_mm *= length;
  drift.last_step_mm *= length;
  return drift;
}

}  // namespace incise
