#pragma once

#include <incise/geometry/tet_mesh.hpp>
#include <incise/robot/arm_hulls.hpp>

#include <functional>
#include <memory>
#include <span>

namespace incise::robot_detail {

/// Returns the least distance between the surfaces of two capsules, mm; negative if they overlap.
[[nodiscard]] double distance_mm(const Capsule& a, const Capsule& b);

/// Returns an upper bound of the distance that a point of a capsule moves between two positions of it, mm.
[[nodiscard]] double motion_mm(const Capsule& before, const Capsule& after);

struct HullPair {
  Hull a, b;
};
/// Pairs of hulls that can collide. Left out are pairs that a joint connects, pairs whose distance no joint changes,
/// and pairs that the arm's build keeps apart sideways.
[[nodiscard]] std::span<const HullPair> base_pairs();  ///< with the base or the shoulder
[[nodiscard]] std::span<const HullPair> self_pairs();  ///< without base and shoulder

[[nodiscard]] inline const Capsule& of(const Hulls& hulls, Hull hull) {
  return hulls[static_cast<std::size_t>(hull)];
}

/// Returns the least distance of some pairs, mm.
[[nodiscard]] double least_distance_mm(const Hulls& hulls, std::span<const HullPair> pairs);

/// Distance of a point from a fixed object, mm.
using PointDistance = std::function<double(const Vec3&)>;
/// Range in which the distance of a segment from the object lies, mm.
struct DistanceRange {
  double least_mm = 0.0;    ///< lower bound
  double nearest_mm = 0.0;  ///< upper bound: the distance of some point of the segment
};
/// Computes the distance of a segment from an object, to `tolerance_mm` plus `share` of the distance.
[[nodiscard]] DistanceRange segment_distance(const PointDistance& distance, const Vec3& from, const Vec3& to,
                                             double tolerance_mm, double share);

}  // namespace incise::robot_detail
