#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/core/outcome.hpp>
#include <incise/geometry/types.hpp>
#include <incise/io/json_file.hpp>

#include <gmock/gmock.h>

#include <array>
#include <limits>

namespace incise {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using Json = nlohmann::ordered_json;

struct Part {
  double length_mm = 0.0;
  std::optional<int> count;
};
void describe(Visitor& v, Part& p) {
  v({"length_mm", "How long.", "mm"}, p.length_mm, kPositive);
  v("count", p.count, "How many.", {0.0, 9.0});
}

/// One field of every kind.
struct Whole {
  bool is_on = false;
  std::string text;
  Outcome outcome = Outcome::OpenLoop;
  Vec3 place = Vec3::Zero();
  Mat4 transform = Mat4::Identity();
  std::array<double, 3> three{};
  std::vector<double> numbers;
  std::vector<Vec3> points;
  std::vector<std::uint8_t> flags;
  std::vector<std::vector<double>> rows;
  std::vector<Part> parts;
  std::optional<Part> maybe;
  std::optional<Vec3> somewhere;
  std::vector<double> large;
};
void describe(Visitor& v, Whole& w) {
  constant(v, {"schema"}, "test/1");
  v("on", w.is_on);
  v("text", w.text);
  v("outcome", w.outcome);
  v("place", w.place);
  v("transform", w.transform);
  v("three", w.three);
  v("numbers", w.numbers);
  v("points", w.points);
  v("flags", w.flags);
  v("rows", w.rows);
  v("parts", w.parts);
  v("maybe", w.maybe);
  v("somewhere", w.somewhere);
  v.bulk("large", w.large, "In a file of its own.");
  v.derived("sum", w.three[0] + w.three[1] + w.three[2], "Of three.");
}

Whole example() {
  Whole w{.is_on = true, .text = "tongue", .outcome = Outcome::Success, .place = Vec3(1.0, -2.5, 1.0 / 3.0)};
  w.transform(0, 3) = 7.0;
  w.three = {1.0, 2.0, 4.0};
  w.numbers = {0.1, 1e300};
  w.points = {Vec3(1.0, 2.0, 3.0)};
  w.flags = {0, 1, 255};
  w.rows = {{1.0}, {}, {2.0, 3.0}};
  w.parts = {{1.5, 3}, {2.5, std::nullopt}};
  w.somewhere = Vec3(4.0, 5.0, 6.0);
  w.large = {1.0};
  return w;
}

TEST(DescribedJson, HasAKeyForEachFieldAndNoneForBulk) {
  const Json expected = Json::parse(R"({"schema": "test/1", "on": true, "text": "tongue", "outcome": "success",
    "place": [1.0, -2.5, 0.3333333333333333], "transform": [[1.0, 0.0, 0.0, 7.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]],
    "three": [1.0, 2.0, 4.0], "numbers": [0.1, 1e300], "points": [[1.0, 2.0, 3.0]], "flags": [0, 1, 255], "rows": [[1.0], [], [2.0, 3.0]],
    "parts": [{"length_mm": 1.5, "count": 3}, {"length_mm": 2.5, "count": null}], "maybe": null, "somewhere": [4.0, 5.0, 6.0], "sum": 7.0})");
  EXPECT_EQ(to_json(example()), expected);
}

TEST(DescribedJson, GivesTheSameValueAgain) {
  const Json json = parse_json(json_text(to_json(example())), "w.json");
  const auto again = from_json<Whole>(json, "w.json");
  EXPECT_EQ(to_json(again), json);
  EXPECT_TRUE(again.large.empty());
}

TEST(DescribedJson, TakesWhatMayBeAbsentAsAbsentWhereItsKeyIsMissing) {
  Json json = to_json(example());
  json.erase("somewhere");
  json["parts"][0].erase("count");
  json["of another version"] = 1;
  const auto read = from_json<Whole>(json, "w.json");
  EXPECT_FALSE(read.somewhere);
  EXPECT_FALSE(read.parts[0].count);
}

TEST(DescribedJson, RefusesByFileAndPlace) {
  const Json good = to_json(example());
  const auto expect_refused = [&good](const char* pointer, const Json& value, const char* says) {
    Json bad = good;
    bad[Json::json_pointer(pointer)] = value;
    EXPECT_THAT(
        [&] { static_cast<void>(from_json<Whole>(bad, "w.json", "/deep", "Make it again")); },
        ThrowsMessage<DataError>(::testing::AllOf(HasSubstr("w.json"), HasSubstr(says), HasSubstr("Make it again"))))
        << pointer;
  };
  expect_refused("/schema", "test/2", "/deep/schema: found \"test/2\", expected test/1");
  expect_refused("/on", 1, "/deep/on: found 1, expected true or false");
  expect_refused("/text", nullptr, "/deep/text: found null, expected text");
  expect_refused("/outcome", "splendid", "/deep/outcome: found \"splendid\"");
  expect_refused("/place", Json::array({1.0, 2.0}), "/deep/place: found [1.0,2.0], expected a list of 3 numbers");
  expect_refused("/place/1", "x", "/deep/place");
  expect_refused("/place/1", std::numeric_limits<double>::infinity(), "/deep/place");
  expect_refused("/transform/2", Json::array(), "/deep/transform/2: found []");
  expect_refused("/flags/1", 256, "/deep/flags");
  expect_refused("/flags/1", -5, "/deep/flags");
  expect_refused("/flags/1", 0.5, "/deep/flags");
  expect_refused("/rows/2", 4, "/deep/rows/2: found 4");
  expect_refused("/rows/2/1", "x", "/deep/rows/2");
  expect_refused("/parts/1/length_mm", 0.0, "/deep/parts/1/length_mm: found 0.0, expected a number above 0");
  expect_refused("/parts/0/count", 10, "/deep/parts/0/count: found 10");
  expect_refused("/parts/0/count", 2.5, "/deep/parts/0/count: found 2.5, expected a whole number");
  expect_refused("/parts/0/count", std::uint64_t{1} << 63U, "/deep/parts/0/count");
  expect_refused("/parts/0", 7, "/deep/parts/0: found 7, expected an object");
  expect_refused("/parts", "none", "/deep/parts: found \"none\", expected a list");
  expect_refused("/maybe", 3, "/deep/maybe: found 3, expected an object");
  expect_refused("/somewhere", 3, "/deep/somewhere: found 3");
  EXPECT_THAT([] { static_cast<void>(from_json<Whole>(Json::array(), "w.json")); },
              ThrowsMessage<DataError>(HasSubstr("/: found [], expected an object")));
  Json bad = good;
  bad["parts"][1].erase("length_mm");
  EXPECT_THAT([&] { static_cast<void>(from_json<Whole>(bad, "w.json")); },
              ThrowsMessage<DataError>(HasSubstr("/parts/1/length_mm: found no such key")));
}

}  // namespace
}  // namespace incise
