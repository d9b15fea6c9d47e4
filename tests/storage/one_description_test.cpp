#include "storage/field_writers.hpp"
#include "storage/yaml_reader.hpp"
#include "support/refusal.hpp"

#include <incise/core/cache.hpp>
#include <incise/core/described_bytes.hpp>
#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>

#include <gmock/gmock.h>

/// What follows from a field's one line: add a field to a described type, and all of this has it.

namespace incise {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Probe {
  double reach_mm = 0.25;
};
void describe(Visitor& v, Probe& p) {
  v({"reach_mm", "How far the probe reaches.", "mm"}, p.reach_mm, {0.0, 5.0});
}

Probe from_yaml(const char* text) {
  Probe probe;
  YamlReader reader(YAML::Load(text), "probe.yaml");
  describe(reader, probe);
  reader.finish();
  return probe;
}

TEST(OneDescription, AFieldIsReadFromYaml) {
  EXPECT_EQ(from_yaml("{reach_mm: 1.5}").reach_mm, 1.5);
  EXPECT_EQ(from_yaml("{}").reach_mm, 0.25);
  EXPECT_THAT(testing::refusal_of<CaseError>([] { return from_yaml("{reach_mm: 6}"); }),
              HasSubstr("reach_mm: found 6, expected a number in [0, 5]"));
  EXPECT_THROW(from_yaml("{reech_mm: 1}"), CaseError);
}

TEST(OneDescription, AFieldIsWrittenAndReadAsJson) {
  const auto json = to_json(Probe{1.5});
  EXPECT_EQ(json.dump(), R"({"reach_mm":1.5})");
  EXPECT_EQ(from_json<Probe>(json, "probe.json").reach_mm, 1.5);
  EXPECT_THROW((void)from_json<Probe>({{"reach_mm", 6.0}}, "probe.json"), DataError);
}

TEST(OneDescription, AFieldIsInTheSchema) {
  SchemaWriter schema;
  Probe probe;
  describe(schema, probe);
  const auto property = schema.properties().at("reach_mm");
  EXPECT_EQ(property.at("default"), 0.25);
  EXPECT_EQ(property.at("minimum"), 0.0);
  EXPECT_EQ(property.at("maximum"), 5.0);
  EXPECT_THAT(property.at("description").get<std::string>(), HasSubstr("How far the probe reaches."));
}

TEST(OneDescription, AFieldIsValidated) {
  EXPECT_THAT(sentences(problems_of(Probe{6.0})), ElementsAre("reach_mm: found 6, expected a number in [0, 5]"));
}

TEST(OneDescription, AFieldIsPartOfTheCacheKey) {
  EXPECT_EQ(CacheKey("stage").add(Probe{}).digest(), CacheKey("stage").add(Probe{}).digest());
  EXPECT_NE(CacheKey("stage").add(Probe{}).digest(), CacheKey("stage").add(Probe{0.5}).digest());
  EXPECT_EQ(from_bytes<Probe>(bytes_of(Probe{1.5}), "probe").reach_mm, 1.5);
}

/// The report, the manifest and Python's Case.settings show these lines.
TEST(OneDescription, AFieldIsALineOfTheReport) {
  SettingLister lister;
  Probe probe{1.5};
  describe(lister, probe);
  ASSERT_EQ(lister.lines().size(), 1U);
  const SettingLister::Line& line = lister.lines().front();
  EXPECT_THAT((std::array{line.name, line.value, line.unit, line.meaning}),
              ElementsAre("reach_mm", "1.5", "mm", "How far the probe reaches."));
}

}  // namespace
}  // namespace incise
