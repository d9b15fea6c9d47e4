#pragma once

#include <cstddef>
#include <cstdint>

// Plain arrays only: the sources are compiled once per instruction set (see src/mechanics/kernels/kernels.hpp).

namespace incise {

inline constexpr std::size_t kGaussPadding =
    8;  ///< unused elements that must follow the last point: the widest kernel reads that far

/// Weighted points as a structure of arrays, each followed by kGaussPadding finite elements that do not count.
struct GaussPoints {
  const double* x;
  const double* y;
  const double* z;
  const double* weight;
};

struct GaussRange {
  std::uint32_t begin;
  std::uint32_t end;
};

/// Computes the five sums Σ_j k_j, Σ_j k_j p_j (3) and Σ_j k_j |p_j|² with k_j = weight_j exp(-steepness |p - p_j|²),
/// over the points of the ranges, in their order. The exponential's relative error is below 1e-11; it is never below
/// about 1e-300.
using GaussSums = void (*)(const GaussPoints& points, const GaussRange* ranges, std::size_t range_count,
                           const double* p, double steepness, double* sums);

extern const GaussSums kPortableGaussSums;
extern const GaussSums kAvx2GaussSums;
extern const GaussSums kAvx512GaussSums;

/// Returns the kernel of the active instruction set.
[[nodiscard]] GaussSums gauss_sums();

}  // namespace incise
