#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace incise {

/// Returns zeros in large memory pages, if the system has them. A product that streams through the whole matrix then
/// seldom waits for address translation, which on a virtual machine takes a third of its time.
template <class Number>
std::vector<Number> zeros_in_large_pages(std::size_t count) {
  std::vector<Number> values;
  values.reserve(count);
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  constexpr std::size_t kPage = 4096;
  constexpr std::size_t kWorthwhile = std::size_t{4} << 20U;
  if (count * sizeof(Number) >= kWorthwhile) {
    const std::size_t begin = (reinterpret_cast<std::uintptr_t>(values.data()) + kPage - 1) / kPage * kPage;
    const std::size_t end = (reinterpret_cast<std::uintptr_t>(values.data()) + count * sizeof(Number)) / kPage * kPage;
    // Only a hint: if it is refused, the pages are small and nothing else differs.
    static_cast<void>(madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE));
  }
#endif
  values.resize(count);
  return values;
}

}  // namespace incise
