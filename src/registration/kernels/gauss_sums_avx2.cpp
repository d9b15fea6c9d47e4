#define INCISE_LANES 4
#include "registration/kernels/gauss_sums.inc"

namespace incise {

const GaussSums kAvx2GaussSums = sum_gaussians;

}  // namespace incise
