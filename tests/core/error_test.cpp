#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/core/utf8.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>

namespace incise {
namespace {

void need_positive(double value) {
  INCISE_REQUIRE(value > 0.0, "expected a value above 0, found -1");
}

TEST(CaseError, NamesPlaceFieldFoundExpectedAndHintInThatOrder) {
  const CaseError error("case.yaml", "cut.speed_mm_s", "-3", "a number above 0", "Try 13");
  EXPECT_STREQ(error.what(), "case.yaml: cut.speed_mm_s: found -3, expected a number above 0. Try 13");
  EXPECT_EQ(error.field(), "cut.speed_mm_s");
}

TEST(CaseError, LeavesOutWhatIsEmpty) {
  EXPECT_STREQ(CaseError("case.yaml", "", "a list", "a table").what(), "case.yaml: found a list, expected a table");
}

TEST(CaseError, NamesTheFileThatItsThrowerDidNotKnow) {
  const CaseError unknown("case", "specimen.constraints[0].where", "nothing", "a vertex", "Try: a box");
  EXPECT_STREQ(unknown.in_file("a/case.yaml").what(),
               "a/case.yaml: specimen.constraints[0].where: found nothing, expected a vertex. Try: a box");
  EXPECT_EQ(unknown.in_file("a/case.yaml").field(), "specimen.constraints[0].where");
  EXPECT_EQ(unknown.problem().found, "nothing");
  EXPECT_STREQ(CaseError("tumour edge", "point 3", "x", "y").in_file("case.yaml").what(),
               "case.yaml: tumour edge: point 3: found x, expected y");
  EXPECT_STREQ(CaseError("case", "", "a list", "a table").in_file("case.yaml").what(),
               "case.yaml: found a list, expected a table");
  const CaseError known("case.yaml line 7", "plan.depth_mm", "0", "more");
  EXPECT_STREQ(known.in_file("case.yaml").what(), known.what());
}

TEST(SystemReason, ReadsWellInsideASentence) {
  EXPECT_EQ(system_reason(ENOENT), "no such file or directory");
  EXPECT_EQ(system_reason(std::make_error_code(std::errc::permission_denied)), "permission denied");
}

TEST(WithinSentence, KeepsAbbreviations) {
  EXPECT_EQ(within_sentence("A cloud"), "a cloud");
  EXPECT_EQ(within_sentence("DICOM folder"), "DICOM folder");
  EXPECT_EQ(within_sentence("A"), "A");
  EXPECT_EQ(within_sentence(""), "");
}

TEST(DataError, NamesPathPlaceFoundAndExpected) {
  const DataError error("ct/slice.dcm", "byte 128", "'ABCD'", "'DICM'");
  EXPECT_STREQ(error.what(), "ct/slice.dcm: byte 128: found 'ABCD', expected 'DICM'");
  EXPECT_EQ(error.path(), std::filesystem::path("ct/slice.dcm"));
}

TEST(DataError, IsUtf8WhateverWasFound) {
  const auto text = [](const std::string& found) { return std::string(DataError("a.json", "", found, "text").what()); };
  EXPECT_THAT(text("caf\xC3"), ::testing::HasSubstr("found caf\\xc3, expected text"));
  EXPECT_THAT(text("café"), ::testing::HasSubstr("found café, expected text"));
  std::string lengthy = "x";
  for (int i = 0; i < 600; ++i) lengthy += "é";
  EXPECT_FALSE(first_not_utf8(text(lengthy)));
}

TEST(Require, ThrowsInvalidArgumentThatNamesTheFunction) {
  EXPECT_NO_THROW(need_positive(1.0));
  EXPECT_EQ(testing::refusal_of<InvalidArgument>([] { need_positive(-1.0); }),
            "need_positive: expected a value above 0, found -1");
}

TEST(InvalidArgument, TellsAPersonWhatIsWrongWithoutTheFunction) {
  const InvalidArgument broken("find_edges", "expected 2 triangles: two, found 1");
  EXPECT_STREQ(broken.what(), "find_edges: expected 2 triangles: two, found 1");
  EXPECT_EQ(broken.text(), "expected 2 triangles: two, found 1");
  EXPECT_EQ(broken.as_hint(), "Expected 2 triangles: two, found 1");
  EXPECT_STREQ(DataError("a.ply", "triangle 3", broken).what(),
               "a.ply: triangle 3: expected 2 triangles: two, found 1");
  EXPECT_STREQ(DataError("a.ply", "", broken).what(), "a.ply: expected 2 triangles: two, found 1");
}

}  // namespace
}  // namespace incise
