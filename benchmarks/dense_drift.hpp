#pragma once

#include <incise/core/workers.hpp>
#include <incise/geometry/types.hpp>
#include <incise/registration/drift.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace incise::bench {

/// Rigid coherent point drift with free scale, written down as published ([Myronenko2010], Fig. 2): every pair in every
/// step, nothing left out that doubles hold, no clusters. O(N M) per step and one row of pairs in memory for each
/// thread: the yardstick for rigid_drift.
struct DenseDrift {
  Similarity transform;
  double sigma = 0.0;  ///< mm
  int steps = 0;       ///< times that all pairs were gone through
  /// Of the published step at the end: the largest eigenvalue of its Jacobian. So much of what is left to go is left
  /// after a step; below 1 the place is a maximum of the likelihood.
  double rate = 1.0;
  double left_mm = 0.0;  ///< how far the source still is from the fixed point (rms), by Newton's method
  bool has_converged = false;
};

/// What a step sums over all pairs, by the chances P_mn.
struct DenseSums {
  double count = 0.0;
  Vec3 target = Vec3::Zero();
  Vec3 source = Vec3::Zero();
  Mat3 cross = Mat3::Zero();
  double target_squares = 0.0;
  double source_squares = 0.0;
  double log_sums = 0.0;  // of what the chances are divided by
};

using DensePoints = Eigen::Array<double, Eigen::Dynamic, 3>;

/// @param y, placed  the source as it is and where it lies now, M x 3
inline DenseSums dense_sums(std::span<const Vec3> target, const DensePoints& y, const DensePoints& placed,
                            double variance, double background, Workers& workers) {
  constexpr std::size_t kChunk = 64;
  constexpr double kLostSigmas = 11.0;  // beyond: less than the last bit of any sum here, and most of the time
  const double lost = kLostSigmas * kLostSigmas * variance;
  const Eigen::ArrayXd squares = y.square().rowwise().sum();
  std::vector<DenseSums> parts(Workers::chunk_count(target.size(), kChunk));
  workers.for_chunks(target.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    Eigen::ArrayXd row;
    DenseSums& sums = parts[chunk];
    std::vector<Eigen::Index> near;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3& x = target[i];
      row = (placed.col(0) - x.x()).square() + (placed.col(1) - x.y()).square() + (placed.col(2) - x.z()).square();
      near.clear();
      double all = background;
      for (Eigen::Index k = 0; k < row.size(); ++k) {
        if (row[k] > lost) continue;
        near.push_back(k);
        row[k] = std::exp(-0.5 / variance * row[k]);
        all += row[k];
      }
      sums.log_sums += std::log(all);
      double p = 0.0;
      double py_squares = 0.0;
      Vec3 py = Vec3::Zero();
      for (const Eigen::Index k : near) {
        const double share = row[k] / all;
        p += share;
        py += share * y.row(k).matrix().transpose();
        py_squares += share * squares[k];
      }
      sums.count += p;
      sums.target += p * x;
      sums.source += py;
      sums.cross += x * py.transpose();
      sums.target_squares += p * x.squaredNorm();
      sums.source_squares += py_squares;
    }
  });
  DenseSums all;
  for (const DenseSums& part : parts) {
    all.count += part.count;
    all.target += part.target;
    all.source += part.source;
    all.cross += part.cross;
    all.target_squares += part.target_squares;
    all.source_squares += part.source_squares;
    all.log_sums += part.log_sums;
  }
  return all;
}

/// Where the method stands.
struct DensePose {
  Similarity transform;
  double variance = 0.0;
};

/// The published step, in coordinates of any unit; the background is one outlier per unit of volume.
class DenseStep {
 public:
  DenseStep(Points source, Points target, double outlier_weight, Workers& workers)
      : source_(std::move(source)),
        target_(std::move(target)),
        outlier_weight_(outlier_weight),
        workers_(workers),
        y_(static_cast<Eigen::Index>(source_.size()), 3) {
    for (std::size_t j = 0; j < source_.size(); ++j) {
      y_.row(static_cast<Eigen::Index>(j)) = source_[j].transpose().array();
    }
  }

