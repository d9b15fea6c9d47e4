#include <incise/core/expect.hpp>

#include <gmock/gmock.h>

#include <limits>

namespace incise {
namespace {

TEST(Expect, NotesWhatIsNotValidNotFiniteOrOutOfRange) {
  std::vector<std::string> violations;
  const Expect expect(violations);
  expect(true, "depth_mm", 5.0, "a depth above 0 mm");
  expect.in_range("blur_mm", 2.0, 0.0, 2.0);
  EXPECT_THAT(violations, ::testing::IsEmpty());
  expect(false, "depth_mm", -1.0, "a depth above 0 mm");
  expect(true, "speed_mm_s", std::numeric_limits<double>::infinity(), "a speed above 0 mm/s");
  expect.in_range("blur_mm", std::numeric_limits<double>::quiet_NaN(), 0.0, 2.5);
  EXPECT_THAT(violations, ::testing::ElementsAre("depth_mm: found -1, expected a depth above 0 mm",
                                                 "speed_mm_s: found inf, expected a speed above 0 mm/s",
                                                 "blur_mm: found nan, expected a number in [0, 2.5]"));
}

}  // namespace
}  // namespace incise
