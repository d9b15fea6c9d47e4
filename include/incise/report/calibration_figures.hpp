#pragma once

#include <optional>
#include <string>
#include <vector>

namespace incise {

/// A grid of speed and dullness as the paper's Table I has it.
struct ScoreGrid {
  std::vector<double> speeds_mm_s;  ///< ascending
  std::vector<double> dullnesses;   ///< ascending
  struct Cell {
    bool is_failure = false;
    double score_percent = 0.0;            ///< 0 for a failure
    std::optional<double> mean_signed_mm;  ///< of the mid-line; absent: nothing to measure
  };
  std::vector<Cell> cells;            ///< speed by speed
  std::optional<std::size_t> chosen;  ///< into cells
  bool is_virtual = false;
};

/// Table I as two heat maps: the score in per cent of the photographs, and the mean signed error. Failed cells are
/// hatched, the chosen one is framed, every cell says its number. @throws InvalidArgument for a grid without cells, of
/// another count than speeds times dullnesses, or numbers that are not finite.
[[nodiscard]] std::string score_heat_map_svg(const ScoreGrid& grid);

/// One specimen's signed error by direction from the tumour's middle, first entry at the start of the path, evenly
/// round.
struct ProfileCurves {
  std::string name;
  std::vector<double> photographed_mm;
  std::vector<double> fitted_mm;
  std::vector<double> simulated_mm;  ///< at the fitted values; empty: that cut left no ring
};

/// The marginal of one parameter.
struct MarginalCurve {
  std::string label;           ///< with unit
  std::vector<double> values;  ///< ascending
  std::vector<double> density;
  double low = 0.0, high = 0.0;  ///< credible interval
};

/// Photographed and fitted errors of every specimen, and below them the marginals. @throws InvalidArgument without
/// specimens, for lists of different length, or numbers that are not finite.
[[nodiscard]] std::string drag_fit_svg(const std::vector<ProfileCurves>& specimens,
                                       const std::vector<MarginalCurve>& marginals, bool is_virtual);

}  // namespace incise
