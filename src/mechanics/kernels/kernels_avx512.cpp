#define INCISE_LANES 8
#include "mechanics/kernels/block_kernels.inc"
#include "mechanics/kernels/tet_kernel.inc"

namespace incise {

const KernelTable kAvx512Kernels{sweep_tets, multiply_double, multiply_float, multiply_dense};

}  // namespace incise
