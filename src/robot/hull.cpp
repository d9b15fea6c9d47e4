#include "robot/hull.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace incise {
namespace {

Vec3 origin(const Mat4& frame) {
  return frame.topRightCorner<3, 1>();
}

}  // namespace

bool Instrument::is_needle_alone() const {
  constexpr double kBesideMm = 1e-6;
  const Vec3 flange_in_tool = origin(T_flange_tool.inverse());
  return flange_in_tool.head<2>().norm() < kBesideMm && flange_in_tool.z() <= 0.0 &&
         -flange_in_tool.z() <= needle_length_mm + kBesideMm;
}

Hulls hulls_at(const ArmModel& arm, const Joints& q, const Instrument& instrument, double table_z_mm) {
  const auto frames = joint_frames(arm, q);
  const Vec3 side = frames[1].block<3, 1>(0, 2);  // axis of the shoulder, elbow and first wrist joint
  const Vec3 beside_upper_arm = arm.shoulder_offset_mm * side, beside_forearm = arm.elbow_offset_mm * side;
  const ArmHullRadii& r = arm.hull_radius_mm;
  const Vec3 flange = origin(frames[6]), along_flange = frames[6].block<3, 1>(0, 2);
  const Mat4 T_base_tool = frames[6] * instrument.T_flange_tool;
  const Vec3 tip = origin(T_base_tool), axis = T_base_tool.block<3, 1>(0, 2);
  const bool is_alone = instrument.is_needle_alone();
  const double needle_mm = is_alone ? (tip - flange).norm() : instrument.needle_length_mm;
  const Vec3 needle_end = tip - needle_mm * axis;
  Hulls hulls;
  const auto set = [&hulls](Hull hull, const Vec3& from, const Vec3& to, double radius_mm) {
    hulls[static_cast<std::size_t>(hull)] = {from, to, radius_mm};
  };
  set(Hull::Base, std::min(0.0, table_z_mm) * Vec3::UnitZ(), origin(frames[1]), r.base);
  set(Hull::Shoulder, origin(frames[1]), origin(frames[1]) + beside_upper_arm, r.shoulder);
  set(Hull::UpperArm, origin(frames[1]) + beside_upper_arm, origin(frames[2]) + beside_upper_arm, r.upper_arm);
  set(Hull::Elbow, origin(frames[2]) + beside_upper_arm, origin(frames[2]) + beside_forearm, r.elbow);
  set(Hull::Forearm, origin(frames[2]) + beside_forearm, origin(frames[3]) + beside_forearm, r.forearm);
  set(Hull::Wrist1, origin(frames[3]) + beside_forearm, origin(frames[4]), r.wrist_1);
  set(Hull::Wrist2, origin(frames[4]), origin(frames[5]), r.wrist_2);
  set(Hull::Wrist3, origin(frames[5]), flange - r.flange_setback * along_flange, r.wrist_3);
  set(Hull::Shaft, needle_end, flange, is_alone ? instrument.needle_radius_mm : instrument.shaft_radius_mm);
  set(Hull::Needle, tip, needle_end, instrument.needle_radius_mm);
  return hulls;
}

