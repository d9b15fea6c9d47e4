#include <incise/core/error.hpp>
#include <incise/core/isa.hpp>

#include <fmt/format.h>

#include <atomic>

namespace incise {
namespace {

std::atomic<Isa>& chosen() {
  static std::atomic<Isa> isa{best_isa()};
  return isa;
}

}  // namespace

bool is_supported(Isa isa) {
#if defined(__x86_64__)
  const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (isa == Isa::Avx2) return has_avx2;
  if (isa == Isa::Avx512) {
    return has_avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
  }
#endif
  return isa == Isa::Portable;
}

Isa best_isa() {
  Isa best = Isa::Portable;
  for (const Isa isa : values_of<Isa>()) {
    if (is_supported(isa)) best = isa;
  }
  return best;
}

Isa active_isa() {
  return chosen().load();
}

void set_isa(Isa isa) {
  INCISE_REQUIRE(is_supported(isa), fmt::format("expected an instruction set of this machine, up to {}, found {}",
                                                to_string(best_isa()), to_string(isa)));
  chosen() = isa;
}

}  // namespace incise
