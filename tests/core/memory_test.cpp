#include <incise/core/memory.hpp>

#include <gtest/gtest.h>

#include <sys/resource.h>

#include <vector>

namespace incise {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

TEST(Memory, ThePeakGrowsByWhatIsHeld) {
  const auto before = peak_memory_bytes();
  ASSERT_TRUE(before.has_value());
  const std::vector<char> held(64 * kMiB, 'x');
  EXPECT_NEAR(static_cast<double>(*peak_memory_bytes() - *before), 64.0 * kMiB, 8.0 * kMiB);
  EXPECT_EQ(held.back(), 'x');
}

TEST(Memory, WhatIsHeldNowIsSomethingAndNoMoreThanThePeak) {
  const auto held = held_memory_bytes();
  ASSERT_TRUE(held.has_value());
  EXPECT_GT(*held, kMiB) << "a process of a few megabytes";
  EXPECT_LE(*held, *peak_memory_bytes());
}

TEST(Memory, WhatIsAvailableIsNoMoreThanTheProcessMayTake) {
  const auto free = available_memory_bytes();
  ASSERT_TRUE(free.has_value());
  rlimit old{};
  ASSERT_EQ(getrlimit(RLIMIT_DATA, &old), 0);
  rlimit tight = old;
  tight.rlim_cur = 512 * kMiB;
  if (old.rlim_cur < tight.rlim_cur || *free < 512 * kMiB) GTEST_SKIP() << "less than 512 MB may be taken here anyway";
  ASSERT_EQ(setrlimit(RLIMIT_DATA, &tight), 0);
  const auto limited = available_memory_bytes();
  ASSERT_EQ(setrlimit(RLIMIT_DATA, &old), 0);
  ASSERT_TRUE(limited.has_value());
  EXPECT_LT(*limited, 512 * kMiB);
  EXPECT_GT(*limited, 256 * kMiB) << "a process of a few megabytes";
}

}  // namespace
}  // namespace incise
