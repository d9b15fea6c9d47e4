#pragma once

#include "imaging/opencv.hpp"
#include "imaging/ruler_ticks.hpp"

#include <optional>

namespace incise::imaging_detail {

/// A mark between two neighbouring ticks of most of a row.
struct FinerTicks {
  double share = 0.0;     ///< its place between the two ticks, (0, 1)
  double contrast = 0.0;  ///< its darkness as a share of the ticks'
};

/// Looks for a scale that is finer than the ticks that were found, in the grey values themselves: ticks too faint or
/// too short to be strokes. The pictures from each tick to the next are laid over one another, and what most of them
/// show at one place is no letter and no speck. @pre the comb has 8 ticks or more
[[nodiscard]] std::optional<FinerTicks> finer_ticks(const cv::Mat& grey, const Comb& comb);

/// Whether every second tick is longer than its neighbours: a scale of halves (half millimetres, sixteenths of an
/// inch). A scale of tenths has longer ticks at every fifth and tenth.
[[nodiscard]] bool every_second_is_longer(const Comb& comb);

}  // namespace incise::imaging_detail
