#pragma once

#include <optional>
#include <string>
#include <vector>

namespace incise {

/// Scores on a grid of speed and dullness, as in the paper's Table I.
struct ScoreGrid {
  std::vector<double> speeds_mm_s;  ///< ascending
  std::vector<double> dullnesses;   ///< ascending
  struct Cell {
    bool is_failure = false;
    double score_percent = 0.0;            ///< registration score, per cent of the baseline; 0 for a failure
    std::optional<double> mean_signed_mm;  ///< mean signed error of the mid-line; absent: nothing to measure
  };
  std::vector<Cell> cells;            ///< one per speed and dullness; the dullness varies fastest
  std::optional<std::size_t> chosen;  ///< index into cells; absent: none was chosen
  bool is_virtual = false;
};

/// Draws Table I as two heat maps: the registration score, and the mean signed error of the mid-line. Speeds run
/// downwards, dullness to the right. Failed cells are hatched, the others show their number, and a frame marks the
/// chosen cell.
/// @returns a complete SVG document. @throws InvalidArgument unless there is a cell for each pair of speed and
/// dullness, `chosen` is one of them, and all speeds, values of dullness, scores and errors are finite.
[[nodiscard]] std::string score_heat_map_svg(const ScoreGrid& grid);

/// One specimen's signed error in evenly spaced directions from the middle of the tumour edge, counter-clockwise from
/// the start of the path.
struct ProfileCurves {
  std::string name;
  std::vector<double> photographed_mm;
  std::vector<double> fitted_mm;
  std::vector<double> simulated_mm;  ///< at the fitted values; empty: that cut left no ring
};

/// The marginal posterior density of one parameter.
struct MarginalCurve {
  std::string label;           ///< with unit
  std::vector<double> values;  ///< ascending
  std::vector<double> density;
  double low = 0.0, high = 0.0;  ///< credible interval
};

/// Draws the photographed, fitted and simulated errors of every specimen, and below them the marginals.
/// @returns a complete SVG document. @throws InvalidArgument without specimens, for lists of different length or of
/// fewer than two values, or for a number that is not finite.
[[nodiscard]] std::string drag_fit_svg(const std::vector<ProfileCurves>& specimens,
                                       const std::vector<MarginalCurve>& marginals, bool is_virtual);

}  // namespace incise
