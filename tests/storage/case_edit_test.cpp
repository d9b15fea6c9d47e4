#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/storage/case_edit.hpp>

#include <gtest/gtest.h>

#include <fstream>

namespace incise {
namespace {

constexpr const char* kText =
    "# Made by hand.\n"
    "schema: incise.case/1\n"
    "title: \"007\"\n"
    "specimen:\n"
    "  mesh: block.msh\n"
    "  constraints:\n"
    "    - {kind: fixed, where: {end: {direction: posterior, within_mm: 8}}}\n"
    "    - {kind: displaced, where: {end: {direction: anterior, within_mm: 7}}, displacement_mm: [0, -8, 0]}\n"
    "tumor: {contour: 'a # b.csv'}\n"
    "plan: {depth_mm: 4.25}\n";

class CaseEditTest : public ::testing::Test {
 protected:
  CaseEditTest() { std::ofstream(file()) << kText; }
  std::filesystem::path file() const { return folder_ / "case.yaml"; }
  CaseFile change(const CaseChanges& changes) { return change_case(file(), case_revision(file()), changes); }
  testing::TemporaryFolder folder_;
};

/// Every setting of a case as a person reads it.
std::string lines_of(const CaseFile& file) {
  std::string text;
  for (const SettingLine& line : settings_of(file)) text += line.key + "=" + line.value + "\n";
  return text;
}

TEST_F(CaseEditTest, ChangesOneFieldAndLeavesTheOthers) {
  const std::string before = lines_of(read_case(file()));
  const CaseFile changed = change({{"plan.depth_mm", 3}});
  EXPECT_EQ(changed.settings.plan.depth_mm, 3.0);
  EXPECT_EQ(lines_of(changed), lines_of(read_case(file())));
  EXPECT_EQ(lines_of(change({{"plan.depth_mm", 4.25}})), before);
}

TEST_F(CaseEditTest, MakesGroupsThatAreNotThereAndRemovesThoseThatAreEmpty) {
  EXPECT_EQ(change({{"cut.speed_mm_s", 9}, {"plan.lateral_margin_mm", 6}}).settings.cut.speed_mm_s, 9.0);
  EXPECT_NE(read_text(file()).find("speed_mm_s: 9"), std::string::npos);
  EXPECT_EQ(change({{"cut.speed_mm_s", nullptr}, {"cut.dullness", nullptr}}).settings.cut.speed_mm_s,
            CutSettings{}.speed_mm_s);
  EXPECT_EQ(read_text(file()).find("cut:"), std::string::npos);
}

TEST_F(CaseEditTest, KeepsTextsThatLookLikeSomethingElse) {
  const CaseFile changed = change({{"specimen_id", "12"}});
  EXPECT_EQ(changed.settings.title, "007");
  EXPECT_EQ(changed.settings.specimen_id, "12");
  EXPECT_EQ(changed.inputs.tumor_contour.filename(), "a # b.csv");
  EXPECT_EQ(change({{"title", "null"}}).settings.title, "null");
  EXPECT_EQ(change({{"title", "a: {b} \"c\" # d\n\xc3\xa9"}}).settings.title, "a: {b} \"c\" # d\n\xc3\xa9");
}

TEST_F(CaseEditTest, SetsListsOfGroups) {
  const auto constraints =
      nlohmann::ordered_json::parse(R"([{"kind": "fixed", "where": {"box_mm": [[0, 0, 0], [1, 2, 3]]}}])");
  const CaseFile changed = change({{"specimen.constraints", constraints}});
  ASSERT_EQ(changed.settings.constraints->size(), 1U);
  EXPECT_FALSE(change({{"specimen.constraints", nullptr}}).settings.constraints.has_value());
}

TEST_F(CaseEditTest, RefusesWhatIsNoCaseAndLeavesTheFile) {
  EXPECT_THROW(change({{"plan.depth_mm", -1}}), CaseError);
  EXPECT_THROW(change({{"plan.depht_mm", 3}}), CaseError);
  EXPECT_THROW(change({{"plan.depth_mm.deeper", 3}}), CaseError);
  EXPECT_THROW(change({{"schema", nullptr}}), CaseError);
  EXPECT_THROW(change({{"plan", "ring"}}), CaseError);
  EXPECT_EQ(read_text(file()), kText);
}

TEST_F(CaseEditTest, KeepsWhoMayReadTheFile) {
  constexpr auto kMine = std::filesystem::perms::owner_read | std::filesystem::perms::owner_write;
  std::filesystem::permissions(file(), kMine);
  static_cast<void>(change({{"plan.depth_mm", 3}}));
  EXPECT_EQ(std::filesystem::status(file()).permissions(), kMine);
}

TEST_F(CaseEditTest, RefusesAFileThatWasChangedMeanwhile) {
  const std::string revision = case_revision(file());
  std::ofstream(file(), std::ios::app) << "cut: {dullness: 5}\n";
  const std::string text = read_text(file());
  EXPECT_THROW(change_case(file(), revision, {{"plan.depth_mm", 3}}), StaleRevision);
  EXPECT_EQ(read_text(file()), text);
}

TEST_F(CaseEditTest, KeepsTheFileAsItWasBeforeACommentIsLost) {
  static_cast<void>(change({{"tumor.contour", "a.csv"}}));  // a text with '#' in it is taken for a comment
  std::filesystem::remove(folder_ / "case.yaml.orig");
  static_cast<void>(change({{"plan.depth_mm", 3}}));
  EXPECT_TRUE(read_text(file()).starts_with("# Made by hand.\nschema:"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "case.yaml.orig")) << "no comment was lost";
  std::ofstream(file(), std::ios::app) << "cut: {dullness: 5}  # as calibrated\n";
  const std::string commented = read_text(file());
  static_cast<void>(change({{"plan.depth_mm", 4}}));
  EXPECT_EQ(read_text(folder_ / "case.yaml.orig"), commented);
  std::ofstream(file(), std::ios::app) << "thermal: {body_c: 36}  # measured\n";
  const std::string again = read_text(file());
  static_cast<void>(change({{"plan.depth_mm", 5}}));
  EXPECT_EQ(read_text(folder_ / "case.yaml.orig.2"), again);
}

}  // namespace
}  // namespace incise
