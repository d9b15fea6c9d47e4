#pragma once

#include <incise/core/ids.hpp>
#include <incise/geometry/types.hpp>

#include <array>
#include <string_view>
#include <vector>

namespace incise {

/// Why a tet was removed.
enum class RemovalCause {
  Dwell,          ///< its dose was full, at least half of it from contact
  LooseFragment,  ///< no longer joined to the body by a face
  Tear,           ///< its dose was full, more than half of it from the work that the tool did on it
};
[[nodiscard]] std::string_view to_string(RemovalCause cause);  ///< dwell, loose_fragment, tear

/// Each stands in files by its number.
inline constexpr std::array<RemovalCause, 3> kRemovalCauses{RemovalCause::Dwell, RemovalCause::LooseFragment, RemovalCause::Tear};

struct Removal {
  TetId tet;
  int step = 0;
  double time_s = 0.0;             ///< since the tool began to plunge
  RemovalCause cause = RemovalCause::Dwell;
  Vec3 centroid_mm = Vec3::Zero(); ///< where it was when it went, current configuration
  double rest_volume_mm3 = 0.0;
};

/// Every tet that went, in order: the whole memory of a cut. Within a step: what was touched long enough, then loose fragments, each by
/// ascending tet.
struct CutRecord {
  std::vector<Removal> removals;
  [[nodiscard]] double removed_volume_mm3() const {
    double sum = 0.0;
    for (const Removal& removal : removals) sum += removal.rest_volume_mm3;
    return sum;
  }
};

}  // namespace incise
