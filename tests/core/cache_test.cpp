#include "support/counted_entries.hpp"
#include "support/monitors.hpp"

#include <incise/core/cache.hpp>
#include <incise/core/error.hpp>

#include <gmock/gmock.h>

namespace incise {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

struct Answer {
  double value_mm = 0.0;
};
void describe(Visitor& v, Answer& a) {
  v("value_mm", a.value_mm, "A length.");
}

TEST(Cache, MakesAResultOnce) {
  Cache cache;
  Monitor quiet;
  int made = 0;
  const auto any = [](const Answer&) { return true; };
  const auto make = [&] { return Answer{static_cast<double>(++made)}; };
  const CacheKey key = CacheKey("answer").add(Answer{0.5});
  EXPECT_EQ(cache.get_or_make<Answer>("a", key, quiet, any, make).value_mm, 1.0);
  EXPECT_EQ(cache.get_or_make<Answer>("a", CacheKey("answer").add(Answer{0.5}), quiet, any, make).value_mm, 1.0);
  EXPECT_TRUE(cache.holds("a"));
  EXPECT_FALSE(cache.holds("b"));
  EXPECT_EQ(made, 1);
}

TEST(Cache, MakesItAgainForOtherSettingsAndAnotherStage) {
  Cache cache;
  Monitor quiet;
  cache.keep("a", CacheKey("answer").add(Answer{0.5}), Answer{7.0});
  EXPECT_FALSE(cache.find<Answer>("a", CacheKey("answer").add(Answer{0.25}), quiet));
  EXPECT_FALSE(cache.find<Answer>("a", CacheKey("question").add(Answer{0.5}), quiet));
  EXPECT_TRUE(cache.find<Answer>("a", CacheKey("answer").add(Answer{0.5}), quiet));
}

TEST(CacheKey, TellsPartsApart) {
  EXPECT_NE(CacheKey("s").add_text("ab").add_text("c").digest(), CacheKey("s").add_text("a").add_text("bc").digest());
}

TEST(Cache, ReportsAValueThatDoesNotFitAndMakesItAgain) {
  Cache cache;
  testing::RecordingMonitor told;
  const CacheKey key = CacheKey("answer").add_text("x");
  cache.keep("a", key, Answer{-7.0});
  const auto is_length = [](const Answer& kept) { return kept.value_mm >= 0.0; };
  EXPECT_EQ(cache.get_or_make<Answer>("a", key, told, is_length, [] { return Answer{7.0}; }).value_mm, 7.0);
  EXPECT_THAT(told.messages, Contains(HasSubstr("values that do not fit each other")));
  EXPECT_EQ(cache.find<Answer>("a", key, told, is_length)->value_mm, 7.0);
}

TEST(Cache, ReportsADamagedEntryAndMakesItAgain) {
  testing::Entries entries;
  Cache cache(std::make_unique<testing::CountedEntries>(entries));
  testing::RecordingMonitor told;
  const CacheKey key = CacheKey("answer").add_text("x");
  cache.keep("a", key, Answer{7.0});
  const std::string sound = entries.bytes.at("a");
  for (std::size_t i = 0; i < sound.size(); ++i) {
    entries.bytes["a"] = sound;
    entries.bytes["a"][i] = static_cast<char>(entries.bytes["a"][i] ^ 1);
    const auto found = cache.find<Answer>("a", key, told);
    EXPECT_FALSE(found) << i;
  }
  EXPECT_THAT(told.messages, Contains(HasSubstr("It is computed again")));
  for (std::size_t size = 0; size < sound.size(); ++size) {
    entries.bytes["a"] = sound.substr(0, size);
    EXPECT_FALSE(cache.find<Answer>("a", key, told)) << size;
  }
}

}  // namespace
}  // namespace incise
