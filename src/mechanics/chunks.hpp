#pragma once

#include <cstddef>

namespace incise {

/// How many rows or vertices one thread takes at a time: enough work to pay for the hand-over. Partial sums are added
/// in the order of the chunks, which gives the same bits at any number of threads.
inline constexpr std::size_t kRowsPerChunk = 512;
inline constexpr std::size_t kVerticesPerChunk = 128;

}  // namespace incise
