#pragma once

#include <cstddef>
#include <cstdint>

// Plain arrays only: the sources are compiled once per instruction set (see src/mechanics/kernels/kernels.hpp).

namespace incise {

inline constexpr std::size_t kGaussPadding =
    8;  ///< unused places that must follow the last point: the widest kernel reads that far

/// Weighted points, structure of arrays, each with kGaussPadding finite places more than are counted.
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

/// Σ_j k_j, Σ_j k_j p_j (3) and Σ_j k_j |p_j|² with k_j = weight_j exp(-steepness |p - p_j|²), over the points of the
/// ranges, in their order. The exponential's relative error is below 1e-11; terms below 1e-300 count as about that.
using GaussSums = void (*)(const GaussPoints& points, const GaussRange* ranges, std::size_t range_count,
                           const double* p, double steepness, double* sums);

extern const GaussSums kPortableGaussSums;
extern const GaussSums kAvx2GaussSums;
extern const GaussSums kAvx512GaussSums;

/// The one for the active instruction set.
[[nodiscard]] GaussSums gauss_sums();

}  // namespace incise
