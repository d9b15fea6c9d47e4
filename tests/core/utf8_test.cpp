#include <incise/core/utf8.hpp>

#include <gtest/gtest.h>

#include <string>

namespace incise {
namespace {

TEST(FirstNotUtf8, PassesCharactersOfEveryLength) {
  for (const char* text : {"", "a", "é", "€", "\xF0\x9F\x94\xAA", "\xED\x9F\xBF", "\xEE\x80\x80", "\xF4\x8F\xBF\xBF"}) EXPECT_FALSE(first_not_utf8(text)) << text;
}

TEST(FirstNotUtf8, FindsTheFirstByteThatIsNone) {
  // A lead or tail alone, cut short, overlong (2, 3 and 4 bytes), a surrogate, beyond U+10FFFF.
  for (const char* bad : {"\xE9", "\x80", "\xC3", "\xE2\x82", "\xC0\xAF", "\xE0\x80\xAF", "\xF0\x80\x80\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xFF", "\xC3("}) {
    EXPECT_EQ(first_not_utf8(std::string("ab€") + bad), 5u);
  }
}

TEST(Utf8Prefix, CutsNoCharacterInTwo) {
  EXPECT_EQ(utf8_prefix("ab€d", 100), "ab€d");
  EXPECT_EQ(utf8_prefix("ab€d", 5), "ab€");
  for (const std::size_t bytes : {2u, 3u, 4u}) EXPECT_EQ(utf8_prefix("ab€d", bytes), "ab") << bytes;
  EXPECT_EQ(utf8_prefix("€", 1), "");
}

}  // namespace
}  // namespace incise
