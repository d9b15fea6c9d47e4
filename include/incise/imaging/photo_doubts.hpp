#pragma once

#include <incise/core/verdict.hpp>
#include <incise/imaging/photo_contours.hpp>
#include <incise/imaging/photo_scale.hpp>

namespace incise {

/// Adds what a ruler's own figures hold against the scale that it gives: `photo_scale` for a scale that is known badly,
/// `photo_oblique` for a camera that does not look straight down, `photo_lens` for a picture with lens distortion.
/// A figure counts where it exceeds its limit and 4 times its standard error. docs/models/photograph.md
void add_ruler_doubts(const Ruler& ruler, Verdict& verdict);

/// Adds `photo_ring` where a closed red ring would be open without a stretch that looks unlike the rest of it, or has a
/// gap above the largest that is allowed, by less than is measurable. @param max_gap_mm  of the photograph's settings
void add_ring_doubts(const PhotoContours& contours, double max_gap_mm, Verdict& verdict);

}  // namespace incise
