#pragma once

#include <omp.h>

// The few routines of OpenBLAS/LAPACK that are called directly. CHOLMOD finds the same library.
extern "C" {
void openblas_set_num_threads(int count);
void dpotrf_(const char* triangle, const int* n, double* a, const int* lda, int* info);
void dpotri_(const char* triangle, const int* n, double* a, const int* lda, int* info);
}

namespace incise {

/// One thread in BLAS and in CHOLMOD: their threads would make bits depend on their number, and they spin while they
/// wait, which on a busy machine costs minutes. CHOLMOD asks OpenMP for four threads by number; only a depth of zero
/// keeps it from getting them.
inline void hold_blas_to_one_thread() {
  openblas_set_num_threads(1);
  omp_set_max_active_levels(0);
}

}  // namespace incise
