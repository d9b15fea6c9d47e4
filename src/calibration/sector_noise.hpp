#pragma once

#include <cstddef>
#include <vector>

namespace incise {

/// Numbers round a ring in the orthonormal basis of cosines and sines, in which every covariance that depends on the
/// angle between two sectors alone is diagonal. Entry 0 is the mean times √N; then cosine and sine of each order.
[[nodiscard]] std::vector<double> ring_spectrum(const std::vector<double>& values);

/// The numbers round a ring that have this spectrum.
[[nodiscard]] std::vector<double> ring_values(const std::vector<double>& spectrum);

/// Eigenvalues, in the order of ring_spectrum, of the correlation exp(−angle / length) between `sectors` sectors.
/// @param entries  of the spectrum, at most `sectors`; by default all.
[[nodiscard]] std::vector<double> ring_eigenvalues(std::size_t sectors, double length_deg,
                                                   std::size_t entries = static_cast<std::size_t>(-1));

/// Waves above this order are left to the mesh's grain and to the reading of photographs: what drags tissue is smooth.
inline constexpr std::size_t kOrdersThatCount = 4;
/// How many entries of a spectrum these are.
inline constexpr std::size_t kEntriesThatCount = 2 * kOrdersThatCount + 1;

/// The part of the values that is made of the orders that count.
[[nodiscard]] std::vector<double> without_fast_waves(const std::vector<double>& values);

}  // namespace incise
