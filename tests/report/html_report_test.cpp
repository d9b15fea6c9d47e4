#include "report/markup.hpp"
#include "report/ring_fixture.hpp"
#include "report/three_script.hpp"
#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/report/html_report.hpp>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace incise {
namespace {

using testing::decoded_base64;
using ::testing::HasSubstr;
using testing::nesting_problem;
using ::testing::Not;
using testing::texts_between;

const std::string& full_page() {
  static const std::string kPage = html_report(testing::RingFixture(4.0).data(4));
  return kPage;
}

/// The page without its scripts, which hold three.js.
std::string markup_of(const std::string& page) {
  return page.substr(0, page.find("<script"));
}

TEST(HtmlReport, ClosesEveryTag) {
  EXPECT_EQ(nesting_problem(full_page()), "");
}

TEST(HtmlReport, LeavesNoPlaceOfItsTemplateUnfilled) {
  EXPECT_THAT(markup_of(full_page()), Not(HasSubstr("{{")));
}

TEST(HtmlReport, ShowsTheBannerTheHeadlinesAndTheTables) {
  const std::string page = markup_of(full_page());
  for (const char* text : {"Virtual specimen: no real tissue was cut", "Ring around a virtual tumour",
                           "ring closed, negative margin", "change of the mean |error|", "mean absolute error",
                           "<td class=\"number\">1.13</td>", "<td class=\"number\">0.31</td>", "✓ passed", "✗ failed",
                           "≥ 0.05", "<td class=\"number\">61.50</td>", "Calibration of speed and dullness",
                           "cut.speed_mm_s", "140 × 108 × 24 voxels of 0.5 × 0.5 × 1 mm", "frames.pvd"}) {
    EXPECT_THAT(page, HasSubstr(text));
  }
}

TEST(HtmlReport, TellsTheChangeInPercent) {
  ReportData data;
  data.incisions = {{.name = "Before", .mean_abs_error_mm = 1.6}, {.name = "After", .mean_abs_error_mm = 0.4}};
  EXPECT_THAT(html_report(data), HasSubstr("−75 <span class=\"unit\">%</span>"));
}

TEST(HtmlReport, EscapesTextsOfTheCaller) {
  EXPECT_THAT(full_page(), HasSubstr("One &lt;check&gt; failed &amp; is told."));
  EXPECT_THAT(full_page(), HasSubstr("0.2 &lt; 0.3"));
}

TEST(HtmlReport, LoadsNothingFromANetwork) {
  const std::string& page = full_page();
  EXPECT_THAT(page, HasSubstr("default-src 'none'; img-src data:"));
  for (const char* reference :
       {"src=\"http", "href=\"http", "src=\"//", "url(", "@import", "<link", "<iframe", "integrity="}) {
    EXPECT_THAT(markup_of(page), Not(HasSubstr(reference))) << reference;
  }
  for (const std::string& tag : texts_between(page, "<script", ">")) EXPECT_THAT(tag, Not(HasSubstr("src")));
  for (const std::string& source : texts_between(markup_of(page), "src=\"", "\"")) {
    EXPECT_THAT(source, ::testing::StartsWith("data:image/png;base64,"));
  }
}

TEST(HtmlReport, KeepsTheLicenceOfTheLibraryInIt) {
  EXPECT_EQ(texts_between(full_page(), "Copyright © 2010-2026 three.js authors", "DEALINGS IN").size(), 2U);
}

TEST(ThreeScript, MakesOneScriptOfTwoModules) {
  const std::string script =
      three_script("const a=1,b=2;export{a as One,b as Two};",
                   "import{One as x}from\"./three.core.js\";export{One,Two}from\"./three.core.js\";const "
                   "y=x+1;export{y as Y,x as One};");
  EXPECT_THAT(script, HasSubstr("const a=1,b=2;\nreturn{One:a,Two:b,};"));
  EXPECT_THAT(script, HasSubstr("const{One:x,}=core;\nconst y=x+1;\nreturn{...core,Y:y,One:x,};"));
  EXPECT_THROW(static_cast<void>(three_script("const a=1;", "const b=2;")), InvalidArgument);
}

TEST(HtmlReport, HasDataThatParse) {
  const auto blocks = texts_between(full_page(), "<script type=\"application/json\" id=\"report-data\">", "</script>");
  ASSERT_EQ(blocks.size(), 1U);
  const auto data = nlohmann::json::parse(blocks[0]);
  EXPECT_EQ(data["animations"].size(), 2U);
  EXPECT_EQ(data["animations"][0]["frames"].size(), 6U);
  EXPECT_EQ(data["axial"]["slices"].size(), 24U);
  EXPECT_EQ(data["view"]["ends"][5], "S");
}

TEST(HtmlReport, HasPicturesThatDecode) {
  const auto pictures = texts_between(full_page(), "data:image/png;base64,", "\"");
  EXPECT_GE(pictures.size(), 5U);  // three slices, two still pictures, and the slider's slices
  for (const std::string& picture : pictures) EXPECT_EQ(decoded_base64(picture).substr(1, 3), "PNG");
}

TEST(HtmlReport, DescribesEveryPictureForScreenReaders) {
  const std::string page = markup_of(full_page());
  for (const std::string& tag : texts_between(page, "<img", ">")) EXPECT_THAT(tag, HasSubstr("alt=\""));
  for (const std::string& tag : texts_between(page, "<svg", ">")) EXPECT_THAT(tag, HasSubstr("aria-label=\""));
}

TEST(HtmlReport, OfNothingSaysWhatIsMissing) {
  const std::string page = html_report({});
  EXPECT_EQ(nesting_problem(page), "");
  for (const char* text :
       {"No incision has been evaluated yet.", "There is no CT here.", "There is no mesh here.",
        "There are no pictures of the cut here.", "There is no incision contour here.", "There is no evaluation here.",
        "There are no measures of the kerf here.", "No program has been exported.", "The settings are not known."}) {
    EXPECT_THAT(page, HasSubstr(text));
  }
  EXPECT_THAT(page, Not(HasSubstr("class=\"virtual\"")));
}

TEST(HtmlReport, ShowsWhatIsKnownOfTheKerf) {
  ReportData data;
  LinePlot depth{.title = "Depth of the kerf (simulated)", .x_label = "way, mm", .y_label = "depth, mm", .series = {}};
  depth.series.push_back({"as planned", {0, 1}, {4, 5}, true});
  data.kerf_plots.push_back(depth);
  data.kerf_layers = {"Mid-line by depth", {"cut", "depth, mm"}, {{"as planned", "2.50"}}};
  const std::string page = html_report(data);
  EXPECT_EQ(nesting_problem(page), "");
  EXPECT_THAT(page, HasSubstr("Depth of the kerf (simulated)"));
  EXPECT_THAT(page, HasSubstr("Mid-line by depth"));
  EXPECT_THAT(page, Not(HasSubstr("There are no measures of the kerf here.")));
}

TEST(HtmlReport, IsTheSameForTheSameData) {
  const testing::RingFixture fixture(6.0);
  EXPECT_EQ(html_report(fixture.data(2)), html_report(fixture.data(2)));
}

TEST(HtmlReport, StaysBelowFifteenMegabytesForTwentyFramesOfFortyThousandTets) {
  const testing::RingFixture fixture(1.65);  // 36 x 27 x 7 cells
  EXPECT_GT(fixture.mesh.tets.size(), 40'000U);
  EXPECT_LT(html_report(fixture.data(20)).size(), 15'000'000U);
}

TEST(WriteReport, WritesThePageAndNothingWhenItIsRefused) {
  const testing::TemporaryFolder folder;
  write_report({}, folder / "report.html");
  EXPECT_EQ(read_text(folder / "report.html"), html_report({}));
  ReportData bad;
  bad.approach = Vec3::Zero();
  EXPECT_THROW(write_report(bad, folder / "bad.html"), InvalidArgument);
  EXPECT_FALSE(std::filesystem::exists(folder / "bad.html"));
  EXPECT_THROW(write_report({}, folder / "nowhere" / "report.html"), DataError);
}

}  // namespace
}  // namespace incise
