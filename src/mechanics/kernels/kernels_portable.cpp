#define INCISE_LANES 2
#include "mechanics/kernels/block_kernels.inc"
#include "mechanics/kernels/tet_kernel.inc"

namespace incise {

const KernelTable kPortableKernels{sweep_tets, multiply_double, multiply_float, multiply_dense};

}  // namespace incise
