#pragma once

#include <incise/geometry/raster.hpp>
#include <incise/geometry/volume.hpp>

#include <vector>

namespace incise {

// Gaussians sampled at whole steps (pixels, voxels, points) out to 4 sigma.

/// Number of steps from the centre to the last sample: 4 sigma, rounded up. @param sigma  in steps.
[[nodiscard]] int gaussian_reach(double sigma);

/// Returns exp(-k²/2σ²) for k = 0, 1, … gaussian_reach(sigma), not normalised. @param sigma  in steps, > 0.
[[nodiscard]] std::vector<double> gaussian_weights(double sigma);

/// Returns the blurred indicator function of a set: before the blur it is 1 in the set and 0 elsewhere, also beyond the
/// picture. sigma_mm = 0: no blur. @throws InvalidArgument for a negative sigma.
[[nodiscard]] ScalarRaster blurred(const Raster& raster, double sigma_mm);

/// Blurs a volume in place along the three axes of its grid; values beyond the grid count as 0. sigma_voxels <= 0: no
/// blur.
void blur(GrayVolume& volume, double sigma_voxels);

}  // namespace incise
