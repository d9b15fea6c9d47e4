#pragma once

#include <incise/cutting/incision.hpp>

#include <cstdint>
#include <string>

namespace incise::testing {

/// What one random cut does to the block of `fuzz_block`.
struct FuzzCut {
  std::string kind;  ///< ring, crossing, leaving, wandering, along the clamp, through the platform, leaning, doubled
  ToolPath path;     ///< frame sim_stretched
  IncisionSettings settings;
};

/// The same seed gives the same cut. Speeds, dullness, bonds and steps lie far outside what anyone would choose, but within what is accepted.
FuzzCut random_cut(std::uint64_t seed);

}  // namespace incise::testing
