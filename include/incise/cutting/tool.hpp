#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/problem.hpp>
#include <incise/geometry/types.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <span>
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

/// A blade electrode: a thin box with rounded edges that moves edge first. Its mid-plane is a rectangle, `width_mm`
/// along the heading and `length_mm` along the axis; the blade is the space within half its thickness of that
/// rectangle. The defaults are a common size, not one from a standard.
struct Blade {
  double thickness_mm = 0.5;  ///< > 0, perpendicular to axis and heading
  double width_mm = 2.4;      ///< > 0, of the mid-plane, centred on the axis
  double length_mm = 25.0;    ///< > 0, from the tip to the insulated shaft
};

/// A ball electrode: a sphere about the tip. It has no length: its wire touches no tissue. The default is a common
/// size, not one from a standard.
struct Ball {
  double diameter_mm = 2.0;  ///< > 0
};

/// An instrument. For contact, every tool is the space within `radius_mm` of a flat convex core (ToolCore).
using Tool = std::variant<Needle, Blade, Ball>;
inline constexpr std::array<std::string_view, 3> kToolNames{"needle", "blade", "ball"};
[[nodiscard]] constexpr std::span<const std::string_view> names_of(const Tool&) {
  return kToolNames;
}
/// Describes the kind of a tool and its dimensions.
/// @throws as Visitor::refuse for a dimension that belongs to another kind.
void describe(Visitor& v, Tool& tool);

/// Returns the name of the tool's kind: "needle", "blade" or "ball".
[[nodiscard]] std::string_view kind_of(const Tool& tool);
/// Returns the distance of the tool's surface from its core, mm: half its diameter or thickness, which is also half the
/// width of an ideal kerf.
[[nodiscard]] double radius_mm(const Tool& tool);
/// Returns the length of the tool's cutting part, from the tip, mm; nullopt for a ball.
[[nodiscard]] std::optional<double> length_mm(const Tool& tool);
/// Returns the greatest distance of the core from the axis, mm: half a blade's width; 0 for a tool that is round about
/// its axis.
[[nodiscard]] double half_width_mm(const Tool& tool);
/// Returns all violations; empty: the tool is valid.
[[nodiscard]] std::vector<Problem> validate(const Tool& tool);

/// Position and orientation of a tool.
struct ToolPose {
  Vec3 tip_mm = Vec3::Zero();     ///< end of the core; centre of a ball
  Vec3 axis = -Vec3::UnitZ();     ///< unit, from shaft to tip, into the tissue
  Vec3 heading = Vec3::UnitX();   ///< unit, perpendicular to the axis: the direction of travel. A blade's width lies
                                  ///< along it
};
inline void describe(Visitor& v, ToolPose& p) {
  v("tip_mm", p.tip_mm, "End of the core; centre of a ball.");
  v("axis", p.axis, "Unit vector along the axis, into the tissue.");
  v("heading", p.heading, "Unit vector in the direction of travel, perpendicular to the axis.");
}

/// Returns the component of `direction` perpendicular to `axis` (unit), normalised; for a direction along the axis, an
/// arbitrary unit vector perpendicular to it.
[[nodiscard]] Vec3 heading_across(const Vec3& direction, const Vec3& axis);

/// Returns the angle about `axis` (unit) from one heading to the other, [−π, π] rad. Only their components
/// perpendicular to the axis count.
[[nodiscard]] double turn_rad(const Vec3& from_heading, const Vec3& to_heading, const Vec3& axis);

/// Returns the pose at fraction t of the way from a to b, t in [0, 1]: the tip interpolated linearly, the axis linearly
/// and then normalised, the heading turned at a constant rate about the axis.
[[nodiscard]] ToolPose between(const ToolPose& a, const ToolPose& b, double t);

/// The core of a tool in a pose: a point (1 corner), a segment (2) or a rectangle (4, in order round it), mm.
class ToolCore {
 public:
  ToolCore(const Tool& tool, const ToolPose& pose);
  [[nodiscard]] std::span<const Vec3> corners() const { return {corners_.data(), count_}; }

 private:
  std::array<Vec3, 4> corners_;
  std::size_t count_;
};

/// Returns the exact distance between a solid tet and a core, mm; 0 where they meet. The tet may be flat and of either
/// orientation.
[[nodiscard]] double distance_to_core(const std::array<Vec3, 4>& tet, const ToolCore& core);
/// Returns the exact distance of a point from a core, mm.
[[nodiscard]] double distance_to_core(const Vec3& point, const ToolCore& core);

/// Returns the projection onto the directions in which the tool holds tissue: perpendicular to the axis of a needle or
/// blade, along which tissue slides; the identity for a ball.
[[nodiscard]] Mat3 held_directions(const Tool& tool, const ToolPose& pose);

/// Returns the rotation of the held tissue when the tool moves from one pose to another: it follows the axis and, for a
/// blade, the heading.
[[nodiscard]] Eigen::Quaterniond turn_of_held(const Tool& tool, const ToolPose& from, const ToolPose& to);

}  // namespace incise
