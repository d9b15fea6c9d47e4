#pragma once

#include "registration/kernels/gauss_sums.hpp"

#include <incise/core/workers.hpp>
#include <incise/geometry/types.hpp>

#include <array>
#include <span>
#include <vector>

namespace incise {

/// Sums over a weighted cloud at one place: Σ k, Σ k p, Σ k |p|², with k = weight exp(-|p - place|² / 2σ²).
struct GaussSum {
  double weight = 0.0;
  Vec3 first = Vec3::Zero();
  double second = 0.0;
};

/// A weighted cloud of Gaussians of one width, sorted into the cubes of a grid. Each Gaussian is truncated at kReach
/// widths or slightly beyond, which omits at most weight · exp(-kReach² / 2) = weight · 4e-6 per point.
class GaussField {
 public:
  static constexpr double kReach = 5.0;

  /// @param sigma  > 0.  @param weights  one per point, >= 0; empty: 1 each.
  GaussField(std::span<const Vec3> points, std::span<const double> weights, double sigma);

  [[nodiscard]] GaussSum at(const Vec3& place) const;
  /// Returns at() for every place, in order. O(places · points in reach).
  [[nodiscard]] std::vector<GaussSum> at(std::span<const Vec3> places, Workers& workers) const;

 private:
  void sort_into_cells(std::span<const Vec3> points, std::span<const double> weights);

  Vec3 low_ = Vec3::Zero();
  double cell_ = 1.0;
  double steepness_ = 0.0;
  std::array<long, 3> counts_{};       // cells along x, y, z
  std::vector<std::uint32_t> starts_;  // cells + 1: first point of each cell, x fastest
  std::vector<double> x_, y_, z_, weights_;
  GaussSums sums_ = nullptr;
};

}  // namespace incise
