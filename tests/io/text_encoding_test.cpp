#include <incise/io/text_encoding.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

TEST(Escaped, LeavesNothingThatEndsAnAttributeOrOpensATag) {
  EXPECT_EQ(escaped("a < b & \"c\" > 'd'"), "a &lt; b &amp; &quot;c&quot; &gt; &#39;d&#39;");
}

TEST(Base64, FollowsTheExamplesOfItsStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace incise