  struct Image {
    DensePose pose;
    double log_likelihood = 0.0;  ///< of the pose that the step was taken from, but for a constant
  };

  Image operator()(const DensePose& from) {
    ++count_;
    const auto n = static_cast<double>(target_.size());
    const auto m = static_cast<double>(source_.size());
    const auto& [t, variance] = from;
    DensePoints placed = (t.scale * (y_.matrix() * t.rotation.transpose())).array();
    placed.rowwise() += t.translation_mm.transpose().array();
    const double background =
        std::pow(2.0 * std::numbers::pi * variance, 1.5) * outlier_weight_ / (1.0 - outlier_weight_) * m / n;
    const auto [count, sum_x, sum_y, cross, squares_x, squares_y, log_sums] =
        dense_sums(target_, y_, placed, variance, background, workers_);
    const Vec3 mean_x = sum_x / count;
    const Vec3 mean_y = sum_y / count;
    const Mat3 a = cross - count * mean_x * mean_y.transpose();
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Vec3 signs(1.0, 1.0, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0);
    Image image;
    Similarity& next = image.pose.transform;
    next.rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
    const double gain = svd.singularValues().dot(signs);
    next.scale = gain / (squares_y - count * mean_y.squaredNorm());
    next.translation_mm = mean_x - next.scale * (next.rotation * mean_y);
    image.pose.variance = (squares_x - count * mean_x.squaredNorm() - next.scale * gain) / (3.0 * count);
    image.log_likelihood = log_sums - 1.5 * n * std::log(variance);
    return image;
  }

  [[nodiscard]] double all_pairs_variance(const Similarity& t) const {
    double squares = 0.0;
    for (const Vec3& x : target_) {
      for (const Vec3& y : source_) squares += (x - t(y)).squaredNorm();
    }
    return squares / (3.0 * static_cast<double>(target_.size()) * static_cast<double>(source_.size()));
  }
  [[nodiscard]] double apart(const Similarity& a, const Similarity& b) const {
    return rms_difference_mm(a, b, source_);
  }
  [[nodiscard]] int count() const { return count_; }

 private:
  Points source_;
  Points target_;
  double outlier_weight_;
  Workers& workers_;
  DensePoints y_;
  int count_ = 0;
};

using DenseVector = Eigen::Matrix<double, 8, 1>;
using DenseMatrix = Eigen::Matrix<double, 8, 8>;

/// The way from one pose to another: logarithm of the scale, rotation vector, translation, logarithm of the variance.
inline DenseVector way(const DensePose& from, const DensePose& to) {
  DenseVector v;
  v << std::log(to.transform.scale / from.transform.scale),
      rotation_vector(to.transform.rotation * from.transform.rotation.transpose()),
      to.transform.translation_mm - from.transform.translation_mm, std::log(to.variance / from.variance);
  return v;
}

inline DensePose gone(const DensePose& from, const DenseVector& way) {
  return {{from.transform.scale * std::exp(way[0]), rotation_of(way.segment<3>(1)) * from.transform.rotation,
           from.transform.translation_mm + way.segment<3>(4)},
          from.variance * std::exp(way[7])};
}

/// How the step's image moves when the pose does, by central differences.
inline DenseMatrix jacobian_of(DenseStep& step, const DensePose& pose) {
  constexpr double kAside = 1e-5;  // radii: the differences' error is some 1e-8 then
  DenseMatrix jacobian;
  for (int k = 0; k < 8; ++k) {
    const DenseVector aside = kAside * DenseVector::Unit(k);
    jacobian.col(k) =
        (way(pose, step(gone(pose, aside)).pose) - way(pose, step(gone(pose, -aside)).pose)) / (2.0 * kAside);
  }
  return jacobian;
}

