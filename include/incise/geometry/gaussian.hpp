#pragma once

#include <incise/geometry/raster.hpp>
#include <incise/geometry/volume.hpp>

#include <vector>

namespace incise {

// Gaussians sampled at whole steps (pixels, voxels, points) out to 4 sigma.

/// How many steps away the last sample lies.
[[nodiscard]] int gaussian_reach(double sigma);

/// exp(-k²/2σ²) at the steps k = 0, 1, … gaussian_reach(sigma). @param sigma  in steps, > 0.
[[nodiscard]] std::vector<double> gaussian_weights(double sigma);

/// Blur of a set as a function that is 1 in it and 0 outside, also beyond the picture. sigma = 0: unchanged.
[[nodiscard]] ScalarRaster blurred(const Raster& raster, double sigma_mm);

/// Blurs along the three axes of the grid; outside it is 0. sigma = 0: unchanged.
void blur(GrayVolume& volume, double sigma_voxels);

}  // namespace incise
