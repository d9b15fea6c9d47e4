#pragma once

#include <incise/core/names.hpp>

namespace incise {

/// The instruction set that the vectorised kernels use. Each gives the same bits at any thread count. Results of two
/// instruction sets differ by rounding, so the record of a run names the one it used.
enum class Isa {
  Portable,  ///< available on every machine of the build's architecture
  Avx2,      ///< x86-64: AVX2 and FMA, four doubles at once
  Avx512,    ///< x86-64: AVX-512 F, DQ, VL and BW, eight doubles at once
};
/// Names on the command line and in files.
inline constexpr std::array<std::string_view, 3> kIsaNames{"portable", "avx2", "avx512"};
[[nodiscard]] constexpr Names names_of(Isa) {
  return kIsaNames;
}

/// Whether this machine and this build can run the instruction set.
[[nodiscard]] bool is_supported(Isa isa);
/// Returns the widest instruction set that can run here.
[[nodiscard]] Isa best_isa();

/// Returns the instruction set that the whole process uses: best_isa() unless set_isa() chose another. It is the
/// library's only process-wide choice: every module calls kernels, and results of a run that mixed two sets could not
/// be reproduced.
[[nodiscard]] Isa active_isa();
/// Sets the instruction set of the process. Call it before any work starts. @throws InvalidArgument if it cannot run
/// here.
void set_isa(Isa isa);

}  // namespace incise
