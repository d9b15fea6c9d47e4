#pragma once

#include <incise/core/workers.hpp>
#include <incise/cutting/tool.hpp>
#include <incise/geometry/types.hpp>
#include <incise/mechanics/tissue.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace incise {

/// Corner positions of a tet.
[[nodiscard]] std::array<Vec3, 4> corners_of(const TetMesh& mesh, std::span<const Vec3> positions, std::size_t tet);

/// Distance, mm, between a tet (solid, any orientation) and the segment from a to b (which may be one point); 0 where they meet. Exact.
[[nodiscard]] double distance_to_segment(const std::array<Vec3, 4>& tet, const Vec3& a, const Vec3& b);

/// When within a step something is in contact, as a fraction of the step.
struct ContactInterval {
  double fraction = 0.0;  ///< how long, [0, 1]
  double first = 0.0;     ///< from when on, [0, 1]; meaningful when fraction > 0
  bool at_end = false;    ///< still at the step's end
};

/// The part of a step during which a distance is at most `limit_mm`. Where it passes the limit between two of the evenly spaced moments, and where
/// it may come below it between two, it is looked at more closely. Begin and end are those at which the distance is within 1e-6 mm of the
/// limit, for a distance that is convex in time, as that between two convex solids that move straight past each other is.
/// @param distances_mm  at evenly spaced moments from the step's beginning to its end, at least 2.
/// @param distance_mm   at any moment in [0, 1] of the step.
[[nodiscard]] ContactInterval contact_interval(std::span<const double> distances_mm, const std::function<double(double)>& distance_mm,
                                               double limit_mm);

/// Finds the tets near the tool step after step. It keeps a list of those that can come near soon, so that most steps
/// look at few tets; what it finds does not depend on the list.
class NearTets {
 public:
  /// Wanted tets whose bounding box, over a step from `before` to `after`, comes within `limit_mm` of the box of the
  /// tool's core at all the moments that are looked at; ascending. A superset of the tets in contact then. O(M) where
  /// the list is made anew.
  [[nodiscard]] std::vector<TetId> candidates(const TissueModel& model, std::span<const std::uint8_t> is_wanted,
                                              std::span<const Vec3> before, std::span<const Vec3> after,
                                              std::span<const ToolCore> cores, double limit_mm, Workers& workers);
  /// No vertex has moved farther than this since the last call, mm. To be called before candidates() is given the new
  /// positions as `after`.
  void moved(double distance_mm) { moved_mm_ += distance_mm; }
  /// The tissue is another one now.
  void forget() { is_known_ = false; }

 private:
  bool is_known_ = false;
  Box3 reach_;             ///< tets whose box met this are listed
  double moved_mm_ = 0.0;  ///< since then
  std::vector<TetId> listed_;
};

/// The share of a tet's volume within `limit_mm` of a core, from 35 evenly spread sample points, [0, 1].
[[nodiscard]] double share_within(const std::array<Vec3, 4>& tet, const ToolCore& core, double limit_mm);

}  // namespace incise
