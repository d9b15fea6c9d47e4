#include "report/markup.hpp"
#include "report/ring_fixture.hpp"
#include "report/three_script.hpp"
#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/report/html_report.hpp>
#include <incise/report/number_text.hpp>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>

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

TEST(HtmlReport, ShowsTheBannerAndTheTables) {
  const std::string page = markup_of(full_page());
  for (const char* text :
       {"Virtual specimen: no real tissue was cut", "Ring around a virtual tumour", "mean absolute error", ">1.13</td>",
        ">0.31</td>", "✓ passed", "✗ failed", "≥ 0.050", "<td class=\"number\" data-name=\"wall time, s\">61.50</td>",
        "Calibration of speed and dullness", "cut.speed_mm_s", "140 × 108 × 24 voxels of 0.5 × 0.5 × 1 mm",
        "frames.pvd"}) {
    EXPECT_THAT(page, HasSubstr(text));
  }
}

TEST(HtmlReport, AnswersFirstWithTheWorstReason) {
  ReportData data = testing::RingFixture(4.0).data(2);
  Verdict verdict;
  verdict.add("depth", 0.7, "the kerf is too shallow");
  verdict.add("lateral_margin", 1.75, "the cut leaves 1.75 mm of tissue");
  data.verdict = verdict;
  const std::string page = html_report(data);
  EXPECT_THAT(page,
              HasSubstr("<p class=\"verdict refused\" role=\"status\"><strong>Refused</strong> <span>The cut leaves "
                        "1.75 mm of tissue. <a href=\"#findings\">1 more</a></span></p>"));
  data.verdict = Verdict();
  EXPECT_THAT(html_report(data), HasSubstr("<strong>OK</strong> <span>No reason against the cut is known.</span>"));
}

TEST(HtmlReport, PutsTheThreeNumbersSideBySideAndSaysWhatIsNotKnown) {
  ReportData data = testing::RingFixture(4.0).data(2);
  data.incisions[0].nearest_to_tumor_mm = -0.004;
  data.incisions[0].least_depth_mm = 4.8349;
  data.incisions[1].greatest_error_mm = 0.1;
  const std::string page = html_report(data);
  const auto cells = texts_between(page.substr(page.find("Closest approach")), "<td class=\"number\"", "</td>");
  ASSERT_GE(cells.size(), 6U);
  const std::array<const char*, 6> expected{">0.00 mm",         ">not measured", ">4.83 mm",
                                            ">nothing was cut", ">not measured", ">0.10 mm"};
  for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_THAT(cells[k], ::testing::EndsWith(expected[k]));
}

TEST(HtmlReport, SaysThatThereIsNoCorrectedCut) {
  ReportData data = testing::RingFixture(4.0).data(2);
  data.incisions.pop_back();
  data.remarks = {"There is no corrected cut: only a ring is corrected."};
  const std::string page = markup_of(html_report(data));
  EXPECT_THAT(page, HasSubstr("only a ring is corrected"));
  EXPECT_EQ(texts_between(page, "data-name=\"Corrected\">not cut", "/td>").size(), 4U);
}

TEST(HtmlReport, ShowsBothContoursInOneRangeOfColoursAndAtOneScale) {
  const std::string page = markup_of(full_page());
  const std::string first = page.substr(0, page.find("id=\"findings\""));
  const auto ticks = texts_between(first, "text-anchor=\"middle\" font-size=\"12.5\">−3", "/text>");
  EXPECT_EQ(ticks.size(), 4U) << "before and after, in safe and in jet colours";
  const auto bars = texts_between(first, "x1=\"14.00\" y1=\"336.00\" x2=\"", "\"");
  ASSERT_EQ(bars.size(), 4U);
  EXPECT_THAT(bars, ::testing::Each(bars.front()));
}

TEST(HtmlReport, ListsEveryFindingWorstFirstAndCaveatsByThemselves) {
  ReportData data;
  data.notices = {{Severity::Notice, "seen"}, {Severity::Warning, "doubtful"}};
  data.caveats = {"No tissue was cut."};
  Verdict verdict;
  verdict.add("heat", -1.0, "heat reaches the tumour");
  verdict.add("open_layer", {}, "a layer is open");
  data.verdict = verdict;
  const std::string page = html_report(data);
  const auto kinds = texts_between(page, "<li class=\"", "\">");
  EXPECT_THAT(kinds, ::testing::ElementsAre("refused", "caution", "warning", "notice"));
  EXPECT_THAT(page, HasSubstr("1 refused, 1 caution, 1 warning, 1 notice, worst first."));
  const std::size_t caveats = page.find("id=\"caveats\"");
  EXPECT_LT(page.find("id=\"findings\""), caveats);
  EXPECT_GT(page.find("No tissue was cut."), caveats);
}

TEST(HtmlReport, DrawsTumourAndPlannedCutOnTheSlicesWithALegend) {
  const testing::RingFixture fixture(4.0);
  ReportData data = fixture.data(2);
  EXPECT_THAT(html_report(data), Not(HasSubstr("data-curve=\"tumor\"")));
  const TetMesh cube = make_block({4.0, 4.0, 4.0}, {1, 1, 1});
  for (const Vec3& p : cube.vertices) data.ct.tumor.vertices.emplace_back(p + Vec3(20.0, 20.0, 6.3));
  for (const BoundaryFace& face : boundary_faces(cube)) data.ct.tumor.triangles.push_back(face.corners);
  data.ct.tumor_is_surface = true;
  const std::string page = html_report(data);
  EXPECT_THAT(page, HasSubstr("data-curve=\"tumor\""));
  EXPECT_THAT(page, Not(HasSubstr("data-curve=\"planned-cut\"")));
  const auto sections = texts_between(page, "\"tumor\":\"", "\"");
  EXPECT_EQ(sections.size(), 24U) << "one for each axial slice";
  EXPECT_EQ(std::count(sections.begin(), sections.end(), ""), 20) << "it is 4 mm high, and slices are 1 mm apart";
}

TEST(MeasureText, HasTheDigitsThatANumberDeserves) {
  EXPECT_EQ(measure_text(1.38, "mm"), "1.38");
  EXPECT_EQ(measure_text(0.09811, "mm"), "0.10");
  EXPECT_EQ(measure_text(-2.6706, "mm"), "−2.67");
  EXPECT_EQ(measure_text(8.882e-16, "mm"), "0");
  EXPECT_EQ(measure_text(-0.001, "mm"), "0");
  EXPECT_EQ(measure_text(123.456, "mm"), "123.5");
  EXPECT_EQ(measure_text(4321.9, "mN"), "4322");
  EXPECT_EQ(measure_text(250.0, "mm/s"), "250");
  EXPECT_EQ(measure_text(0.01480, ""), "0.015");
  EXPECT_EQ(measure_text(3.1416, ""), "3.14");
  EXPECT_THROW(static_cast<void>(measure_text(std::nan(""), "mm")), InvalidArgument);
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
  ReportData bad{.approach = Vec3::Zero()};
  EXPECT_THROW(write_report(bad, folder / "bad.html"), InvalidArgument);
  EXPECT_FALSE(std::filesystem::exists(folder / "bad.html"));
  EXPECT_THROW(write_report({}, folder / "nowhere" / "report.html"), DataError);
}

}  // namespace
}  // namespace incise
