#pragma once

#include <incise/cutting/cut_settings.hpp>
#include <incise/cutting/tool.hpp>
#include <incise/geometry/tool_path.hpp>

#include <vector>

namespace incise {

/// Way of the tip once along a path, from its first waypoint at depth to its last or, on a ring, back to the first; mm.
[[nodiscard]] double tip_way_mm(const ToolPath& path);

/// What the simulated tool does, as a function of time: plunge along the axis at the first waypoint, follow the waypoints (straight
/// between them), overlap beyond the start if the path is a ring, stay for the time that removes a tet of the
/// reference tissue at the electrode's power, and leave. All motion at CutSettings::speed_mm_s: the waypoints' own speeds are the robot's. The tool heads where it goes; a blade turns on the spot before it
/// sets out in another direction, its edges at the same speed.
class ToolProgram {
 public:
  enum class Phase { Plunge, Follow, Overlap, Dwell };

  /// @pre path in PathFrame::SimStretched with at least 2 waypoints (3 for a ring), finite, unit axes, depth > 0; on a ring the overlap is
  /// below tip_way_mm(path).
  ToolProgram(const ToolPath& path, const CutSettings& settings, const Tool& tool);

  [[nodiscard]] double duration_s() const { return keys_.back().time_s; }
  /// Pose at a time; before 0 and after the end: that of the nearer end.
  [[nodiscard]] ToolPose pose_at(double time_s) const;
  [[nodiscard]] Phase phase_at(double time_s) const;
  /// Way of the tip since it began to plunge, mm; turns on the spot add nothing.
  [[nodiscard]] double way_mm_at(double time_s) const;

 private:
  struct Key {
    double time_s;
    ToolPose pose;
    Phase phase;          ///< of the motion that ends at this key
    double way_mm = 0.0;  ///< of the tip, up to this key
  };
  [[nodiscard]] std::size_t key_after(double time_s) const;
  std::vector<Key> keys_;
};

}  // namespace incise
