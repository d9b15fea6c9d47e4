#pragma once

#include <incise/geometry/types.hpp>

#include <string>
#include <vector>

namespace incise {

/// A needle electrode: a capsule round its axis. Defaults: the paper's monopolar electrode (II-B.2).
struct Needle {
  double diameter_mm = 1.0;  ///< > 0
  double length_mm = 25.0;   ///< > 0, from the tip to the insulated shaft
  [[nodiscard]] double radius_mm() const { return 0.5 * diameter_mm; }
};

/// Every violation, one sentence each; empty: valid.
[[nodiscard]] std::vector<std::string> validate(const Needle& needle);

/// Where a tool is: its tip and the direction from shaft to tip.
struct ToolPose {
  Vec3 tip_mm = Vec3::Zero();
  Vec3 axis = -Vec3::UnitZ();  ///< unit, pointing into the tissue
};

/// The pose a fraction t of the way from a to b (tip linear, axis normalised linear), t in [0, 1].
[[nodiscard]] ToolPose between(const ToolPose& a, const ToolPose& b, double t);

}  // namespace incise
