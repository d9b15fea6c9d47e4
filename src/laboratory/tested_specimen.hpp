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

/// What the bench knows of one cut.
struct TrueCut {
  std::optional<double> mean_abs_error_mm;  ///< absent: the ring stayed open
  double least_margin_mm = 0.0;             ///< of a closed one, between kerf and edge
};
/// @param truth  folder with NAME_TAG/cut_truth.json.
/// @returns nothing where this run made no such cut, whatever an earlier one left there. @throws DataError.
[[nodiscard]] std::optional<TrueCut> true_cut(const std::filesystem::path& truth, const Trial& trial,
                                              const TrialCut& cut, std::string_view tag);

enum class PathEnd {
  Measured,  ///< a closed ring in the photograph
  Open,      ///< cut, and open or not to be found
  NotCut,    ///< a step refused the path
};
inline constexpr std::array<std::string_view, 3> kPathEndNames{"measured", "open", "not_cut"};
[[nodiscard]] constexpr Names names_of(PathEnd) {
  return kPathEndNames;
}

inline constexpr double kMostErrorMm = 1e3;  ///< of what is read: no ring is that large

/// What came of one specimen along one path.
struct PathCut {
  std::string path;  ///< as_planned, incise, or that of a RivalPath
  PathEnd end = PathEnd::NotCut;
  std::optional<double> mean_abs_error_mm;  ///< of the photograph; where it is measured
  std::optional<double> least_margin_mm;    ///< of the truth; where the ring truly closed
};
inline void describe(Visitor& v, PathCut& c) {
  v("path", c.path, "as_planned, incise, or a rival.");
  v("end", c.end, "Whether it was cut, and its ring closed in the photograph.");
  v({"mean_abs_error_mm", "Of the photograph's points.", "mm"}, c.mean_abs_error_mm, {0.0, kMostErrorMm});
  v({"least_margin_mm", "Least distance of the true kerf from the tumour's edge; absent: open.", "mm"},
    c.least_margin_mm);
}

/// What came of one along the forecast of only the first photographs.
struct LearningPathCut {
  std::size_t photographs = 0;
  PathCut cut;  ///< along `photographs` or `learned`
};
inline void describe(Visitor& v, LearningPathCut& c) {
  v("photographs", c.photographs, "Of the calibration, the first.");
  describe(v, c.cut);
}

/// A test specimen whose planned cut was measured, and what came of it along every path. It is what comparisons are
/// made of, within one experiment and over several.
struct TestedSpecimen {
  std::string name;
  std::optional<std::size_t> unlike;  ///< covariates outside those of the calibration; absent: no forecast
  std::vector<PathCut> cuts;          ///< as planned first
  std::vector<LearningPathCut> learning;  ///< by photographs, ascending
  /// Nothing: this path was not asked for.
  [[nodiscard]] const PathCut* find(std::string_view path) const;
};
inline void describe(Visitor& v, TestedSpecimen& s) {
  v("specimen", s.name, "Its name.");
  v("unlike", s.unlike, "Covariates outside those of the calibration.");
  v("cuts", s.cuts, "Along every path, as planned first.");
  v("learning", s.learning, "Along the forecasts of the first photographs.");
}

inline constexpr std::string_view kAsPlannedPath = "as_planned";
inline constexpr std::string_view kIncisePath = "incise";
/// Whether no simulated cut takes part in a path of that name. @throws InvalidArgument for a name of no path.
[[nodiscard]] bool is_path_without_simulation(std::string_view name);

/// Of the trials that are tests and whose planned cut was measured. @throws DataError for a truth that is damaged.
[[nodiscard]] std::vector<TestedSpecimen> tested_specimens(const std::vector<Trial>& trials,
                                                           const std::filesystem::path& truth);

/// Those whose rings are unlike the calibration's, or the others; without a forecast a ring is neither.
[[nodiscard]] std::vector<TestedSpecimen> of_likeness(const std::vector<TestedSpecimen>& specimens, bool is_unlike);

}  // namespace incise::laboratory
