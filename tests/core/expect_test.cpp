#include <incise/core/expect.hpp>

#include <gmock/gmock.h>

#include <limits>

namespace incise {
namespace {

TEST(Expect, NotesWhatIsNotValidNotFiniteOrOutOfRange) {
  std::vector<Problem> violations;
  const Expect expect(violations);
  expect(true, "depth_mm", 5.0, "a depth above 0 mm");
  EXPECT_THAT(violations, ::testing::IsEmpty());
  expect(false, "depth_mm", -1.0, "a depth above 0 mm");
  expect(true, "speed_mm_s", std::numeric_limits<double>::infinity(), "a speed above 0 mm/s");
  EXPECT_THAT(sentences(violations), ::testing::ElementsAre("depth_mm: found -1, expected a depth above 0 mm",
                                                            "speed_mm_s: found inf, expected a speed above 0 mm/s"));
}

struct Layer {
  double share = 0.5;
  Eigen::Vector3d way = Eigen::Vector3d::UnitX();
};
void describe(Visitor& v, Layer& i) {
  v("share", i.share, "Of one.", {0.0, 1.0});
  v.direction("way", i.way, "Where to.");
}
struct Stack {
  Layer first;
  std::vector<Layer> others;
  std::vector<double> depths_mm;
  std::optional<double> limit;
  int count = 1;
};
void describe(Visitor& v, Stack& o) {
  v("first", o.first, "One.");
  v("others", o.others, "More.");
  v("depths_mm", o.depths_mm, "Each above 0.", kPositive);
  v("limit", o.limit, "Absent: none.", kPositive);
  v("count", o.count, "At least one.", {1.0});
}

TEST(ProblemsOf, NamesEachNumberThatTheDescriptionDoesNotAllow) {
  EXPECT_THAT(problems_of(Stack{}), ::testing::IsEmpty());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Stack bad{.first = {nan, Eigen::Vector3d::Zero()},
                  .others = {{}, {1.5, Eigen::Vector3d(0.0, nan, 0.0)}},
                  .depths_mm = {1.0, 0.0, -1.0},
                  .limit = -2.0,
                  .count = 0};
  EXPECT_THAT(sentences(problems_of(bad)),
              ::testing::ElementsAre(
                  "first.share: found nan, expected a number in [0, 1]",
                  "first.way: found 0 0 0, expected a direction, of a length in [1e-6, 1e6]",
                  "others[1].share: found 1.5, expected a number in [0, 1]",
                  "others[1].way[1]: found nan, expected a number", "depths_mm[1]: found 0, expected a number above 0",
                  "limit: found -2, expected a number above 0", "count: found 0, expected a number of 1 or more"));
}

}  // namespace
}  // namespace incise
