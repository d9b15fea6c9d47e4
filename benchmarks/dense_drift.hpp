#pragma once

#include <incise/core/workers.hpp>
#include <incise/geometry/types.hpp>
#include <incise/registration/similarity.hpp>

#include <Eigen/SVD>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace incise::bench {

/// Rigid coherent point drift with free scale, written down as published ([Myronenko2010], Fig. 2): every pair in every
/// step, nothing left out that doubles hold, no clusters, no acceleration. O(N M) per step and one row of pairs in
/// memory for each thread: the yardstick for rigid_drift.
struct DenseDrift {
  Similarity transform;
  double sigma = 0.0;  ///< mm
  int iterations = 0;
};

/// What a step sums over all pairs, by the chances P_mn.
struct DenseSums {
  double count = 0.0;
  Vec3 target = Vec3::Zero();
  Vec3 source = Vec3::Zero();
  Mat3 cross = Mat3::Zero();
  double target_squares = 0.0;
  double source_squares = 0.0;
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
  }
  return all;
}

/// The steps, in coordinates of any unit; the background is one outlier per unit of volume.
inline DenseDrift dense_steps(std::span<const Vec3> source, std::span<const Vec3> target, double outlier_weight,
                              double still, int max_iterations, Workers& workers) {
  const auto n = static_cast<double>(target.size());
  const auto m = static_cast<double>(source.size());
  DenseDrift drift;
  double variance = 0.0;
  for (const Vec3& x : target) {
    for (const Vec3& y : source) variance += (x - drift.transform(y)).squaredNorm();
  }
  variance /= 3.0 * n * m;
  DensePoints y(static_cast<Eigen::Index>(source.size()), 3);
  for (std::size_t j = 0; j < source.size(); ++j) y.row(static_cast<Eigen::Index>(j)) = source[j].transpose().array();
  for (; drift.iterations < max_iterations; ++drift.iterations) {
    const Similarity& t = drift.transform;
    DensePoints placed = (t.scale * (y.matrix() * t.rotation.transpose())).array();
    placed.rowwise() += t.translation_mm.transpose().array();
    const double background =
        std::pow(2.0 * std::numbers::pi * variance, 1.5) * outlier_weight / (1.0 - outlier_weight) * m / n;
    const auto [count, sum_x, sum_y, cross, squares_x, squares_y] =
        dense_sums(target, y, placed, variance, background, workers);
    const Vec3 mean_x = sum_x / count;
    const Vec3 mean_y = sum_y / count;
    const Mat3 a = cross - count * mean_x * mean_y.transpose();
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vec3 signs(1.0, 1.0, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0);
    Similarity next;
    next.rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
    const double gain = svd.singularValues().dot(signs);
    next.scale = gain / (squares_y - count * mean_y.squaredNorm());
    next.translation_mm = mean_x - next.scale * (next.rotation * mean_y);
    const double new_variance = (squares_x - count * mean_x.squaredNorm() - next.scale * gain) / (3.0 * count);
    const double step = rms_difference_mm(next, t, source);
    drift.transform = next;
    const bool is_still = step < still && std::abs(new_variance - variance) < 1e-5 * variance;
    variance = new_variance;
    if (is_still) break;
  }
  drift.sigma = std::sqrt(variance);
  return drift;
}

/// Both clouds about their middles and in units of the target's root mean square radius, as published: the background
/// depends on the unit. Ends when a step moves the source by less than `still_mm` (rms).
inline DenseDrift dense_drift(std::span<const Vec3> source, std::span<const Vec3> target, double outlier_weight,
                              double still_mm, int max_iterations, Workers& workers) {
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
  DenseDrift drift = dense_steps(in_radii(source, source_middle), in_radii(target, target_middle), outlier_weight,
                                 still_mm / radius_mm, max_iterations, workers);
  Similarity& t = drift.transform;
  t.translation_mm = radius_mm * t.translation_mm + target_middle - t.scale * (t.rotation * source_middle);
  drift.sigma *= radius_mm;
  return drift;
}

}  // namespace incise::bench
