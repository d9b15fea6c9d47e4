#pragma once

#include "planning/surface_walk.hpp"

#include <incise/planning/converging_compensation.hpp>

namespace incise {

/// One waypoint's way across the surface.
struct Move {
  Vec3 position_mm;
  double length_mm = 0.0;  ///< straight, >= 0
};

/// From `start`, `length_mm` far over the surface in unit direction `heading` of the picture, or as far as is allowed:
/// clear of the surface's rim and, inwards, with the region's margin from the edge.
/// @pre `start` shows the surface.
[[nodiscard]] Move move_over(const Vec2& start, const Vec2& heading, double length_mm, bool is_inward,
                             const SurfaceView& view, const Contour& edge, const SafeRegion& region);

/// The intended path and the rays along which its waypoints move: away from the nearest point of the tumour edge.
class MovablePath {
 public:
  /// @throws CaseError for a waypoint that lies on the edge.
  MovablePath(const ToolPath& intended, const SurfaceQuery& surface, const SafeRegion& region);

  struct Moved {
    ToolPath path;
    std::vector<double> offset_mm;         ///< as reached
    std::vector<std::uint8_t> is_limited;  ///< 1 where it is less than was asked for
  };
  /// The path with its waypoints `offset_mm` from their intended places, each as far as the region lets it.
  [[nodiscard]] Moved at(const std::vector<double>& offset_mm) const;
  /// Whether a moved path can be cut: it does not cross itself, and the tissue is thick enough everywhere.
  [[nodiscard]] bool can_be_cut(const ToolPath& path) const;

 private:
  ToolPath intended_;
  const SurfaceQuery& surface_;
  SafeRegion region_;
  SurfaceView view_;
  std::vector<Vec2> headings_;
};

}  // namespace incise
