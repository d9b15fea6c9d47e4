#pragma once

#include "planning/surface_walk.hpp"

#include <incise/planning/converging_compensation.hpp>

namespace incise {

/// A move that falls short by no more than this counts as complete.
inline constexpr double kMoveToleranceMm = 1e-6;

/// Moves a waypoint over the surface by `wanted_mm` in space, along unit direction `outward` of the picture (inwards if
/// below 0), or as far as the region allows: clear of the surface's rim and, inwards, with its margin from the edge.
/// Returns the signed distance reached, mm. @pre the waypoint shows the surface.
[[nodiscard]] double move_waypoint(Waypoint& waypoint, const Vec2& outward, double wanted_mm, const SurfaceView& view,
                                   const Contour& edge, const SafeRegion& region);

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
