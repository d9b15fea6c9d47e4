#define INCISE_LANES 8
#include "registration/kernels/gauss_sums.inc"

namespace incise {

const GaussSums kAvx512GaussSums = sum_gaussians;

}  // namespace incise
