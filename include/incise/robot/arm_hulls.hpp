#pragma once

#include <incise/core/names.hpp>
#include <incise/robot/checks.hpp>

#include <array>
#include <string_view>

namespace incise {

/// All points within `radius_mm` of a segment, mm, base frame.
struct Capsule {
  Vec3 from_mm = Vec3::Zero();
  Vec3 to_mm = Vec3::Zero();
  double radius_mm = 0.0;
};

/// The capsules of the arm and of its instrument, from the base to the tip.
///
///     upper_arm   elbow     forearm
///       ||=========||          shoulder: from the base's axis out to the upper arm
///       ||         ||          elbow:    back from the upper arm to the plane of the forearm
///    ===shoulder   ||--wrist_1--wrist_2--wrist_3--shaft--needle
///     base
enum class Hull { Base, Shoulder, UpperArm, Elbow, Forearm, Wrist1, Wrist2, Wrist3, Shaft, Needle };
inline constexpr std::array<std::string_view, 10> kHullNames{"base",    "shoulder", "upper arm", "elbow", "forearm",
                                                             "wrist 1", "wrist 2",  "wrist 3",   "shaft", "needle"};
[[nodiscard]] constexpr Names names_of(Hull) {
  return kHullNames;
}
inline constexpr std::size_t kHullCount = kHullNames.size();

/// The instrument behind the tip: a straight needle, then a straight shaft to the flange.
struct Instrument {
  Mat4 T_flange_tool = Mat4::Identity();
  double needle_length_mm = CheckSettings{}.needle_length_mm;
  double needle_radius_mm = CheckSettings{}.needle_radius_mm;
  double shaft_radius_mm = CheckSettings{}.shaft_radius_mm;
  /// Whether the needle runs straight to the flange, without a shaft behind it.
  [[nodiscard]] bool is_needle_alone() const;
};
/// Returns the instrument that the checks assume.
[[nodiscard]] inline Instrument instrument_of(const Mat4& T_flange_tool, const CheckSettings& limits) {
  return {T_flange_tool, limits.needle_length_mm, limits.needle_radius_mm, limits.shaft_radius_mm};
}

using Hulls = std::array<Capsule, kHullCount>;
/// Returns the hulls at joints `q`, base frame, mm. The base's column begins on the table, or at the base's foot if
/// that is lower. If the tool is only a needle, the needle's hull ends at the flange and the shaft's hull has its
/// radius.
[[nodiscard]] Hulls hulls_at(const ArmModel& arm, const Joints& q, const Instrument& instrument, double table_z_mm);

}  // namespace incise
