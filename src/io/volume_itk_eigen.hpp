#pragma once

// ITK carries an Eigen of its own whose include guards are the same as ours, so the two cannot meet in one source.
// Include this before any header of ITK: it takes the place of <itk_eigen.h> and points ITK at our Eigen.
#define itk_eigen_h
#define ITK_EIGEN(x) <Eigen/x>