/// EM climbs the likelihood ever more slowly along surfaces that can slide: after so many published steps it is carried
/// to its end by Newton's method on (step(pose) - pose) = 0, no farther at once than a part of the Gaussians' width,
/// and never downhill. The end is a fixed point of the published step, however it was reached.
inline DenseDrift dense_fixed_point(DenseStep& step, DensePose pose, int plain_steps, double still, int most_rounds) {
  constexpr double kFarthest = 0.1;    // of the Gaussians' width
  constexpr double kShortest = 1e-3;   // of a round's way, below which it goes on as published
  constexpr double kRounding = 1e-12;  // of the likelihood
  const auto as_published = [&](int steps) {
    for (int k = 0; k < steps; ++k) pose = step(pose).pose;
  };
  as_published(plain_steps);
  DenseDrift drift;
  for (int round = 0; round < most_rounds && !drift.has_converged; ++round) {
    const DenseMatrix jacobian = jacobian_of(step, pose);
    const DenseStep::Image here = step(pose);
    drift.rate = jacobian.eigenvalues().cwiseAbs().maxCoeff();
    if (drift.rate >= 1.0) {
      as_published(plain_steps);
      continue;
    }
    const DenseVector move = (DenseMatrix::Identity() - jacobian).fullPivLu().solve(way(pose, here.pose));
    drift.left_mm = step.apart(gone(pose, move).transform, pose.transform);
    drift.has_converged = drift.left_mm < still;
    double share = std::min(1.0, kFarthest * std::sqrt(pose.variance) / drift.left_mm);
    const double least = here.log_likelihood - kRounding * std::abs(here.log_likelihood);
    while (share > kShortest && step(gone(pose, share * move)).log_likelihood < least) share *= 0.5;
    pose = share > kShortest ? gone(pose, share * move) : here.pose;
  }
  drift.transform = pose.transform;
  drift.sigma = std::sqrt(pose.variance);
  drift.steps = step.count();
  return drift;
}

/// Both clouds about their middles and in units of the target's root mean square radius, as published: the background
/// depends on the unit. From the published start, or from a pose and width (mm) given. Ends within `still_mm` (rms) of
/// the fixed point.
inline DenseDrift dense_drift(std::span<const Vec3> source, std::span<const Vec3> target, double outlier_weight,
                              double still_mm, Workers& workers, const CoherentPointDrift* start = nullptr) {
  constexpr int kPlainSteps = 150;
  constexpr int kMostRounds = 60;
  const auto middle_of = [](std::span<const Vec3> points) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : points) sum += p;
    return Vec3(sum / static_cast<double>(points.size()));
  };
  const Vec3 source_middle = middle_of(source);
  const Vec3 target_middle = middle_of(target);
  double squares = 0.0;
  for (const Vec3& x : target) squares += (x - target_middle).squaredNorm();
  const double radius_mm = std::sqrt(squares / static_cast<double>(target.size()));
  const auto in_radii = [radius_mm](std::span<const Vec3> points, const Vec3& middle) {
    Points result;
    for (const Vec3& p : points) result.emplace_back((p - middle) / radius_mm);
    return result;
  };
  DenseStep step(in_radii(source, source_middle), in_radii(target, target_middle), outlier_weight, workers);
  DensePose pose;
  if (start != nullptr) {
    const Similarity& t = start->T_target_source;
    pose.transform = {t.scale, t.rotation, (t(source_middle) - target_middle) / radius_mm};
    pose.variance = std::pow(start->sigma_mm / radius_mm, 2);
  } else {
    pose.variance = step.all_pairs_variance(pose.transform);
  }
  DenseDrift drift =
      dense_fixed_point(step, pose, start == nullptr ? kPlainSteps : 1, still_mm / radius_mm, kMostRounds);
  Similarity& t = drift.transform;
  t.translation_mm = radius_mm * t.translation_mm + target_middle - t.scale * (t.rotation * source_middle);
  drift.sigma *= radius_mm;
  drift.left_mm *= radius_mm;
  return drift;
}

}  // namespace incise::bench
