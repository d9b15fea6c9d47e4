#define INCISE_LANES 4
#define INCISE_TABLE kAvx2Kernels
#include "mechanics/kernels/table.inc"
