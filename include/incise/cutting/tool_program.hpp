#pragma once

#include <incise/cutting/cut_settings.hpp>
#include <incise/cutting/tool.hpp>
#include <incise/geometry/tool_path.hpp>

#include <vector>

namespace incise {

/// Returns the length of the tip's way along a path, mm: from the first waypoint, at depth, to the last or, on a ring,
/// back to the first.
[[nodiscard]] double tip_way_mm(const ToolPath& path);

/// The simulated tool's motion as a function of time: plunge along the axis at the first waypoint, follow the waypoints
/// (straight between them), on a ring overlap beyond the start, and dwell for the time that removes a tet of the
/// reference tissue. The tool moves at CutSettings::speed_mm_s throughout; the waypoints' speeds apply only to the
/// robot. The heading is the direction of travel. Before a blade changes direction, it turns on the spot, its edges at
/// that speed.
class ToolProgram {
 public:
  enum class Phase { Plunge, Follow, Overlap, Dwell };

  /// @throws InvalidArgument unless the path is in PathFrame::SimStretched and has at least 2 waypoints (3 for a ring),
  /// all finite, with unit axes and depths > 0; or if the overlap of a ring is not below tip_way_mm(path).
  ToolProgram(const ToolPath& path, const CutSettings& settings, const Tool& tool);

  [[nodiscard]] double duration_s() const { return keys_.back().time_s; }
  /// Returns the pose at a time; before 0 the first pose, after the end the last.
  [[nodiscard]] ToolPose pose_at(double time_s) const;
  [[nodiscard]] Phase phase_at(double time_s) const;
  /// Returns the length of the tip's way since it began to plunge, mm; turns on the spot add nothing.
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
