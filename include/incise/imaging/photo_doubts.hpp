#pragma once

#include <incise/core/verdict.hpp>
#include <incise/imaging/photo_contours.hpp>
#include <incise/imaging/photo_scale.hpp>

namespace incise {

/// Adds reasons to doubt the scale from a ruler: `photo_scale` if the scale is imprecise, `photo_oblique` if the camera
/// does not look straight down, `photo_lens` if the picture has lens distortion. A figure of RulerShape counts if it
/// exceeds both its limit and 4 times its standard error. docs/models/photograph.md
void add_ruler_doubts(const Ruler& ruler, Verdict& verdict);

/// Adds `photo_ring` if a closed red ring may be open: a stretch of it looks different from the rest, or a gap exceeds
/// the largest allowed gap by less than the uncertainty of its length. @param max_gap_mm  PhotoSettings::max_gap_mm
void add_ring_doubts(const PhotoContours& contours, double max_gap_mm, Verdict& verdict);

}  // namespace incise
