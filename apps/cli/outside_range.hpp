#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace incise::cli {

/// A specimen unlike those that an experiment calibrates on.
struct OutsideKind {
  std::string name;                                   ///< stiff_and_slipped, stiff, scarred, fibrous, soft
  std::vector<std::pair<std::string, double>> given;  ///< hidden parameters of the bench that are not drawn from the seed
};

/// The paper's failed specimen: stiff, and slipped out of its clamp.
[[nodiscard]] OutsideKind failed_specimen();

/// The index-th of a series: stiff, scarred, fibrous, scarred, soft in turn, how far out is drawn from the seed. Each
/// differs in something that shows in the suture's pull; scarred tissue, which a correction is expected to harm, also in
/// what shows in no reading (it is tough and dry).
[[nodiscard]] OutsideKind outside_specimen(std::uint64_t seed, std::uint64_t index);

}  // namespace incise::cli
