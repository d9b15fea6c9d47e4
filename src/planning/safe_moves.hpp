#pragma once

#include "planning/surface_walk.hpp"

#include <incise/planning/converging_compensation.hpp>

namespace incise {

/// A move of a waypoint over the surface.
struct Move {
  Vec3 position_mm;
  double length_mm = 0.0;  ///< straight distance in space, mm, >= 0
};

/// Moves from `start` over the surface in unit direction `heading` of the picture, by `length_mm` in space or as far as
/// the region allows: clear of the surface's rim and, inwards, with its margin from the edge.
/// @pre `start` shows the surface.
[[nodiscard]] Move move_over(const Vec2& start, const Vec2& heading, double length_mm, bool is_inward,
                             const SurfaceView& view, const Contour& edge, const SafeRegion& region);

/// The intended path, and the rays along which its waypoints move: away from the nearest point of the tumour edge, in
/// the picture.
class MovablePath {
 public:
  /// @throws CaseError for a waypoint that lies on the edge.
  MovablePath(const ToolPath& intended, const SurfaceQuery& surface, const SafeRegion& region);

  struct Moved {
    ToolPath path;
    std::vector<double> offset_mm;         ///< reached
    std::vector<std::uint8_t> is_limited;  ///< 1 where it is less than requested
  };
  /// Returns the path with its waypoints `offset_mm` from their intended places, each as far as the region allows.
  [[nodiscard]] Moved at(const std::vector<double>& offset_mm) const;
  /// Returns whether a moved path can be cut (see check_path): for example, it does not cross itself, and the tissue is
  /// thick enough everywhere.
  [[nodiscard]] bool can_be_cut(const ToolPath& path) const;

 private:
  ToolPath intended_;
  const SurfaceQuery& surface_;
  SafeRegion region_;
  SurfaceView view_;
  std::vector<Vec2> headings_;
};

}  // namespace incise
