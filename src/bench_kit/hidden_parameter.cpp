#include <incise/bench_kit/hidden_parameter.hpp>

namespace incise {

std::uint64_t stream_of(std::uint64_t seed, std::string_view name) {
  std::uint64_t hash = 1469598103934665603ULL;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash ^ (seed * 0x9E3779B97F4A7C15ULL);
}

}  // namespace incise
