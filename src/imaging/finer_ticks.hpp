#pragma once

#include "imaging/opencv.hpp"
#include "imaging/ruler_ticks.hpp"

#include <optional>

namespace incise::imaging_detail {

/// A mark that recurs between neighbouring ticks of a row.
struct FinerTicks {
  double share = 0.0;     ///< its position between the two ticks, (0, 1)
  double contrast = 0.0;  ///< its darkness relative to the ticks'
};

/// Searches the grey values for a scale finer than the ticks found: ticks too faint or too short to be strokes. The
/// intervals from tick to tick are overlaid; a mark at the same place in most of them is neither a letter nor a speck.
/// @pre the comb has at least 8 ticks
[[nodiscard]] std::optional<FinerTicks> finer_ticks(const cv::Mat& grey, const Comb& comb);

/// Returns whether every second tick is longer than its neighbours: a scale of halves (half millimetres, sixteenths of
/// an inch). On a scale of tenths, every fifth and tenth tick is longer.
[[nodiscard]] bool every_second_is_longer(const Comb& comb);

}  // namespace incise::imaging_detail
