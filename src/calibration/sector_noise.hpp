#pragma once

#include <cstddef>
#include <vector>

namespace incise {

/// Returns the spectrum of numbers round a ring, in the orthonormal basis of cosines and sines. In this basis, every
/// covariance that depends only on the angle between two sectors is diagonal. Entry 0 is the mean times √N; then follow
/// cosine and sine of each order.
[[nodiscard]] std::vector<double> ring_spectrum(const std::vector<double>& values);

/// Returns the numbers round a ring from their spectrum.
[[nodiscard]] std::vector<double> ring_values(const std::vector<double>& spectrum);

/// Eigenvalues, in the order of ring_spectrum, of the correlation exp(−angle / length) between `sectors` sectors.
/// @param entries  of the spectrum, at most `sectors`; by default all.
[[nodiscard]] std::vector<double> ring_eigenvalues(std::size_t sectors, double length_deg,
                                                   std::size_t entries = static_cast<std::size_t>(-1));

/// Waves above this order are the mesh's grain and reading errors of photographs: the drag of tissue varies smoothly.
inline constexpr std::size_t kOrdersThatCount = 4;
/// Number of entries of a spectrum up to this order.
inline constexpr std::size_t kEntriesThatCount = 2 * kOrdersThatCount + 1;

/// Returns the part of the values that consists of these orders.
[[nodiscard]] std::vector<double> without_fast_waves(const std::vector<double>& values);

}  // namespace incise
