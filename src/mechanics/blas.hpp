#pragma once

#include <omp.h>

// The few routines of OpenBLAS/LAPACK that are called directly. CHOLMOD uses the same library.
extern "C" {
void openblas_set_num_threads(int count);
void dpotrf_(const char* triangle, const int* n, double* a, const int* lda, int* info);
void dpotri_(const char* triangle, const int* n, double* a, const int* lda, int* info);
}

namespace incise {

/// Limits BLAS and CHOLMOD to one thread. With more, the bits of a result would depend on their number, and waiting
/// threads spin, which costs minutes on a busy machine. CHOLMOD requests four OpenMP threads explicitly; only zero
/// active levels of parallelism prevent them.
inline void hold_blas_to_one_thread() {
  openblas_set_num_threads(1);
  omp_set_max_active_levels(0);
}

}  // namespace incise
