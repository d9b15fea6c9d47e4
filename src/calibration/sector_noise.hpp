#pragma once

#include <vector>

namespace incise {

/// Numbers round a ring in the orthonormal basis of cosines and sines, in which every covariance that depends on the
/// angle between two sectors alone is diagonal. Entry 0 is the mean times √N; then cosine and sine of each order.
[[nodiscard]] std::vector<double> ring_spectrum(const std::vector<double>& values);

/// Eigenvalues, in the order of ring_spectrum, of the correlation exp(−angle / length) between `sectors` sectors.
[[nodiscard]] std::vector<double> ring_eigenvalues(std::size_t sectors, double length_deg);

}  // namespace incise
