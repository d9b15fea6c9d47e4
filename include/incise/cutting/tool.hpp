#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/problem.hpp>
#include <incise/geometry/types.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace incise {

/// A needle electrode: a capsule round its axis. Defaults: the paper's monopolar electrode (II-B.2).
struct Needle {
  double diameter_mm = 1.0;  ///< > 0
  double length_mm = 25.0;   ///< > 0, from the tip to the insulated shaft
  [[nodiscard]] double radius_mm() const { return 0.5 * diameter_mm; }
};

/// A blade electrode: a thin box with rounded edges, led edge first. Its mid-plane is a rectangle, `width_mm` along the heading and
/// `length_mm` along the axis; the blade is what lies within half its thickness of that rectangle. The defaults are a common size, no standard's.
struct Blade {
  double thickness_mm = 0.5;  ///< > 0, across axis and heading
  double width_mm = 2.4;      ///< > 0, of the mid-plane, centred on the axis
  double length_mm = 25.0;    ///< > 0, from the tip to the insulated shaft
};

/// A ball electrode: a sphere about the tip. It has no length: the wire that carries it touches nothing. The default is a common size, no standard's.
struct Ball {
  double diameter_mm = 2.0;  ///< > 0
};

/// An instrument. All are alike for contact: what lies within `radius_mm` of a flat convex core (ToolCore).
using Tool = std::variant<Needle, Blade, Ball>;
inline constexpr std::array<std::string_view, 3> kToolNames{"needle", "blade", "ball"};
[[nodiscard]] constexpr std::span<const std::string_view> names_of(const Tool&) {
  return kToolNames;
}
/// Each tool has some of the dimensions of all. @throws as Visitor::refuse for one that belongs to another tool.
void describe(Visitor& v, Tool& tool);

[[nodiscard]] std::string_view kind_of(const Tool& tool);  ///< needle, blade, ball
/// How far the tool's skin lies from its core, mm: half of its diameter or thickness, and half the width of an ideal kerf.
[[nodiscard]] double radius_mm(const Tool& tool);
/// How far up from the tip the tool cuts, mm; none: a ball.
[[nodiscard]] std::optional<double> length_mm(const Tool& tool);
/// How far its outermost point of the core lies from the axis, mm: what a turn of the heading moves. 0 for what is round about its axis.
[[nodiscard]] double half_width_mm(const Tool& tool);
/// Every violation; empty: valid.
[[nodiscard]] std::vector<Problem> validate(const Tool& tool);

/// Where a tool is: its tip, the direction from shaft to tip, and the direction in which it is led.
struct ToolPose {
  Vec3 tip_mm = Vec3::Zero();     ///< end of the core; a ball's middle
  Vec3 axis = -Vec3::UnitZ();     ///< unit, pointing into the tissue
  Vec3 heading = Vec3::UnitX();   ///< unit, across the axis: the direction of travel. A blade's width lies along it
};
inline void describe(Visitor& v, ToolPose& p) {
  v("tip_mm", p.tip_mm, "End of the core; a ball's middle.");
  v("axis", p.axis, "Unit, pointing into the tissue.");
  v("heading", p.heading, "Unit, across the axis: the direction of travel.");
}

/// The part of `direction` across `axis` (unit), as a unit vector; of a direction along the axis: some direction across it.
[[nodiscard]] Vec3 heading_across(const Vec3& direction, const Vec3& axis);

/// The angle about `axis` from one heading to the other, (−π, π] rad; the parts across the axis count.
[[nodiscard]] double turn_rad(const Vec3& from_heading, const Vec3& to_heading, const Vec3& axis);

/// The pose a fraction t of the way from a to b, t in [0, 1]: tip linear, axis normalised linear, heading turned evenly about the axis.
[[nodiscard]] ToolPose between(const ToolPose& a, const ToolPose& b, double t);

/// The core of a tool in a pose: a point (1 corner), a segment (2) or a rectangle (4, in order), mm.
class ToolCore {
 public:
  ToolCore(const Tool& tool, const ToolPose& pose);
  [[nodiscard]] std::span<const Vec3> corners() const { return {corners_.data(), count_}; }

 private:
  std::array<Vec3, 4> corners_;
  std::size_t count_;
};

/// Distance, mm, between a tet (solid, any orientation, flat ones too) and a core; 0 where they meet. Exact.
[[nodiscard]] double distance_to_core(const std::array<Vec3, 4>& tet, const ToolCore& core);
/// Distance, mm, of a point from a core. Exact.
[[nodiscard]] double distance_to_core(const Vec3& point, const ToolCore& core);

/// Takes directions to the part of them in which the tool holds tissue in a pose: across the axis of needle and blade, along which tissue
/// slides; all of it for a ball.
[[nodiscard]] Mat3 held_directions(const Tool& tool, const ToolPose& pose);

/// How what a tool holds turns when the tool goes from one pose to another: with its axis and, for a blade, with its heading.
[[nodiscard]] Eigen::Quaterniond turn_of_held(const Tool& tool, const ToolPose& from, const ToolPose& to);

}  // namespace incise
