#pragma once

#include <incise/cutting/incision.hpp>
#include <incise/evaluation/contour_errors.hpp>
#include <incise/workflow/case.hpp>

namespace incise {

/// Errors of a layer's mid-line against the lateral margin, seen along the approach, at the skin's height, mm.
/// @pre the layer has a mid-line.  @param tumor_edge  closed, mm.  @throws InvalidArgument as contour_errors.
[[nodiscard]] ContourErrors layer_line_errors(const Case& settings, const KerfLayer& layer, const Contour& tumor_edge);

}  // namespace incise
