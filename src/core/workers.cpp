#include <incise/core/error.hpp>
#include <incise/core/workers.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace incise {

struct Workers::Shared {
  std::vector<std::thread> threads;
  std::mutex mutex;
  std::condition_variable work_ready;
  std::condition_variable work_done;
  bool stopping = false;
  std::size_t generation = 0;  // counts loops, so that a sleeping thread can tell a new one from the last
  std::size_t busy = 0;        // threads that have not finished the current loop

  const std::function<void(std::size_t, std::size_t, std::size_t)>* body = nullptr;
  std::size_t count = 0;
  std::size_t chunk_size = 1;
  std::size_t chunks = 0;
  std::atomic<std::size_t> next_chunk = 0;

  std::exception_ptr failure;
  std::size_t failed_chunk = 0;

  void run_chunks() {
    while (true) {
      const std::size_t chunk = next_chunk.fetch_add(1);
      if (chunk >= chunks) return;
      const std::size_t begin = chunk * chunk_size;
      try {
        (*body)(chunk, begin, std::min(count, begin + chunk_size));
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure || chunk < failed_chunk) {
          failure = std::current_exception();
          failed_chunk = chunk;
        }
      }
    }
  }

  void wait_for_work() {
    std::size_t seen = 0;
    std::unique_lock lock(mutex);
    while (true) {
      work_ready.wait(lock, [&] { return stopping || generation != seen; });
      if (stopping) return;
      seen = generation;
      lock.unlock();
      run_chunks();
      lock.lock();
      if (--busy == 0) work_done.notify_one();
    }
  }
};

Workers::Workers(int threads) : shared_(std::make_unique<Shared>()) {
  INCISE_REQUIRE(threads >= 0, fmt::format("expected 0 (all) or more threads, found {}", threads));
  const int wanted = threads > 0 ? threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  for (int i = 1; i < wanted; ++i) {
    shared_->threads.emplace_back([shared = shared_.get()] { shared->wait_for_work(); });
  }
}

Workers::~Workers() {
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->stopping = true;
  }
  shared_->work_ready.notify_all();
  for (std::thread& thread : shared_->threads) thread.join();
}

int Workers::thread_count() const { return static_cast<int>(shared_->threads.size()) + 1; }

void Workers::for_chunks(std::size_t count, std::size_t chunk_size,
                         const std::function<void(std::size_t, std::size_t, std::size_t)>& body) {
  INCISE_REQUIRE(chunk_size > 0, "expected a chunk size above 0, found 0");
  if (count == 0) return;
  Shared& shared = *shared_;
  const std::size_t chunks = chunk_count(count, chunk_size);
  if (shared.threads.empty() || chunks == 1) {
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
      body(chunk, chunk * chunk_size, std::min(count, (chunk + 1) * chunk_size));
    }
    return;
  }
  {
    const std::lock_guard lock(shared.mutex);
    shared.body = &body;
    shared.count = count;
    shared.chunk_size = chunk_size;
    shared.chunks = chunks;
    shared.next_chunk = 0;
    shared.failure = nullptr;
    shared.busy = shared.threads.size();
    ++shared.generation;
  }
  shared.work_ready.notify_all();
  shared.run_chunks();
  std::unique_lock lock(shared.mutex);
  shared.work_done.wait(lock, [&] { return shared.busy == 0; });
  if (shared.failure) std::rethrow_exception(shared.failure);
}

}  // namespace incise
