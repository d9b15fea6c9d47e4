#pragma once

#include <incise/geometry/tet_mesh.hpp>
#include <incise/robot/arm_hulls.hpp>

#include <functional>
#include <memory>
#include <span>

namespace incise::robot_detail {

/// Least distance between the hulls' skins, mm; negative where they overlap.
[[nodiscard]] double distance_mm(const Capsule& a, const Capsule& b);

/// No point of the capsule moves farther than this between two places of it, mm.
[[nodiscard]] double motion_mm(const Capsule& before, const Capsule& after);

struct HullPair {
  Hull a, b;
};
/// Pairs that the joints can bring together: not those that a joint connects or whose distance no joint changes, and
/// not those that the arm's build holds apart sideways.
[[nodiscard]] std::span<const HullPair> base_pairs();  ///< with the base or the shoulder
[[nodiscard]] std::span<const HullPair> self_pairs();  ///< of the others

/// Least clearance of all pairs, mm.
[[nodiscard]] double arm_clearance_mm(const Hulls& hulls);

/// Distance of a point from something fixed, mm.
using PointDistance = std::function<double(const Vec3&)>;
/// What is known of a segment's distance from it, mm.
struct DistanceRange {
  double least_mm = 0.0;    ///< the distance is not below this …
  double nearest_mm = 0.0;  ///< … and not above this, which some place of the segment has
};
/// The range is no wider than `tolerance_mm` and this share of the distance together.
[[nodiscard]] DistanceRange segment_distance(const PointDistance& distance, const Vec3& from, const Vec3& to,
                                             double tolerance_mm, double share);

}  // namespace incise::robot_detail
