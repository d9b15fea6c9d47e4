#pragma once

#include <incise/planning/plan_path.hpp>

#include <span>

namespace incise {

/// An incision planned on a mark that a camera saw.
struct MarkedPlan {
  PlanSettings settings;   ///< lateral_margin_mm and kind are ignored
  double margin_mm = 5.0;  ///< from the mark to the incision, >= 0; 0: along the mark
};

/// Plans an incision on a measured cloud. With a margin, the mark is the tumour edge and the path is the ring outside
/// it, which plan_ring plans on the cloud's surface. CloudSurface::body closes that surface far below, because no
/// camera sees the underside, so the thickness of the tissue is not checked. Without a margin, the path runs along the
/// mark itself, open or closed.
/// @param mark   on the tissue, robot frame, mm, at least 3 points; closed for a margin above 0.
/// @param cloud  the tissue around the mark, same frame.
/// @returns a path in frame robot, of kind incise.
/// @throws InvalidArgument for settings out of range, too few points, or an open mark with a margin; CaseError if the
/// path would leave the measured surface.
[[nodiscard]] ToolPath plan_marked_path(const Contour& mark, std::span<const Vec3> cloud, const MarkedPlan& plan);

}  // namespace incise