namespace robot_detail {
namespace {

// Without the pairs upper arm and base, forearm and wrist 2: the arm's build keeps them apart sideways.
constexpr HullPair kBasePairs[]{
    {Hull::Base, Hull::Elbow},      {Hull::Base, Hull::Forearm},     {Hull::Base, Hull::Wrist1},
    {Hull::Base, Hull::Wrist2},     {Hull::Base, Hull::Wrist3},      {Hull::Base, Hull::Shaft},
    {Hull::Base, Hull::Needle},     {Hull::Shoulder, Hull::Forearm}, {Hull::Shoulder, Hull::Wrist1},
    {Hull::Shoulder, Hull::Wrist2}, {Hull::Shoulder, Hull::Wrist3},  {Hull::Shoulder, Hull::Shaft},
    {Hull::Shoulder, Hull::Needle}};
constexpr HullPair kSelfPairs[]{
    {Hull::UpperArm, Hull::Wrist1}, {Hull::UpperArm, Hull::Wrist2}, {Hull::UpperArm, Hull::Wrist3},
    {Hull::UpperArm, Hull::Shaft},  {Hull::UpperArm, Hull::Needle}, {Hull::Elbow, Hull::Wrist2},
    {Hull::Elbow, Hull::Wrist3},    {Hull::Elbow, Hull::Shaft},     {Hull::Elbow, Hull::Needle},
    {Hull::Forearm, Hull::Wrist3},  {Hull::Forearm, Hull::Shaft},   {Hull::Forearm, Hull::Needle},
    {Hull::Wrist1, Hull::Shaft},    {Hull::Wrist1, Hull::Needle},   {Hull::Wrist2, Hull::Shaft},
    {Hull::Wrist2, Hull::Needle}};

/// Squared distance of two segments: the nearest points of the two lines, each clamped to its segment.
double segments_squared_mm2(const Capsule& a, const Capsule& b) {
  constexpr double kPointMm2 = 1e-12;  // shorter is a point
  const Vec3 u = a.to_mm - a.from_mm, v = b.to_mm - b.from_mm, between = a.from_mm - b.from_mm;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), ub = u.dot(between), vb = v.dot(between);
  double s = 0.0, t = 0.0;
  if (uu > kPointMm2 && vv > kPointMm2) {
    const double across = uu * vv - uv * uv;
    s = across > kPointMm2 * uu * vv ? std::clamp((uv * vb - ub * vv) / across, 0.0, 1.0) : 0.0;
    t = (uv * s + vb) / vv;
    if (t < 0.0 || t > 1.0) {
      t = std::clamp(t, 0.0, 1.0);
      s = std::clamp((uv * t - ub) / uu, 0.0, 1.0);
    }
  } else if (uu > kPointMm2) {
    s = std::clamp(-ub / uu, 0.0, 1.0);
  } else if (vv > kPointMm2) {
    t = std::clamp(vb / vv, 0.0, 1.0);
  }
  return (between + s * u - t * v).squaredNorm();
}

}  // namespace

double distance_mm(const Capsule& a, const Capsule& b) {
  return std::sqrt(segments_squared_mm2(a, b)) - a.radius_mm - b.radius_mm;
}

double motion_mm(const Capsule& before, const Capsule& after) {
  return std::sqrt(
      std::max((after.from_mm - before.from_mm).squaredNorm(), (after.to_mm - before.to_mm).squaredNorm()));
}

std::span<const HullPair> base_pairs() {
  return kBasePairs;
}

std::span<const HullPair> self_pairs() {
  return kSelfPairs;
}

double least_distance_mm(const Hulls& hulls, std::span<const HullPair> pairs) {
  double least = std::numeric_limits<double>::infinity();
  for (const HullPair& pair : pairs) least = std::min(least, distance_mm(of(hulls, pair.a), of(hulls, pair.b)));
  return least;
}

DistanceRange segment_distance(const PointDistance& distance, const Vec3& from, const Vec3& to, double tolerance_mm,
                               double share) {
  // The distance changes by at most the distance moved, so no point of a piece is nearer than its middle minus half its
  // length. The piece with the least bound is halved until none can be much nearer than the nearest point found.
  struct Piece {
    double least_mm, begin, end;
    bool operator<(const Piece& other) const { return least_mm > other.least_mm; }  // the heap's top is the least
  };
  const Vec3 along = to - from;
  const double length_mm = along.norm();
  double nearest_mm = std::min(distance(from), distance(to));
  std::vector<Piece> pieces;
  const auto look_at = [&](double begin, double end) {
    const double middle_mm = distance(from + 0.5 * (begin + end) * along);
    nearest_mm = std::min(nearest_mm, middle_mm);
    pieces.push_back({std::max(0.0, middle_mm - 0.5 * (end - begin) * length_mm), begin, end});
    std::push_heap(pieces.begin(), pieces.end());
  };
  look_at(0.0, 1.0);
  while (pieces.front().least_mm < (1.0 - share) * nearest_mm - tolerance_mm) {
    const Piece best = pieces.front();
    std::pop_heap(pieces.begin(), pieces.end());
    pieces.pop_back();
    const double middle = 0.5 * (best.begin + best.end);
    look_at(best.begin, middle);
    look_at(middle, best.end);
  }
  return {std::min(pieces.front().least_mm, nearest_mm), nearest_mm};
}

}  // namespace robot_detail
}  // namespace incise
