#include <incise/core/error.hpp>
#include <incise/core/workers.hpp>

#include <gtest/gtest.h>

#include <cmath>
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
    try {
      workers.for_chunks(100, 10, [](std::size_t chunk, std::size_t, std::size_t) {
        if (chunk == 3 || chunk == 7) throw Error("chunk " + std::to_string(chunk));
      });
      FAIL() << "expected an exception";
    } catch (const Error& error) {
      EXPECT_STREQ(error.what(), "chunk 3");
    }
  }
  EXPECT_NO_THROW(workers.for_each(100, 10, [](std::size_t) {}));
}

INSTANTIATE_TEST_SUITE_P(Threads, WorkersWith, ::testing::Values(1, 2, 4),
                         [](const auto& with) { return std::to_string(with.param); });

TEST(Workers, TakeEveryHardwareThreadForZeroAndRefuseLess) {
  EXPECT_GE(Workers(0).thread_count(), 1);
  EXPECT_EQ(Workers(3).thread_count(), 3);
  EXPECT_THROW(Workers(-1), InvalidArgument);
  EXPECT_THROW(Workers(1).for_each(5, 0, [](std::size_t) {}), InvalidArgument);
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
