#define INCISE_LANES 2
#include "registration/kernels/gauss_sums.inc"

namespace incise {

const GaussSums kPortableGaussSums = sum_gaussians;

}  // namespace incise
