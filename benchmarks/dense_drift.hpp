#pragma once

#include <incise/geometry/types.hpp>
#include <incise/registration/similarity.hpp>

#include <Eigen/SVD>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace incise::bench {

/// Rigid coherent point drift with free scale, written down as published ([Myronenko2010], Fig. 2): every pair in every
/// step, nothing left out, no clusters, no acceleration. O(N M) per step and one row of pairs in memory: the yardstick
/// for rigid_drift.
struct DenseDrift {
  Similarity transform;
  double sigma = 0.0;
  int iterations = 0;
};

inline DenseDrift dense_drift(std::span<const Vec3> source, std::span<const Vec3> target, const Similarity& start,
                              double outlier_weight, double tolerance, int max_iterations) {
  const auto n = static_cast<double>(target.size());
  const auto m = static_cast<double>(source.size());
  DenseDrift drift;
  drift.transform = start;
  double variance = 0.0;
  for (const Vec3& x : target) {
    for (const Vec3& y : source) variance += (x - drift.transform(y)).squaredNorm();
  }
  variance /= 3.0 * n * m;
  Eigen::Array<double, Eigen::Dynamic, 3> y(static_cast<Eigen::Index>(source.size()), 3);
  for (std::size_t j = 0; j < source.size(); ++j) y.row(static_cast<Eigen::Index>(j)) = source[j].transpose().array();
  for (; drift.iterations < max_iterations; ++drift.iterations) {
    const Similarity& t = drift.transform;
    Eigen::Array<double, Eigen::Dynamic, 3> placed = (t.scale * (y.matrix() * t.rotation.transpose())).array();
    placed.rowwise() += t.translation_mm.transpose().array();
    const double background =
        std::pow(2.0 * std::numbers::pi * variance, 1.5) * outlier_weight / (1.0 - outlier_weight) * m / n;
    double count = 0.0;
    Vec3 sum_x = Vec3::Zero();
    Vec3 sum_y = Vec3::Zero();
    Mat3 cross = Mat3::Zero();
    double squares_x = 0.0;
    double squares_y = 0.0;
    const Eigen::ArrayXd source_squares = y.square().rowwise().sum();
    Eigen::ArrayXd row;
    for (const Vec3& x : target) {
      row = (-0.5 / variance * (placed.rowwise() - x.transpose().array()).square().rowwise().sum()).exp();
      row /= row.sum() + background;
      const double p = row.sum();
      const Vec3 py = (y.matrix().transpose() * row.matrix());
      count += p;
      sum_x += p * x;
      sum_y += py;
      cross += x * py.transpose();
      squares_x += p * x.squaredNorm();
      squares_y += (row * source_squares).sum();
    }
    const Vec3 mean_x = sum_x / count;
    const Vec3 mean_y = sum_y / count;
    const Mat3 a = cross - count * mean_x * mean_y.transpose();
    const Eigen::JacobiSVD<Mat3> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vec3 signs(1.0, 1.0, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0);
    Similarity next;
    next.rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
    const double gain = svd.singularValues().dot(signs);
    next.scale = gain / (squares_y - count * mean_y.squaredNorm());
    next.translation_mm = mean_x - next.scale * (next.rotation * mean_y);
    const double new_variance = (squares_x - count * mean_x.squaredNorm() - next.scale * gain) / (3.0 * count);
    const double step = rms_difference_mm(next, t, source);
    drift.transform = next;
    const bool is_still = step < tolerance && std::abs(new_variance - variance) < 1e-5 * variance;
    variance = new_variance;
    if (is_still) break;
  }
  drift.sigma = std::sqrt(variance);
  return drift;
}

}  // namespace incise::bench
