#define INCISE_LANES 4
#include "mechanics/kernels/block_kernels.inc"
#include "mechanics/kernels/pcg_kernels.inc"
#include "mechanics/kernels/tet_kernel.inc"

namespace incise {

const KernelTable kAvx2Kernels{sweep_tets, multiply_double, multiply_dense,      multiply_whole,    round_block,
                               move_four,  turn_four,       multiply_dense_rows, sum_blocks_double, sum_blocks_single};

}  // namespace incise
