#pragma once

#include <incise/planning/plan_path.hpp>

#include <span>

namespace incise {

/// An incision planned on a mark that a camera saw.
struct MarkedPlan {
  PlanSettings settings;   ///< lateral_margin_mm and kind are not looked at
  double margin_mm = 5.0;  ///< from the mark to the incision, >= 0; 0: along the mark
};

/// Plans on a measured cloud. With a margin the mark is the tumour edge and the path the ring outside it, as plan_ring
/// makes it on the cloud's surface (see CloudSurface::body; its floor stands in for what no camera sees, so that no
/// thickness is checked). Without, the path runs along the mark itself, open or closed.
/// @param mark   on the tissue, robot frame, mm; @param cloud  the tissue around, same frame.
/// @returns frame robot, kind incise.
/// @throws InvalidArgument for settings out of range or too few points; CaseError where the path would leave the
/// measured surface.
[[nodiscard]] ToolPath plan_marked_path(const Contour& mark, std::span<const Vec3> cloud, const MarkedPlan& plan);

}  // namespace incise
