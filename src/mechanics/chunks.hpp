#pragma once

#include <cstddef>

namespace incise {

/// Rows, vertices or tets that one thread takes at a time: enough work to outweigh the cost of scheduling. Partial sums
/// are added in the order of the chunks, which gives the same bits at any number of threads.
inline constexpr std::size_t kRowsPerChunk = 512;
inline constexpr std::size_t kVerticesPerChunk = 128;
inline constexpr std::size_t kTetsPerChunk = 256;

}  // namespace incise
