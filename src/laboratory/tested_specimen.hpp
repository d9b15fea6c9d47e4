#pragma once

#include "laboratory/experiment_tables.hpp"

#include <incise/core/describe.hpp>
#include <incise/core/names.hpp>

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace incise::laboratory {

/// The bench's knowledge of one cut.
struct TrueCut {
  std::optional<double> mean_abs_error_mm;  ///< absent: the ring stayed open
  double least_margin_mm = 0.0;             ///< of a closed ring, between kerf and edge
};
/// @param truth  folder with NAME_TAG/cut_truth.json.
/// @returns nothing if this run made no such cut, even if an earlier run left one there. @throws DataError.
[[nodiscard]] std::optional<TrueCut> true_cut(const std::filesystem::path& truth, const Trial& trial,
                                              const TrialCut& cut, std::string_view tag);

enum class PathEnd {
  Measured,  ///< a closed ring in the photograph
  Open,      ///< cut; the ring is open or was not found
  NotCut,    ///< a step refused the path
};
inline constexpr std::array<std::string_view, 3> kPathEndNames{"measured", "open", "not_cut"};
[[nodiscard]] constexpr Names names_of(PathEnd) {
  return kPathEndNames;
}

inline constexpr double kMostErrorMm = 1e3;  ///< limit for values that are read: no ring is that large

/// The result of one specimen along one path.
struct PathCut {
  std::string path;  ///< as_planned, incise, or the name of a RivalPath
  PathEnd end = PathEnd::NotCut;
  std::optional<double> mean_abs_error_mm;  ///< of the photograph; present if measured
  std::optional<double> least_margin_mm;    ///< of the truth; present if the ring truly closed
};
inline void describe(Visitor& v, PathCut& c) {
  v("path", c.path, "Name of the path: as_planned, incise, or a rival.");
  v("end", c.end, "Whether the path was cut and its ring closed in the photograph.");
  v({"mean_abs_error_mm", "Mean absolute error of the photograph's points.", "mm"}, c.mean_abs_error_mm,
    {0.0, kMostErrorMm});
  v({"least_margin_mm", "Least distance of the true kerf from the tumour's edge; absent: open.", "mm"},
    c.least_margin_mm);
}

/// The result of one specimen along the forecast from only the first photographs.
struct LearningPathCut {
  std::size_t photographs = 0;
  PathCut cut;  ///< along `photographs` or `learned`
};
inline void describe(Visitor& v, LearningPathCut& c) {
  v("photographs", c.photographs, "Number of photographs used, the first of the calibration.");
  describe(v, c.cut);
}

/// A test specimen whose planned cut was measured, and its results along every path. Comparisons, within one experiment
/// and over several, use these.
struct TestedSpecimen {
  std::string name;
  std::optional<std::size_t> unlike;  ///< number of covariates outside the calibration's range; absent: no forecast
  std::vector<PathCut> cuts;          ///< as planned first
  std::vector<LearningPathCut> learning;  ///< by photographs, ascending
  /// Returns null if this path was not requested.
  [[nodiscard]] const PathCut* find(std::string_view path) const;
};
inline void describe(Visitor& v, TestedSpecimen& s) {
  v("specimen", s.name, "Name of the specimen.");
  v("unlike", s.unlike, "Number of covariates outside the calibration's range.");
  v("cuts", s.cuts, "Cuts along every path, as planned first.");
  v("learning", s.learning, "Cuts along the forecasts from the first photographs.");
}

inline constexpr std::string_view kAsPlannedPath = "as_planned";
inline constexpr std::string_view kIncisePath = "incise";
/// Whether no simulated cut takes part in the path of that name. @throws InvalidArgument for an unknown name.
[[nodiscard]] bool is_path_without_simulation(std::string_view name);

/// Returns the trials that are tests and whose planned cut was measured. @throws DataError for a damaged truth.
[[nodiscard]] std::vector<TestedSpecimen> tested_specimens(const std::vector<Trial>& trials,
                                                           const std::filesystem::path& truth);

/// Returns the specimens whose rings are unlike the calibration's, or the others. A ring without a forecast is neither.
[[nodiscard]] std::vector<TestedSpecimen> of_likeness(const std::vector<TestedSpecimen>& specimens, bool is_unlike);

}  // namespace incise::laboratory
