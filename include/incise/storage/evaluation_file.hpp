#pragma once

#include <incise/calibration/calibration.hpp>
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

/// The points of a contour as equally long lists: x_mm, y_mm, z_mm. The file of `incise evaluate` holds the tumour edge of a ring
/// so, under `tumor_edge`, and under `approach` the direction in which all was seen.
[[nodiscard]] nlohmann::ordered_json contour_json(const Contour& contour);

/// What `incise compare` takes from one file of `incise evaluate`.
struct EvaluationFile {
  MeasuredSpecimen specimen;  ///< named after the file, without its ending; no errors where no incision was found
  Outcome outcome = Outcome::OpenLoop;
  std::optional<bool> negative_margin;
  ContourKind contour = ContourKind::Centerline;
  double target_mm = 0.0;
  std::vector<double> clock_h;  ///< one for each error; empty for an open cut
  std::optional<double> hu_score, hu_score_ideal, centroid_shift_mm;
  std::optional<double> positive_at_mm, too_close_at_mm;  ///< upper borders of the two zones
  std::optional<Verdict> verdict;                         ///< on the measurement; of a photograph only
};
void describe(Visitor& v, EvaluationFile& file);

/// @throws DataError naming the file and the place that is missing, of another kind, not finite, or of another length;
/// for a file whose `verdict` is refused.
[[nodiscard]] EvaluationFile read_evaluation_file(const std::filesystem::path& path);

/// What a calibration takes from one file of `incise evaluate`: the contours of a closed ring, named after the file.
/// @throws DataError as above; also for an open ring, a mid-line, and a file without `tumor_edge` and `approach`.
[[nodiscard]] PhotographedCut read_photographed_cut(const std::filesystem::path& path);

}  // namespace incise
