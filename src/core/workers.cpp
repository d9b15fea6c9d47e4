#include <incise/core/error.hpp>
#include <incise/core/workers.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace incise {

/// Each thread has its own range of neighbouring chunks, the same in every loop of equal size, so its data are still in
/// its cache. When its range is done, it helps with the other ranges. The caller waits for chunks, not for threads: a
/// thread that wakes late finds nothing to do.
struct Workers::Shared {
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  /// The next chunk of a range and the loop that it belongs to: (loop << 32) + chunk. Has a cache line to itself.
  struct alignas(64) Ticket {
    std::atomic<std::uint64_t> value = 0;
  };

  explicit Shared(std::size_t thread_count) : tickets(thread_count) { threads.reserve(thread_count); }
  Shared(const Shared&) = delete;
  Shared& operator=(const Shared&) = delete;
  ~Shared() { stop(); }

  /// Ends and joins every thread that was started.
  void stop() {
    stopping = true;
    ++loop;
    loop.notify_all();
    for (std::thread& thread : threads) thread.join();
    threads.clear();
  }

  std::vector<std::thread> threads;
  std::vector<Ticket> tickets;  // one per thread, the caller's first
  std::atomic<std::uint32_t> loop = 0;
  std::atomic<std::uint32_t> chunks_left = 0;
  std::atomic<bool> stopping = false;

  // The current loop. Only a thread that holds one of its chunks reads `body`, `count` and `chunk_size`: the loop
  // cannot end meanwhile.
  const std::function<void(std::size_t, std::size_t, std::size_t)>* body = nullptr;
  std::size_t count = 0;
  std::size_t chunk_size = 1;
  std::atomic<std::size_t> chunks = 0;

  std::mutex mutex;  // guards `failure` and what is written to `failed_chunk`
  std::exception_ptr failure;
  std::atomic<std::size_t> failed_chunk = kNone;  // the lowest; chunks above it are no longer run

  [[nodiscard]] std::size_t range_start(std::size_t range) const { return range * chunks.load() / tickets.size(); }

  /// Takes the next chunk of a range in the given loop. @returns whether there was one.
  bool take(std::uint32_t of_loop, std::size_t range, std::size_t& chunk) {
    std::atomic<std::uint64_t>& ticket = tickets[range].value;
    std::uint64_t current = ticket.load();
    while (true) {
      chunk = static_cast<std::size_t>(current & 0xFFFFFFFFU);
      if (static_cast<std::uint32_t>(current >> 32) != of_loop || chunk >= range_start(range + 1)) return false;
      if (ticket.compare_exchange_weak(current, current + 1)) return true;
    }
  }

  void run(std::size_t chunk) {
    const std::size_t begin = chunk * chunk_size;
    try {
      if (chunk < failed_chunk.load()) (*body)(chunk, begin, std::min(count, begin + chunk_size));
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (chunk < failed_chunk.load()) {
        failure = std::current_exception();
        failed_chunk = chunk;
      }
    }
    if (chunks_left.fetch_sub(1) == 1) chunks_left.notify_one();
  }

  void run_chunks(std::uint32_t of_loop, std::size_t thread) {
    std::size_t chunk = 0;
    for (std::size_t i = 0; i < tickets.size(); ++i) {
      while (take(of_loop, (thread + i) % tickets.size(), chunk)) run(chunk);
    }
  }

  void wait_for_work(std::size_t thread) {
    std::uint32_t seen = 0;
    while (true) {
      loop.wait(seen);
      if (stopping) return;
      seen = loop.load();
      run_chunks(seen, thread);
    }
  }
};

Workers::Workers(int threads) {
  INCISE_REQUIRE(threads >= 0, fmt::format("expected 0 (all) or more threads, found {}", threads));
  const auto wanted = threads > 0 ? static_cast<std::size_t>(threads) : std::max(1U, std::thread::hardware_concurrency());
  shared_ = std::make_unique<Shared>(wanted);
  try {
    for (std::size_t i = 1; i < wanted; ++i) {
      shared_->threads.emplace_back([shared = shared_.get(), i] { shared->wait_for_work(i); });
    }
  } catch (const std::exception& problem) {
    const std::size_t started = shared_->threads.size() + 1;  // with the caller's
    const std::string reason = problem.what();
    shared_->stop();
    throw Error(fmt::format("expected to start {} threads, found that only {} could be started ({}); use fewer",
                            wanted, started, reason));
  }
}

Workers::~Workers() = default;

int Workers::thread_count() const { return static_cast<int>(shared_->threads.size()) + 1; }

void Workers::for_chunks(std::size_t count, std::size_t chunk_size,
                         const std::function<void(std::size_t, std::size_t, std::size_t)>& body) {
  INCISE_REQUIRE(chunk_size > 0, "expected a chunk size above 0, found 0");
  if (count == 0) return;
  Shared& shared = *shared_;
  const std::size_t chunks = chunk_count(count, chunk_size);
  INCISE_REQUIRE(chunks <= 0x7FFFFFFFU, fmt::format("expected fewer than 2^31 chunks, found {}", chunks));
  if (shared.threads.empty() || chunks == 1) {
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
      body(chunk, chunk * chunk_size, std::min(count, (chunk + 1) * chunk_size));
    }
    return;
  }
  const std::uint32_t loop = shared.loop.load() + 1;
  // First invalidate the tickets of the last loop, so a thread that wakes late cannot take one by the new bounds.
  for (Shared::Ticket& ticket : shared.tickets) ticket.value = (static_cast<std::uint64_t>(loop) << 32) + 0xFFFFFFFFU;
  shared.body = &body;
  shared.count = count;
  shared.chunk_size = chunk_size;
  shared.chunks = chunks;
  shared.chunks_left = static_cast<std::uint32_t>(chunks);
  shared.failure = nullptr;
  shared.failed_chunk = Shared::kNone;
  for (std::size_t range = 0; range < shared.tickets.size(); ++range) {
    shared.tickets[range].value = (static_cast<std::uint64_t>(loop) << 32) + shared.range_start(range);
  }
  shared.loop = loop;
  shared.loop.notify_all();
  shared.run_chunks(loop, 0);
  for (std::uint32_t left = shared.chunks_left.load(); left != 0; left = shared.chunks_left.load()) {
    shared.chunks_left.wait(left);
  }
  if (shared.failure) std::rethrow_exception(shared.failure);
}

}  // namespace incise
