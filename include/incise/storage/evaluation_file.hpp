#pragma once

#include <incise/core/outcome.hpp>
#include <incise/evaluation/comparison.hpp>
#include <incise/evaluation/evaluation.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise {

/// The points of an evaluation as equally long lists: x_mm, y_mm, z_mm, arclength_mm (from the first point),
/// signed_error_mm, and of a ring clock_h. This is the key `points` of the file that `incise evaluate` writes.
[[nodiscard]] nlohmann::ordered_json points_json(const Evaluation& evaluation);

/// What `incise compare` takes from one file of `incise evaluate`.
struct EvaluationFile {
  MeasuredSpecimen specimen;  ///< named after the file, without its ending; no errors where no incision was found
  Outcome outcome = Outcome::OpenLoop;
  std::optional<bool> negative_margin;
  std::string contour;  ///< centerline or inner_edge
  double target_mm = 0.0;
  std::vector<double> clock_h;  ///< one for each error; empty for an open cut
  std::optional<double> hu_score, hu_score_ideal, centroid_shift_mm;
  std::optional<double> positive_at_mm, too_close_at_mm;  ///< upper borders of the two zones
};

/// @throws DataError naming the file and the key that is missing, of another kind, not finite, or of another length.
[[nodiscard]] EvaluationFile read_evaluation_file(const std::filesystem::path& path);

}  // namespace incise
