#include <incise/core/error.hpp>
#include <incise/core/problem_text.hpp>

#include <gtest/gtest.h>

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
  EXPECT_EQ(unknown.without_place(), std::string(unknown.what()).substr(std::string_view("case: ").size()));
  EXPECT_EQ(CaseError("case", "", "a list", "a table").without_place(), "found a list, expected a table");
  EXPECT_STREQ(CaseError("tumour edge", "point 3", "x", "y").in_file("case.yaml").what(),
               "case.yaml: tumour edge: point 3: found x, expected y");
  EXPECT_STREQ(CaseError("case", "", "a list", "a table").in_file("case.yaml").what(),
               "case.yaml: found a list, expected a table");
  const CaseError known("case.yaml line 7", "plan.depth_mm", "0", "more");
  EXPECT_STREQ(known.in_file("case.yaml").what(), known.what());
}

TEST(DataError, NamesPathPlaceFoundAndExpected) {
  const DataError error("ct/slice.dcm", "byte 128", "'ABCD'", "'DICM'");
  EXPECT_STREQ(error.what(), "ct/slice.dcm: byte 128: found 'ABCD', expected 'DICM'");
  EXPECT_EQ(error.path(), std::filesystem::path("ct/slice.dcm"));
}

TEST(Require, ThrowsInvalidArgumentThatNamesTheFunction) {
  EXPECT_NO_THROW(need_positive(1.0));
  try {
    need_positive(-1.0);
    FAIL() << "expected InvalidArgument";
  } catch (const InvalidArgument& error) {
    EXPECT_STREQ(error.what(), "need_positive: expected a value above 0, found -1");
  }
}

TEST(ProblemText, LeavesOutTheNameOfTheFunctionAndNothingElse) {
  const auto text_of = [](const char* what) { return without_function_name(InvalidArgument(what)); };
  EXPECT_EQ(text_of("find_edges: expected 2 triangles"), "expected 2 triangles");
  EXPECT_EQ(text_of("operator(): expected a: b"), "expected a: b");
  EXPECT_EQ(text_of("the edge of two: found 3"), "the edge of two: found 3");
  EXPECT_EQ(text_of("no colon"), "no colon");
  EXPECT_EQ(as_sentence(InvalidArgument("find_edges: expected 2 triangles")), "Expected 2 triangles");
}

TEST(ProblemText, TakesAComplaintApartSoThatNothingIsSaidTwice) {
  const auto parts = [](const char* sentence) {
    const Complaint c = complaint_of(sentence, "otherwise");
    return c.field + "|" + c.found + "|" + c.expected;
  };
  EXPECT_EQ(parts("rotations: expected 8 to 2000, found 3"), "rotations|3|8 to 2000");
  EXPECT_EQ(parts("clearance_mm: found -1, expected a number above 0"), "clearance_mm|-1|a number above 0");
  EXPECT_EQ(parts("expected tips apart, found 0 mm after waypoint 3"), "|0 mm after waypoint 3|tips apart");
  EXPECT_EQ(parts("case: plan.depth: found 2, expected 3. Why so"), "case: plan.depth|2|3. Why so");
  EXPECT_EQ(parts("planes: expected 0 to 20"), "planes|another value|0 to 20");
  EXPECT_EQ(parts("it is bent"), "|it is bent|otherwise");
  EXPECT_STREQ(
      fault_of_file("a.json", "waypoints", InvalidArgument("TipCurve: expected tips apart, found 0 mm"), "x").what(),
      "a.json: waypoints: found 0 mm, expected tips apart");
}

TEST(Errors, AreAllCaughtAsTheBase) {
  EXPECT_THROW(throw CaseError("a", "b", "c", "d"), Error);
  EXPECT_THROW(throw DataError("a", "b", "c", "d"), Error);
  EXPECT_THROW(throw InvalidArgument("a"), Error);
  EXPECT_THROW(throw Cancelled("a"), Error);
}

}  // namespace
}  // namespace incise
