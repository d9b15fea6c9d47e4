#pragma once

#include <incise/evaluation/evaluation.hpp>
#include <incise/report/figures.hpp>

#include <string>

namespace incise::cli {

/// The contours of one evaluation with the signed error in colour, as in the paper's Fig. 6 c, d.
/// @pre the evaluation has errors.
[[nodiscard]] std::string evaluation_figure_svg(const Evaluation& evaluation, const Contour& tumor_edge,
                                                const EvaluationSettings& settings, const std::string& name,
                                                ErrorColors colors);

}  // namespace incise::cli
