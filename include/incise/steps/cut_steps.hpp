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
  std::optional<RulerKind> ruler;    ///< kind of the ruler in the photograph
  std::optional<double> ruler_mm;    ///< distance of two of its finest ticks, by default 1; of a bar: its length
  std::vector<double> two_points;    ///< two points and their distance: u v u v in pixels, then mm
  std::vector<double> rectangle;     ///< corners of a rectangle, lower left first, counter-clockwise: u v each, px
  std::vector<double> rectangle_mm;  ///< width and height of the rectangle
  [[nodiscard]] int ways() const;
};

struct FoundScale {
  PhotoScale scale;
  nlohmann::ordered_json summary;  ///< how it was found
  std::vector<Vec2> marks_px;      ///< marks from which the scale was read
  std::optional<Ruler> ruler;      ///< absent: the scale was not read from a ruler
};
/// Finds the scale of a photograph. @param name  of the photograph, for messages. @throws CaseError unless the scale is
/// given in exactly one way, or if its points or lengths determine none; DataError where no ruler is found.
[[nodiscard]] FoundScale find_scale(const ScaleRequest& request, const ColorPicture& picture,
                                    const std::filesystem::path& name);

/// Input of evaluate_cut: a photograph of a cut, or contours.
struct EvaluateRequest {
  std::filesystem::path photo;         ///< empty: contours are given
  std::filesystem::path incision;      ///< only with contours
  std::filesystem::path tumor;         ///< only with contours: the tumour edge; or …
  std::filesystem::path line;          ///< … for an open cut the intended line
  bool is_open = false;                ///< the incision's contour is open
  std::optional<ContourKind> contour;  ///< absent: the inner edge of a photograph, the mid-line of contours
  std::optional<Vec3> approach;        ///< only with contours; absent: from above
  EvaluationSettings settings;         ///< valid; `contour` and `approach` above replace its own
  ScaleRequest scale;                  ///< only with a photograph
  RedLine red = RedLine::Annotation;
  double max_gap_mm = PhotoSettings{}.max_gap_mm;
  std::string specimen_id;       ///< of the cut specimen; empty: as the files state
  std::filesystem::path figure;  ///< .svg or .png (a photograph: .png); empty: none
  ErrorColors colors = ErrorColors::Safe;
  std::filesystem::path output;  ///< JSON; empty: no file
};
/// Describes the fields that are options of `incise evaluate`.
void describe(Visitor& v, EvaluateRequest& r);
/// Measures a cut. Not acceptable: an outcome of the cut other than success, or a verdict that refuses the measurement;
/// see `outcome` and `verdict` of the JSON. @throws DataError, CaseError
[[nodiscard]] StepResult evaluate_cut(const EvaluateRequest& request, const StepContext& context);

/// The lines found in a photograph, in its pixels.
struct FoundPixels {
  std::vector<Vec2> marks_px;  ///< marks of the scale
  std::vector<Vec2> incision_px;
  bool incision_is_closed = true;
  std::vector<Vec2> tumor_edge_px;
};
struct EvaluatedCut {
  StepResult step;
  FoundPixels pixels;  ///< empty lists if contours were measured
};
/// As evaluate_cut, and also returns the positions in the photograph. @throws as evaluate_cut.
[[nodiscard]] EvaluatedCut evaluate_in_pixels(const EvaluateRequest& request, const StepContext& context);

/// Input of compare_cuts: evaluations before and after a change.
struct CompareRequest {
  std::vector<std::filesystem::path> before;  ///< at least one
  std::vector<std::filesystem::path> after;   ///< at least one
  ComparisonSettings settings;                ///< valid
  std::filesystem::path output;               ///< folder; empty: no files
};
/// One incision of a comparison: a row of its table.
struct ComparedRow {
  std::string name;
  std::string side;  ///< before, after
  Outcome outcome = Outcome::OpenLoop;
  double target_mm = 0.0;
  std::optional<double> hu_score, hu_score_ideal, centroid_shift_mm;
  std::size_t n_points = 0;
  std::optional<double> mean_mm, sd_mm;     ///< absent if nothing was compared, or if it has no errors
  std::optional<std::size_t> block_points;  ///< length of a block of the bootstrap; absent likewise
  std::optional<double> n_effective;
};
void describe(Visitor& v, ComparedRow& r);

/// An incision without errors. No mean includes it, so it improves none.
struct LeftOut {
  std::string name;
  Outcome outcome = Outcome::OpenLoop;
};
inline void describe(Visitor& v, LeftOut& l) {
  v("name", l.name, "Name of the file of the incision.");
  v("outcome", l.outcome, "Outcome of the cut.");
}

/// Result of a comparison; the content of compare.json.
struct CutComparison {
  ErrorMeasure measure = ErrorMeasure::Absolute;
  ContourKind contour = ContourKind::Centerline;
  std::optional<double> target_mm;         ///< absent: incisions have different targets
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
/// Compares cuts before and after a change: tests, tables and figures. Not acceptable: a side on which no cut has
/// errors. @throws DataError for files with different contours or targets (a paired comparison requires the same target
/// only within a pair), or for a pair of which one has no errors; InvalidArgument for a paired comparison with sides of
/// different length.
[[nodiscard]] CompareResult compare_cuts(const CompareRequest& request, const StepContext& context);

}  // namespace incise::steps
