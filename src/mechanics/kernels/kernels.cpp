#include "mechanics/kernels/kernels.hpp"

#include <incise/core/isa.hpp>

namespace incise {

const KernelTable& kernels() {
#if defined(INCISE_X86_KERNELS)
  switch (active_isa()) {
    case Isa::Avx512: return kAvx512Kernels;
    case Isa::Avx2: return kAvx2Kernels;
    case Isa::Portable: break;
  }
#endif
  return kPortableKernels;
}

}  // namespace incise
