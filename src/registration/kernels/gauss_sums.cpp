#include "registration/kernels/gauss_sums.hpp"

#include <incise/core/isa.hpp>

namespace incise {

GaussSums gauss_sums() {
#if defined(INCISE_X86_KERNELS)
  switch (active_isa()) {
    case Isa::Avx512:
      return kAvx512GaussSums;
    case Isa::Avx2:
      return kAvx2GaussSums;
    case Isa::Portable:
      break;
  }
#endif
  return kPortableGaussSums;
}

}  // namespace incise
