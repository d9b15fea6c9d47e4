#pragma once

#include <incise/calibration/calibration.hpp>
#include <incise/core/outcome.hpp>
#include <incise/evaluation/comparison.hpp>
#include <incise/evaluation/evaluation.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <vector>

namespace incise {

/// Returns the points of an evaluation as equally long lists: x_mm, y_mm, z_mm, arclength_mm (from the first point),
/// signed_error_mm and, for a ring, clock_h. `incise evaluate` writes them under the key `points`.
[[nodiscard]] nlohmann::ordered_json points_json(const Evaluation& evaluation);

/// Returns the points of a contour as equally long lists: x_mm, y_mm, z_mm. `incise evaluate` writes the tumour edge of
/// a ring in this form under `tumor_edge`, and the viewing direction under `approach`.
[[nodiscard]] nlohmann::ordered_json contour_json(const Contour& contour);

/// Content of a file of `incise evaluate`, as far as `incise compare` uses it.
struct EvaluationFile {
  MeasuredSpecimen specimen;  ///< named after the file, without extension; no errors if no incision was found
  Outcome outcome = Outcome::OpenLoop;
  std::optional<bool> negative_margin;
  ContourKind contour = ContourKind::Centerline;
  double target_mm = 0.0;
  std::vector<double> clock_h;  ///< one for each error; empty for an open cut
  std::optional<double> hu_score, hu_score_ideal, centroid_shift_mm;
  std::optional<double> positive_at_mm, too_close_at_mm;  ///< upper limits of the two zones, signed error
  std::optional<Verdict> verdict;                         ///< on the measurement; photographs only
};
void describe(Visitor& v, EvaluationFile& file);

/// Reads a file of `incise evaluate` for `incise compare`.
/// @throws DataError naming the file and the place that is missing, of another type or length, or out of range; also if
///         its `verdict` is refused.
[[nodiscard]] EvaluationFile read_evaluation_file(const std::filesystem::path& path);

/// Reads a photographed cut for a calibration from a file of `incise evaluate`: inner edge and tumour edge of a closed
/// ring, mm, and the approach, a unit vector; named after the file.
/// @throws DataError as read_evaluation_file; also for a ring that does not close, an open cut, a mid-line, a file
///         without `tumor_edge` or `approach`, and contours of impossible size.
[[nodiscard]] PhotographedCut read_photographed_cut(const std::filesystem::path& path);

}  // namespace incise
