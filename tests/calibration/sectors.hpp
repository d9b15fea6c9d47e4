#pragma once

#include <incise/core/units.hpp>

#include <cstddef>

namespace incise::testing {

inline constexpr std::size_t kSectors = 36;

/// Of the middle of a sector, from that of the first, radians.
inline double angle_of(std::size_t sector) {
  return 2.0 * units::kPi * static_cast<double>(sector) / kSectors;
}

}  // namespace incise::testing
