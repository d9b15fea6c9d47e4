#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace incise {

/// A fixed set of threads for loops over arrays. Work is split into chunks whose borders depend only on the count and
/// the chunk size, never on the number of threads: a reduction that adds chunk results in chunk order gives the same
/// bits with 1 and with 16 threads. Waiting threads sleep; they do not spin. Not for nested use.
class Workers {
 public:
  /// @param threads  >= 1, the caller's thread included; 0: every hardware thread.
  /// @throws Error saying how many threads could be started, if the system refuses more; InvalidArgument for a negative
  /// number.
  explicit Workers(int threads = 1);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  [[nodiscard]] int thread_count() const;

  /// Calls body(chunk, begin, end) once for each chunk of at most `chunk_size` consecutive items of [0, count) and
  /// returns when all are done. If a body throws, chunks above it that have not begun are left out, and the exception
  /// of the lowest chunk that failed is rethrown; all chunks below that one are done then.
  /// @throws InvalidArgument for a chunk size of 0, or 2^31 chunks or more.
  void for_chunks(std::size_t count, std::size_t chunk_size,
                  const std::function<void(std::size_t chunk, std::size_t begin, std::size_t end)>& body);

  /// Calls body(i) for every i in [0, count), in chunks of `chunk_size`.
  template <class Body>
  void for_each(std::size_t count, std::size_t chunk_size, const Body& body) {
    for_chunks(count, chunk_size, [&body](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) body(i);
    });
  }

  [[nodiscard]] static std::size_t chunk_count(std::size_t count, std::size_t chunk_size) {
    return (count + chunk_size - 1) / chunk_size;
  }

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace incise
