#pragma once

#include "imaging/strokes.hpp"

#include <incise/imaging/photo_scale.hpp>

#include <filesystem>
#include <optional>
#include <vector>

namespace incise::imaging_detail {

/// Ticks of one ruler, in order, numbered by their place: evenly spaced, some may be missing.
struct Comb {
  std::vector<Stroke> ticks;
  std::vector<double> numbers;
  std::vector<std::size_t> used;  ///< of the strokes looked through
  double spacing_px = 0.0;        ///< along the row
  double error_px = 0.0;          ///< standard error of the spacing
};

/// The shape of a comb's row, from cubics fitted through the ticks' ends or middles, whichever lie in line.
/// @pre 8 ticks or more
[[nodiscard]] RulerShape shape_of(const Comb& comb);

/// @throws DataError where no ticks are found, ticks of two spacings, or marks between them; without a length also
/// where every second is longer.
[[nodiscard]] Ruler ruler_of_ticks(const ColorPicture& picture, std::optional<double> length_mm,
                                   const std::filesystem::path& name);

/// Refuses a picture with a ruler's ticks in view, for one whose scale is a bar. @throws DataError
void require_no_ticks(const ColorPicture& picture, const std::filesystem::path& name);

}  // namespace incise::imaging_detail
