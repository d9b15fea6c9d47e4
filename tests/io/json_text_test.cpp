#include "io/io_test_support.hpp"

#include <incise/io/json_file.hpp>

#include <nlohmann/json.hpp>

#include <limits>

namespace incise {
namespace {

using incise::testing::refusal_of;
using incise::testing::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(JsonText, KeepsTheOrderOfKeysAndReadsBackTheSameDoubles) {
  const nlohmann::ordered_json value{{"z", 0.1}, {"a", {1e-300, -0.0, 1.0 / 3.0}}};
  const TemporaryFolder folder;
  write_json(folder / "a.json", value);
  const auto back = read_json(folder / "a.json");
  EXPECT_EQ(back, value);
  EXPECT_EQ(back.begin().key(), "z");
}

TEST(JsonText, RefusesANumberThatIsNotFiniteAndSaysWhereItIs) {
  const nlohmann::ordered_json value{{"a", {1.0, {{"b", std::numeric_limits<double>::quiet_NaN()}}}}};
  EXPECT_THAT([&] { static_cast<void>(json_text(value)); }, ThrowsMessage<InvalidArgument>(HasSubstr("/a/1/b")));
}

TEST(ParseJson, NamesLineAndColumn) {
  EXPECT_THAT(refusal_of<DataError>([] { return parse_json("{\n  \"a\": 1,\n  \"b\": nan\n}", "x.json"); }),
              HasSubstr("x.json: line 3, column"));
  EXPECT_THAT(refusal_of<DataError>([] { return parse_json("{\"a\": [1, 2", "x.json"); }),
              HasSubstr("found the end of the text"));
  EXPECT_THAT(refusal_of<DataError>([] { return parse_json("", "x.json"); }), HasSubstr("expected JSON"));
}

TEST(ParseJson, RefusesAKeyGivenTwice) {
  EXPECT_THAT(refusal_of<DataError>([] { return parse_json(R"({"a": {"b": 1, "b": 2}})", "x.json"); }),
              HasSubstr("the key 'b' twice"));
  EXPECT_NO_THROW(static_cast<void>(parse_json(R"([{"a": {"b": 1}}, {"a": {"b": 2}}])", "x.json")));
}

TEST(ParseJson, RefusesANumberThatNoDoubleHolds) {
  EXPECT_THAT(refusal_of<DataError>([] { return parse_json("[1e999]", "x.json"); }), HasSubstr("x.json"));
}

}  // namespace
}  // namespace incise
