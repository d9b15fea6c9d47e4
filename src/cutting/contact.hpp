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

/// Returns the exact distance between a solid tet (of either orientation) and the segment from a to b, mm; 0 where they
/// meet. The segment may be one point.
[[nodiscard]] double distance_to_segment(const std::array<Vec3, 4>& tet, const Vec3& a, const Vec3& b);

/// The part of a step in which there is contact, in fractions of the step.
struct ContactInterval {
  double fraction = 0.0;  ///< duration, [0, 1]
  double first = 0.0;     ///< beginning, [0, 1]; meaningful if fraction > 0
  bool at_end = false;    ///< whether there is contact at the step's end
};

/// Finds the part of a step in which a distance is at most `limit_mm`. Searches between two given moments if the
/// distance crosses the limit there, or may fall below it there. At the beginning and end found, the distance is within
/// 1e-6 mm of the limit. Assumes that the distance is convex in time, as between two convex solids that move straight
/// past each other.
/// @param distances_mm  at evenly spaced moments from the step's beginning to its end, at least 2.
/// @param distance_mm   gives the distance at a fraction of the step, [0, 1].
[[nodiscard]] ContactInterval contact_interval(std::span<const double> distances_mm, const std::function<double(double)>& distance_mm,
                                               double limit_mm);

/// Finds the tets near the tool in each step. Keeps a list of the tets that can come near soon, so most steps examine
/// few tets; the result does not depend on the list.
class NearTets {
 public:
  /// Returns the wanted tets whose bounding box, over a step from `before` to `after`, comes within `limit_mm` of the
  /// bounding box of all `cores`; ascending. Contains every wanted tet within `limit_mm` of a core at that core's
  /// moment. O(M) when the list is rebuilt.
  /// @param is_wanted      one flag per tet.
  /// @param before, after  positions of the vertices at the beginning and end of the step, N x 3, mm.
  /// @param cores          of the tool, at moments of the step.
  [[nodiscard]] std::vector<TetId> candidates(const TissueModel& model, std::span<const std::uint8_t> is_wanted,
                                              std::span<const Vec3> before, std::span<const Vec3> after,
                                              std::span<const ToolCore> cores, double limit_mm, Workers& workers);
  /// Reports the greatest motion of a vertex since the last call, mm. Call it before passing the new positions to
  /// candidates() as `after`.
  void moved(double distance_mm) { moved_mm_ += distance_mm; }
  /// Discards the list: call it when the tissue is replaced.
  void forget() { is_known_ = false; }

 private:
  bool is_known_ = false;
  Box3 reach_;             ///< the list holds the tets whose box met this one
  double moved_mm_ = 0.0;  ///< since the list was made
  std::vector<TetId> listed_;
};

/// Estimates the share of a tet's volume within `limit_mm` of a core from 35 evenly spread sample points, [0, 1].
[[nodiscard]] double share_within(const std::array<Vec3, 4>& tet, const ToolCore& core, double limit_mm);

}  // namespace incise
