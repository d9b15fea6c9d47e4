#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/io/table_io.hpp>

#include <gmock/gmock.h>

#include <fstream>

namespace incise {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::TemporaryFolder;
using ::testing::ThrowsMessage;

TEST(TextTable, KeepsDigitsAsPrintedAndReadsBackWhatItWrites) {
  const TemporaryFolder folder;
  const TextTable table{.header = {"name", "mean"}, .rows = {{"a, \"b\"", "1.20"}, {"", "−"}}, .lines = {}};
  std::ofstream(folder / "t.csv", std::ios::binary) << csv_text(table);
  const TextTable back = read_csv_text(folder / "t.csv");
  EXPECT_EQ(back.header, table.header);
  EXPECT_EQ(back.rows, table.rows);
  EXPECT_THAT(back.lines, ElementsAre(2U, 3U));
}

TEST(TextTable, TakesByteOrderMarksLineEndsOfAnyKindAndBlankLines) {
  const TemporaryFolder folder;
  std::ofstream(folder / "t.csv", std::ios::binary) << "\xEF\xBB\xBFx , y\r\n\r\n1,\r\n \"2\" , 3 \n";
  const TextTable table = read_csv_text(folder / "t.csv");
  EXPECT_THAT(table.header, ElementsAre("x", "y"));
  EXPECT_THAT(table.rows, ElementsAre(ElementsAre("1", ""), ElementsAre("2", "3")));
  EXPECT_THAT(table.lines, ElementsAre(3U, 4U));
}

TEST(TextTable, RefusesDamageWithItsLine) {
  const TemporaryFolder folder;
  const auto refusal = [&](const char* text, const char* says) {
    std::ofstream(folder / "t.csv", std::ios::binary) << text;
    EXPECT_THAT([&] { static_cast<void>(read_csv_text(folder / "t.csv")); }, ThrowsMessage<DataError>(HasSubstr(says)))
        << text;
  };
  refusal("", "an empty file");
  refusal("a,b\n1\n", "line 2");
  refusal("a,a\n1,2\n", "'a' more than once");
  refusal("a,\n1,2\n", "no name");
  refusal("a,b\n1,\"2\n", "a quote that is not closed");
  refusal("a,b\n1,\"2\"x\n", "after a closing quote");
  refusal("a,b\n1,x\ry\n", "control character (0x0d)");
  refusal("a,b\n1,caf\xe9\n", "not UTF-8");
}

TEST(TextTable, RefusesTheFirstRowBeyondTheCellsThatItMayHold) {
  const TemporaryFolder folder;
  std::ofstream(folder / "t.csv", std::ios::binary) << "a,b\n1,2\n3,4\n5,6\n7,8\n";
  EXPECT_EQ(read_csv_text(folder / "t.csv", 8).rows.size(), 4U);
  EXPECT_THAT([&] { static_cast<void>(read_csv_text(folder / "t.csv", 7)); },
              ThrowsMessage<DataError>(
                  HasSubstr("t.csv: line 5: found more than 3 rows of 2 columns, expected at most 7 cells")));
}

TEST(LatexText, EscapesWhatLatexWouldReadAsACommand) {
  const std::string text =
      latex_text({.header = {"mean ± sd", "p_%"}, .rows = {{"1.73 ± 0.80", "< 5 % & {x} \\ ~^#$"}}, .lines = {}});
  EXPECT_THAT(text, HasSubstr("mean $\\pm$ sd & p\\_\\% \\\\"));
  EXPECT_THAT(text, HasSubstr("$<$ 5 \\% \\& \\{x\\} \\textbackslash{} \\~{}\\^{}\\#\\$ \\\\"));
  EXPECT_THAT(text, HasSubstr("\\begin{tabular}{ll}"));
}

TEST(TextTable, RefusesToWriteRaggedRows) {
  EXPECT_THROW(static_cast<void>(csv_text({.header = {"a"}, .rows = {{"1", "2"}}, .lines = {}})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(csv_text({.header = {"a"}, .rows = {{"1\n"}}, .lines = {}})), InvalidArgument);
}

}  // namespace
}  // namespace incise
