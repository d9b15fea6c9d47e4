#pragma once

#include <cstddef>

namespace incise {

/// Shares that one thread takes at a time: enough work to pay for the hand-over. Sums over a chunk are added in order: the same bits at any number of threads.
inline constexpr std::size_t kRowsPerChunk = 512;
inline constexpr std::size_t kVerticesPerChunk = 128;

}  // namespace incise
