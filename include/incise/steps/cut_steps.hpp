#pragma once

#include <incise/evaluation/comparison.hpp>
#include <incise/evaluation/evaluation.hpp>
#include <incise/imaging/photo_contours.hpp>
#include <incise/imaging/photo_scale.hpp>
#include <incise/report/figures.hpp>
#include <incise/steps/step.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise::steps {

/// How a photograph's scale is given: exactly one way.
struct ScaleRequest {
  double mm_per_pixel = 0.0;         ///< 0: not given
  std::optional<RulerKind> ruler;    ///< found in the photograph
  std::optional<double> ruler_mm;    ///< between two of its finest ticks, by default 1; of a bar: its length
  std::vector<double> two_points;    ///< u v u v mm
  std::vector<double> rectangle;     ///< corners, lower left first, counter-clockwise: u v each
  std::vector<double> rectangle_mm;  ///< its width and height
  [[nodiscard]] int ways() const;
};

struct FoundScale {
  PhotoScale scale;
  nlohmann::ordered_json summary;  ///< how it was found
  std::vector<Vec2> marks_px;      ///< that it was read from
  std::optional<Ruler> ruler;      ///< likewise
};
/// @param name  stands for the photograph in messages. @throws CaseError for a scale that is given in no way or in
/// several, or by places that give none; DataError where no ruler is found.
[[nodiscard]] FoundScale find_scale(const ScaleRequest& request, const ColorPicture& picture,
                                    const std::filesystem::path& name);

/// From a photograph of a cut, or from contours, to its measures.
struct EvaluateRequest {
  std::filesystem::path photo;         ///< empty: contours
  std::filesystem::path incision;      ///< of contours
  std::filesystem::path tumor;         ///< of contours: the edge; or …
  std::filesystem::path line;          ///< … for an open cut the line that it was to follow
  bool is_open = false;                ///< the incision's contour is open
  std::optional<ContourKind> contour;  ///< absent: a photograph's inner edge, the mid-line of contours
  std::optional<Vec3> approach;        ///< of contours; absent: from above
  EvaluationSettings settings;         ///< valid; contour and approach are those above
  ScaleRequest scale;                  ///< of a photograph
  RedLine red = RedLine::Annotation;
  double max_gap_mm = PhotoSettings{}.max_gap_mm;
  std::string specimen_id;       ///< whose cut it is; empty: as the files state
  std::filesystem::path figure;  ///< empty: none
  ErrorColors colors = ErrorColors::Safe;
  std::filesystem::path output;  ///< JSON; empty: no file
};
/// The result is not acceptable if the cut's outcome is not a success, or if the verdict refuses the measurement; see
/// `outcome` and `verdict` of the JSON. @throws DataError, CaseError
[[nodiscard]] StepResult evaluate_cut(const EvaluateRequest& request, const StepContext& context);

/// What was found in a photograph, in its pixels.
struct FoundPixels {
  std::vector<Vec2> marks_px;  ///< of the scale
  std::vector<Vec2> incision_px;
  bool incision_is_closed = true;
  std::vector<Vec2> tumor_edge_px;
};
struct EvaluatedCut {
  StepResult step;
  FoundPixels pixels;  ///< empty lists for contours
};
/// As evaluate_cut, with the places in the photograph. @throws likewise
[[nodiscard]] EvaluatedCut evaluate_in_pixels(const EvaluateRequest& request, const StepContext& context);

/// From evaluations before and after a change to tests, tables and figures.
struct CompareRequest {
  std::vector<std::filesystem::path> before;  ///< at least one
  std::vector<std::filesystem::path> after;   ///< at least one
  ComparisonSettings settings;                ///< valid
  std::filesystem::path output;               ///< folder; empty: no files
};
/// One incision of a comparison, in its table.
struct ComparedRow {
  std::string name;
  std::string side;  ///< before, after
  Outcome outcome = Outcome::OpenLoop;
  double target_mm = 0.0;
  std::optional<double> hu_score, hu_score_ideal, centroid_shift_mm;
  std::size_t n_points = 0;
  std::optional<double> mean_mm, sd_mm;     ///< absent where nothing was compared, or it has no errors
  std::optional<std::size_t> block_points;  ///< likewise
  std::optional<double> n_effective;
};
void describe(Visitor& v, ComparedRow& r);

/// An incision that has no errors: it makes no mean better.
struct LeftOut {
  std::string name;
  Outcome outcome = Outcome::OpenLoop;
};
inline void describe(Visitor& v, LeftOut& l) {
  v("name", l.name, "Of its file.");
  v("outcome", l.outcome, "Of the cut.");
}

/// What a comparison found; the content of compare.json.
struct CutComparison {
  ErrorMeasure measure = ErrorMeasure::Absolute;
  ContourKind contour = ContourKind::Centerline;
  std::optional<double> target_mm;         ///< absent: specimens differ in it
  std::optional<PooledTests> points;       ///< absent where a side has no errors
  std::optional<SpecimenTests> specimens;  ///< likewise
  double alpha = 0.0, power = 0.0;
  std::vector<ComparedRow> rows;  ///< before, then after
  std::vector<LeftOut> left_out;
};
void describe(Visitor& v, CutComparison& c);

struct CompareResult {
  StepResult step;
  CutComparison found;
};
/// Not acceptable: a side on which no cut has errors. @throws DataError for files that are not of one kind.
[[nodiscard]] CompareResult compare_cuts(const CompareRequest& request, const StepContext& context);

}  // namespace incise::steps
