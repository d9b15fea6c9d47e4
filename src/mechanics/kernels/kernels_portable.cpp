#define INCISE_LANES 2
#define INCISE_TABLE kPortableKernels
#include "mechanics/kernels/table.inc"
