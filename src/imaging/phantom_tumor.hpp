#pragma once

#include <incise/core/random.hpp>
#include <incise/imaging/phantom.hpp>

namespace incise {

/// Draws the tumour onto the back of `phantom.shape`: sets `tumor_edge`, `tumor`, `tumor_center_mm` and
/// `tissue_below_tumor_mm`.
void draw_tumor(const PhantomSettings& settings, Random& random, Phantom& phantom);

}  // namespace incise
