#pragma once

#include <incise/core/isa.hpp>

namespace incise::testing {

/// Keeps to the kernels that every machine has. A coarse mesh carries the rounding in which instruction sets differ to
/// another course of the cut: a test that looks at one course would pass on one machine and fail on another.
class PortableKernels {
 public:
  PortableKernels() { set_isa(Isa::Portable); }
  ~PortableKernels() { set_isa(best_isa()); }
  PortableKernels(const PortableKernels&) = delete;
  PortableKernels& operator=(const PortableKernels&) = delete;
};

}  // namespace incise::testing
