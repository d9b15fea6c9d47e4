#define INCISE_LANES 8
#define INCISE_TABLE kAvx512Kernels
#include "mechanics/kernels/table.inc"
