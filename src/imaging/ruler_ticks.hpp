#pragma once

#include "imaging/strokes.hpp"

#include <incise/imaging/photo_scale.hpp>

#include <filesystem>
#include <optional>
#include <vector>

namespace incise::imaging_detail {

/// The ticks of one ruler, in order: evenly spaced, some may be missing.
struct Comb {
  std::vector<Stroke> ticks;
  std::vector<double> numbers;    ///< whole positions of the ticks, in spacings from the first
  std::vector<std::size_t> used;  ///< indices of the ticks in the list of strokes
  double spacing_px = 0.0;        ///< along the row
  double error_px = 0.0;          ///< standard error of the spacing
};

/// Returns the shape of a comb's row, from polynomials fitted through the ticks' ends or middles, whichever lie in
/// line.
/// @pre at least 8 ticks
[[nodiscard]] RulerShape shape_of(const Comb& comb);

/// Finds a ruler by its ticks; see find_ruler. @throws DataError if there are no ticks, ticks of two spacings, or marks
/// between them; without a length, also if every second tick is longer.
[[nodiscard]] Ruler ruler_of_ticks(const ColorPicture& picture, std::optional<double> length_mm,
                                   const std::filesystem::path& name);

/// Refuses a picture that shows a ruler's ticks; for a scale that is a bar. @throws DataError
void require_no_ticks(const ColorPicture& picture, const std::filesystem::path& name);

}  // namespace incise::imaging_detail
