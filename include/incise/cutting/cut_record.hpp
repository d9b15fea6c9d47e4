#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/ids.hpp>
#include <incise/core/names.hpp>
#include <incise/geometry/types.hpp>

#include <vector>

namespace incise {

/// Cause of a tet's removal. Files store its number.
enum class RemovalCause {
  Dwell,          ///< its dose was full, at least half of it from contact
  LooseFragment,  ///< no longer joined to the body by a face
  Tear,           ///< its dose was full, more than half of it from the tool's work
};
inline constexpr std::array<std::string_view, 3> kRemovalCauseNames{"dwell", "loose_fragment", "tear"};
[[nodiscard]] constexpr Names names_of(RemovalCause) {
  return kRemovalCauseNames;
}

/// The removal of one tet.
struct Removal {
  TetId tet;     ///< in a cut by points: of the split mesh
  int step = 0;  ///< number of steps done at the removal, that step included
  double time_s = 0.0;             ///< since the tool began to plunge
  RemovalCause cause = RemovalCause::Dwell;
  Vec3 centroid_mm = Vec3::Zero(); ///< at its removal, current configuration
  double rest_volume_mm3 = 0.0;
};
inline void describe(Visitor& v, Removal& r) {
  v("tet", r.tet, "Removed tet.");
  v("step", r.step, "Step in which the tet was removed.");
  v("time_s", r.time_s, "Time since the tool began to plunge.");
  v("cause", r.cause, "Cause of the removal.");
  v("centroid_mm", r.centroid_mm, "Position of the tet's centroid at its removal.");
  v("rest_volume_mm3", r.rest_volume_mm3, "Volume of the tet at rest.");
}

/// All removed tets, in order of removal. Within a step: tets whose dose was full, then loose fragments, each in
/// ascending order.
struct CutRecord {
  std::vector<Removal> removals;
  /// Returns the sum of the removed tets' rest volumes, mm³.
  [[nodiscard]] double removed_volume_mm3() const {
    double sum = 0.0;
    for (const Removal& removal : removals) sum += removal.rest_volume_mm3;
    return sum;
  }
};
inline void describe(Visitor& v, CutRecord& r) {
  v("removals", r.removals, "Removed tets, in order.");
}

}  // namespace incise
