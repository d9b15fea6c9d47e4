#pragma once

#include <incise/core/ids.hpp>
#include <incise/geometry/types.hpp>

#include <vector>

namespace incise {

/// Why a tet was removed.
enum class RemovalCause {
  Dwell,          ///< touched for the dwell time
  LooseFragment,  ///< no longer joined to the body by a face
};

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
