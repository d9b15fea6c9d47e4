#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/core/workers.hpp>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

namespace incise {
namespace {

/// A sum whose bits depend on the order of addition, reduced in chunk order.
double chunked_sum(Workers& workers, std::size_t count) {
  constexpr std::size_t kChunk = 64;
  std::vector<double> partial(Workers::chunk_count(count, kChunk), 0.0);
  workers.for_chunks(count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      partial[chunk] += std::sin(static_cast<double>(i)) * 1e3 / (1.0 + static_cast<double>(i));
  });
  double sum = 0.0;
  for (const double x : partial) sum += x;
  return sum;
}

class WorkersWith : public ::testing::TestWithParam<int> {};

TEST_P(WorkersWith, ReduceToTheSameBitsAsOneThread) {
  Workers one(1);
  Workers workers(GetParam());
  for (const std::size_t count : {0U, 1U, 63U, 64U, 65U, 10007U}) {
    EXPECT_EQ(chunked_sum(workers, count), chunked_sum(one, count)) << count << " items";
  }
}

TEST_P(WorkersWith, VisitEveryItemOnce) {
  Workers workers(GetParam());
  std::vector<int> visits(1001, 0);
  for (int loop = 0; loop < 50; ++loop) {
    workers.for_each(visits.size(), 10, [&](std::size_t i) { ++visits[i]; });
  }
  for (const int n : visits) ASSERT_EQ(n, 50);
}

TEST_P(WorkersWith, RethrowTheExceptionOfTheLowestChunkAndStayUsable) {
  Workers workers(GetParam());
  for (int loop = 0; loop < 20; ++loop) {
    const auto work = [](std::size_t chunk, std::size_t, std::size_t) {
      if (chunk == 3 || chunk == 7) throw Error("chunk " + std::to_string(chunk));
    };
    EXPECT_EQ(testing::refusal_of<Error>([&] { workers.for_chunks(100, 10, work); }), "chunk 3");
  }
  EXPECT_NO_THROW(workers.for_each(100, 10, [](std::size_t) {}));
}

TEST_P(WorkersWith, VisitEveryItemOnceInLoopsOfAnySizeThatFollowEachOther) {
  // Short loops of changing bounds, so that threads wake late: into the next loop, or after the last.
  Workers workers(GetParam());
  Random random(static_cast<std::uint64_t>(GetParam()));
  std::vector<int> visits;
  for (int loop = 0; loop < 3000; ++loop) {
    const auto count = static_cast<std::size_t>(random.uniform(0.0, 200.0));
    const auto chunk_size = static_cast<std::size_t>(random.uniform(1.0, 20.0));
    const std::size_t chunks = Workers::chunk_count(count, chunk_size);
    const bool must_throw = chunks > 1 && random.uniform(0.0, 1.0) < 0.2;
    const auto bad = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(chunks)));
    visits.assign(count, 0);
    const auto run = [&] {
      workers.for_chunks(count, chunk_size, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) ++visits[i];
        if (must_throw && chunk == bad) throw Error("asked for");
      });
    };
    if (must_throw) {
      ASSERT_THROW(run(), Error) << "loop " << loop;
    } else {
      ASSERT_NO_THROW(run()) << "loop " << loop;
    }
    const std::size_t sure =
        must_throw ? std::min(count, (bad + 1) * chunk_size) : count;  // beyond it, some are left out
    for (std::size_t i = 0; i < sure; ++i) ASSERT_EQ(visits[i], 1) << "item " << i << " of loop " << loop;
    for (std::size_t i = sure; i < count; ++i) ASSERT_LE(visits[i], 1) << "item " << i << " of loop " << loop;
  }
}

TEST_P(WorkersWith, StopAfterAFailure) {
  Workers workers(GetParam());
  constexpr std::size_t kLoops = 50;
  constexpr std::size_t kChunks = 10000;
  std::atomic<std::size_t> calls = 0;
  for (std::size_t loop = 0; loop < kLoops; ++loop) {
    const auto body = [&](std::size_t i) {
      ++calls;
      if (i == 0) throw Error("asked for");
    };
    ASSERT_THROW(workers.for_each(kChunks, 1, body), Error);
  }
  EXPECT_LT(calls, kLoops * kChunks);
}

INSTANTIATE_TEST_SUITE_P(Threads, WorkersWith, ::testing::Values(1, 2, 4, 6),
                         [](const auto& with) { return std::to_string(with.param); });

TEST(Workers, TakeEveryHardwareThreadForZeroAndRefuseLess) {
  EXPECT_GE(Workers(0).thread_count(), 1);
  EXPECT_EQ(Workers(3).thread_count(), 3);
  EXPECT_THROW(Workers(-1), InvalidArgument);
  EXPECT_THROW(Workers(1).for_each(5, 0, [](std::size_t) {}), InvalidArgument);
}

/// In a process of its own: what happens where memory ends before 1024 threads have their stacks.
[[noreturn]] void start_too_many_threads() {
  const rlimit limit{rlim_t{512} << 20U, rlim_t{512} << 20U};
  if (setrlimit(RLIMIT_AS, &limit) != 0) std::_Exit(2);
  try {
    const Workers workers(1024);
  } catch (const Error& error) {
    const std::string text = error.what();
    const bool is_told = text.find("1024 threads") != std::string::npos && text.find("could be started") != std::string::npos;
    std::_Exit(is_told && Workers(2).thread_count() == 2 ? 0 : 3);
  }
  std::_Exit(4);
}

TEST(WorkersDeathTest, SayHowManyThreadsCouldBeStarted) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizer needs more memory than the test leaves";
#endif
  EXPECT_EXIT(start_too_many_threads(), ::testing::ExitedWithCode(0), "");
}

TEST(Workers, CutTheLastChunkShort) {
  EXPECT_EQ(Workers::chunk_count(10, 4), 3U);
  Workers workers(1);
  std::vector<std::pair<std::size_t, std::size_t>> ranges;
  workers.for_chunks(10, 4, [&](std::size_t, std::size_t begin, std::size_t end) { ranges.emplace_back(begin, end); });
  EXPECT_EQ(ranges, (std::vector<std::pair<std::size_t, std::size_t>>{{0, 4}, {4, 8}, {8, 10}}));
}

}  // namespace
}  // namespace incise
