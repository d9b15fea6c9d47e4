#pragma once

// ITK brings its own Eigen, whose include guards are the same as ours, so one source file cannot include both.
// Include this before any ITK header: it replaces <itk_eigen.h> and makes ITK use our Eigen.
#define itk_eigen_h
#define ITK_EIGEN(x) <Eigen/x>
