#include <incise/core/error.hpp>
#include <incise/core/isa.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

TEST(Isa, NamesAreReadBack) {
  for (const Isa isa : values_of<Isa>()) EXPECT_EQ(value_of<Isa>(to_string(isa)), isa);
  EXPECT_EQ(value_of<Isa>("sse9"), std::nullopt);
}

TEST(Isa, TheBestOneRunsHereAndIsTheDefault) {
  EXPECT_TRUE(is_supported(Isa::Portable));
  EXPECT_TRUE(is_supported(best_isa()));
  EXPECT_EQ(active_isa(), best_isa());
}

TEST(Isa, AWiderOneIncludesTheNarrower) {
  EXPECT_TRUE(!is_supported(Isa::Avx512) || is_supported(Isa::Avx2));
}

TEST(Isa, IsChosenForTheWholeProcess) {
  set_isa(Isa::Portable);
  EXPECT_EQ(active_isa(), Isa::Portable);
  set_isa(best_isa());
  EXPECT_EQ(active_isa(), best_isa());
}

TEST(Isa, RefusesOneThatThisMachineLacks) {
  for (const Isa isa : {Isa::Avx2, Isa::Avx512}) {
    if (is_supported(isa)) continue;
    EXPECT_THROW(set_isa(isa), InvalidArgument);
  }
}

}  // namespace
}  // namespace incise
