#pragma once

#include <cstdint>
#include <random>

namespace incise {

/// Seeded random numbers that are the same on every platform and standard library: the engine is
/// std::mt19937_64, whose sequence the standard fixes; incise implements the distributions, which it does not fix.
/// Pass it by reference; there is no hidden engine anywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [0, 1), 53 random bits.
  double uniform();
  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Normal with mean 0 and standard deviation 1 (polar method of Marsaglia).
  double normal();
  /// Uniform integer in [0, count). @throws InvalidArgument if count is 0.
  std::uint64_t below(std::uint64_t count);

 private:
  std::mt19937_64 engine_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace incise
