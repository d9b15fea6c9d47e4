#include "calibration/sector_noise.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace incise {
namespace {

/// Order of the wave of an entry: 0, 1, 1, 2, 2, …
std::size_t order_of(std::size_t entry) {
  return (entry + 1) / 2;
}

/// Value of an entry's basis function at a sector.
double basis(std::size_t entry, std::size_t place, std::size_t n) {
  const std::size_t order = order_of(entry);
  const auto count = static_cast<double>(n);
  const bool is_single = entry == 0 || 2 * order == n;  // the mean, and the fastest wave of an even count
  const double angle = 2.0 * std::numbers::pi * static_cast<double>(order * place % n) / count;
  return std::sqrt((is_single ? 1.0 : 2.0) / count) * (entry > 0 && entry % 2 == 0 ? std::sin(angle) : std::cos(angle));
}

}  // namespace

std::vector<double> ring_spectrum(const std::vector<double>& values) {
  const std::size_t n = values.size();
  std::vector<double> spectrum(n, 0.0);
  for (std::size_t entry = 0; entry < n; ++entry) {
    for (std::size_t i = 0; i < n; ++i) spectrum[entry] += values[i] * basis(entry, i, n);
  }
  return spectrum;
}

std::vector<double> ring_values(const std::vector<double>& spectrum) {
  const std::size_t n = spectrum.size();
  std::vector<double> values(n, 0.0);
  for (std::size_t entry = 0; entry < n; ++entry) {
    for (std::size_t i = 0; i < n; ++i) values[i] += spectrum[entry] * basis(entry, i, n);
  }
  return values;
}

std::vector<double> without_fast_waves(const std::vector<double>& values) {
  std::vector<double> spectrum = ring_spectrum(values);
  for (std::size_t entry = kEntriesThatCount; entry < spectrum.size(); ++entry) spectrum[entry] = 0.0;
  return ring_values(spectrum);
}

std::vector<double> ring_eigenvalues(std::size_t sectors, double length_deg, std::size_t entries) {
  const auto count = static_cast<double>(sectors);
  std::vector<double> values(std::min(sectors, entries), 0.0);
  for (std::size_t entry = 0; entry < values.size(); ++entry) {
    const std::size_t order = order_of(entry);
    for (std::size_t k = 0; k < sectors; ++k) {
      const double apart_deg = static_cast<double>(std::min(k, sectors - k)) * 360.0 / count;
      values[entry] += std::exp(-apart_deg / length_deg) *
                       std::cos(2.0 * std::numbers::pi * static_cast<double>(order * k % sectors) / count);
    }
  }
  return values;
}

}  // namespace incise
