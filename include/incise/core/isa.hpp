#pragma once

#include <incise/core/names.hpp>

namespace incise {

/// The instruction set that the vectorised kernels use. Each gives the same bits at any thread count; between two of
/// them results differ by rounding, so a record of a run names the one it used.
enum class Isa {
  Portable,  ///< what any machine of the build's architecture has
  Avx2,      ///< x86-64: AVX2 and FMA, four doubles at once
  Avx512,    ///< x86-64: AVX-512 F, DQ, VL and BW, eight doubles at once
};
/// Used on the command line and in files.
inline constexpr std::array<std::string_view, 3> kIsaNames{"portable", "avx2", "avx512"};
[[nodiscard]] constexpr Names names_of(Isa) {
  return kIsaNames;
}

/// Whether this machine and this build can run it.
[[nodiscard]] bool is_supported(Isa isa);
/// The widest one that can run here.
[[nodiscard]] Isa best_isa();

/// The one that the whole process uses: best_isa() unless set_isa() chose another. The one process-wide choice of the
/// library: kernels are reached from every module, and a run that mixed two would have bits that nobody can name.
[[nodiscard]] Isa active_isa();
/// Chooses it. To be called before any work starts. Throws InvalidArgument when it cannot run here.
void set_isa(Isa isa);

}  // namespace incise
