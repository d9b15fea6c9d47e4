#include <incise/core/outcome.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

TEST(Outcome, HasTheNamesThatFilesUse) {
  EXPECT_EQ(to_string(Outcome::Success), "success");
  EXPECT_EQ(to_string(Outcome::PositiveMargin), "positive_margin");
  EXPECT_EQ(to_string(Outcome::OpenLoop), "open_loop");
  EXPECT_EQ(to_string(Outcome::NotConverged), "not_converged");
  EXPECT_EQ(to_string(Outcome::ElementInverted), "element_inverted");
  EXPECT_EQ(to_string(Outcome::Cancelled), "cancelled");
}

TEST(Outcome, IsReadBackFromItsNameAndFromNoOther) {
  for (const Outcome outcome : values_of<Outcome>()) EXPECT_EQ(value_of<Outcome>(to_string(outcome)), outcome);
  EXPECT_EQ(value_of<Outcome>("Success"), std::nullopt);
  EXPECT_EQ(value_of<Outcome>(""), std::nullopt);
}

}  // namespace
}  // namespace incise
