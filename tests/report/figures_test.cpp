#include "report/markup.hpp"
#include "report/ring_fixture.hpp"

#include <incise/core/error.hpp>
#include <incise/report/figures.hpp>
#include <incise/report/line_plot.hpp>
#include <incise/report/replay_figure.hpp>

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <regex>

namespace incise {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::nesting_problem;
using ::testing::Not;
using testing::RingFixture;
using testing::texts_between;

const RingFixture& fixture() {
  static const RingFixture kFixture(4.0);
  return kFixture;
}

void expect_whole_svg(const std::string& svg) {
  EXPECT_THAT(svg, ::testing::StartsWith("<svg xmlns=\"http://www.w3.org/2000/svg\""));
  EXPECT_EQ(nesting_problem(svg), "");
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("href=\"http")));
  EXPECT_THAT(svg, HasSubstr("<title>"));
  EXPECT_THAT(svg, HasSubstr("<desc>"));
}

TEST(ContourFigure, ShowsEdgePathsIncisionScaleAndUnits) {
  ReportIncision after = fixture().incision("After", 0.1, 0.5);
  after.corrected_path = after.intended_path;
  const std::string svg = contour_figure_svg(after);
  expect_whole_svg(svg);
  for (const char* text :
       {"tumour edge", "intended path", "corrected path", "5 mm", "error, mm", "start", "closer than 2.2 mm"}) {
    EXPECT_THAT(svg, HasSubstr(std::string(">") + text + "<"));
  }
}

TEST(ContourFigure, DrawsTheScaleBarToScale) {
  // Two points 40 mm apart across the view fill its width of 340 px: 5 mm are 42.5 px.
  ReportIncision cut;
  cut.incision = {.points = {{0, 0, 0}, {40, 0, 0}, {20, 1, 0}}, .is_closed = true};
  cut.signed_error_mm = {0.0, 0.0, 0.0};
  EXPECT_THAT(contour_figure_svg(cut), HasSubstr("x1=\"14.00\" y1=\"336.00\" x2=\"56.50\" y2=\"336.00\""));
}

TEST(ContourFigure, MarksPointsThatAreTooCloseAndThoseThatReachTheEdge) {
  ReportIncision cut = fixture().incision("Before", 0.0, 0.0);
  const auto marks = [&](const char* color) {
    return texts_between(contour_figure_svg(cut), std::string("stroke=\"") + color + "\" stroke-width=\"13\"", ">")
        .size();
  };
  EXPECT_EQ(marks("#cc79a7"), 0U);
  EXPECT_EQ(marks("#b3123f"), 0U);
  cut.signed_error_mm[3] = -2.9;  // 2.1 mm from the edge, close is below 2.2
  cut.signed_error_mm[4] = -2.7;  // 2.3 mm
  cut.signed_error_mm[9] = -5.0;  // on the edge
  EXPECT_EQ(marks("#cc79a7"), 1U);
  EXPECT_EQ(marks("#b3123f"), 1U);
}

TEST(ContourFigure, CountsWhatTheKerfTakesBesideItsMidline) {
  ReportIncision cut = fixture().incision("Before", 0.0, 0.0);
  cut.kerf_allowance_mm = 0.5;
  const auto marks = [&](const char* color) {
    return texts_between(contour_figure_svg(cut), std::string("stroke=\"") + color + "\" stroke-width=\"13\"", ">")
        .size();
  };
  cut.signed_error_mm[3] = -2.35;  // 2.65 mm from the edge to the mid-line, 2.15 mm of tissue
  cut.signed_error_mm[4] = -2.25;  // 2.25 mm of tissue
  cut.signed_error_mm[9] = -4.6;   // the kerf's edge is inside
  EXPECT_EQ(marks("#cc79a7"), 1U);
  EXPECT_EQ(marks("#b3123f"), 1U);
}

TEST(ContourFigure, HasJetColoursWhenAsked) {
  const ReportIncision cut = fixture().incision("Before", 0.0, 1.0);
  const std::string jet = contour_figure_svg(cut, {.colors = ErrorColors::Jet});
  EXPECT_NE(jet, contour_figure_svg(cut));
  expect_whole_svg(jet);
}

TEST(ContourFigure, IsThePictureOfACurveTurnedWithItsView) {
  // Seen from above, x runs right and y up on the page (so y of the page falls).
  ReportIncision cut;
  cut.incision = {.points = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}}, .is_closed = true};
  cut.tumor_edge = cut.incision;
  cut.signed_error_mm = {0.0, 0.0, 0.0};
  const auto polygons = texts_between(contour_figure_svg(cut), "<polygon points=\"", "\"");
  ASSERT_FALSE(polygons.empty());
  EXPECT_EQ(polygons.front(), "77.00,306.00 323.00,306.00 323.00,60.00 ");  // 246 px for 10 mm, centred
}

TEST(ContourFigure, EscapesNames) {
  ReportIncision cut = fixture().incision("a < b & \"c\"", 0.0, 1.0);
  const std::string svg = contour_figure_svg(cut);
  expect_whole_svg(svg);
  EXPECT_THAT(svg, HasSubstr("a &lt; b &amp; &quot;c&quot;"));
}

TEST(ContourFigure, RefusesNumbersThatAreNotFinite) {
  ReportIncision cut = fixture().incision("Before", 0.0, 1.0);
  cut.signed_error_mm[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(contour_figure_svg(cut)), InvalidArgument);
  cut = fixture().incision("Before", 0.0, 1.0);
  cut.tumor_edge.points[0].x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(static_cast<void>(contour_figure_svg(cut)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(contour_figure_svg(ReportIncision{})), InvalidArgument);
}

TEST(ErrorByAngle, StartsAtTheStartOfThePathAndRunsCounterClockwise) {
  // A unit circle sampled at 0, 90, 180, 270 degrees; the path starts at 90 degrees.
  ReportIncision cut;
  cut.incision = {.points = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, .is_closed = true};
  cut.intended_path = {.points = {{0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {1, 0, 0}}, .is_closed = true};
  cut.signed_error_mm = {0.5, 0.0, 0.25, -0.5};
  const std::string svg = error_by_angle_svg({&cut, 1});
  expect_whole_svg(svg);
  // Plot: 70 + 670 px for 360 degrees, 44 + 250 px from +0.5 down to -0.5 mm.
  EXPECT_THAT(svg, HasSubstr("points=\"70.00,169.00 237.50,106.50 405.00,294.00 572.50,44.00 740.00,169.00 \""));
}

TEST(ErrorByAngle, UsesTheArcLengthForAnOpenCut) {
  ReportIncision cut;
  cut.incision = {.points = {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}}, .is_closed = false};
  cut.signed_error_mm = {0.0, 0.5, 0.0};
  const std::string svg = error_by_angle_svg({&cut, 1});
  expect_whole_svg(svg);
  EXPECT_THAT(svg, HasSubstr("length along the cut, mm"));
  EXPECT_THAT(svg, HasSubstr("points=\"70.00,169.00 572.50,44.00 740.00,169.00 \""));
}

TEST(LinePlotFigure, BreaksATitleAndALegendThatAreWiderThanThePicture) {
  const auto height_of = [](const std::string& svg) {
    const std::size_t at = svg.find("height=\"") + 8;
    return std::stod(svg.substr(at));
  };
  LinePlot plot{
      .title = "Short", .x_label = "x, mm", .y_label = "y, mm", .series = {{"one", {0.0, 1.0}, {0.0, 1.0}, true}}};
  const std::string small = line_plot_svg(plot);
  plot.title = "Simulated: error of the mid-line against speed x dullness; open rings are left out of this picture";
  plot.series = {{"mean |error| as planned", {0.0, 1.0}, {0.0, 1.0}, true},
                 {"mean |error| averaged along the path", {0.0, 1.0}, {0.0, 1.0}, true},
                 {"floor of the mesh", {0.0, 1.0}, {0.5, 0.5}, true}};
  const std::string large = line_plot_svg(plot);
  EXPECT_EQ(large.find(">" + plot.title + "</text>"), std::string::npos) << "in one row it leaves the picture";
  EXPECT_NE(large.find(">Simulated: error"), std::string::npos);
  EXPECT_NEAR(height_of(large), height_of(small) + 36.0, 1e-9) << "one more row of each";
}

TEST(LinePlotFigure, DrawsErrorBarsInTheColourOfTheirMarks) {
  LinePlot plot{.title = "Seen", .x_label = "x", .y_label = "y", .series = {{"seen", {0.0, 1.0}, {0.2, 0.5}, false}}};
  const std::regex bar(
      R"re(<line x1="([\d.]+)" y1="([\d.]+)" x2="([\d.]+)" y2="([\d.]+)" stroke="([^"]+)" stroke-width="1.6"/>)re");
  const auto bars_of = [&bar](const std::string& svg) {
    return std::vector<std::smatch>(std::sregex_iterator(svg.begin(), svg.end(), bar), std::sregex_iterator());
  };
  EXPECT_TRUE(bars_of(line_plot_svg(plot)).empty());
  plot.series[0].low = {0.1, -1.0};
  plot.series[0].high = {0.6, 0.5};
  const std::string svg = line_plot_svg(plot);
  expect_whole_svg(svg);
  const std::vector<std::smatch> bars = bars_of(svg);
  ASSERT_EQ(bars.size(), 2);
  const auto length = [](const std::smatch& m) { return std::stod(m[2]) - std::stod(m[4]); };
  EXPECT_NEAR(length(bars[1]), 3.0 * length(bars[0]), 0.05) << "1.5 against 0.5";
  EXPECT_GT(length(bars[0]), 10.0) << "y grows upwards";
  for (const std::smatch& m : bars) {
    EXPECT_EQ(m[1], m[3]);
    EXPECT_THAT(svg, HasSubstr("<circle cx=\"" + m[1].str() + "\"")) << "at its mark";
    EXPECT_THAT(svg, HasSubstr("stroke=\"" + m[5].str() + "\" stroke-width=\"1.6\">")) << "in the colour of the marks";
  }

  plot.series[0].high = {0.4};
  EXPECT_THROW(static_cast<void>(line_plot_svg(plot)), InvalidArgument);
  plot.series[0].low = plot.series[0].high;
  EXPECT_THROW(static_cast<void>(line_plot_svg(plot)), InvalidArgument) << "as many as points";
}

TEST(BoxNumbers, FollowAWorkedExample) {
  // 1 ... 8 and 30: quartiles at positions 2 and 6 of 0 ... 8; the fence is 7 + 1.5 * 4 = 13.
  const std::vector<double> values{30, 8, 1, 7, 2, 6, 3, 5, 4};
  const BoxNumbers box = box_numbers(values);
  EXPECT_DOUBLE_EQ(box.lower_quartile, 3.0);
  EXPECT_DOUBLE_EQ(box.median, 5.0);
  EXPECT_DOUBLE_EQ(box.upper_quartile, 7.0);
  EXPECT_DOUBLE_EQ(box.low_whisker, 1.0);
  EXPECT_DOUBLE_EQ(box.high_whisker, 8.0);
  EXPECT_THAT(box.outliers, ElementsAre(DoubleEq(30.0)));
  EXPECT_NEAR(box.mean, 66.0 / 9.0, 1e-14);
}

TEST(BoxNumbers, OfOneValueIsThatValue) {
  const std::vector<double> values{2.5};
  const BoxNumbers box = box_numbers(values);
  EXPECT_DOUBLE_EQ(box.low_whisker, 2.5);
  EXPECT_DOUBLE_EQ(box.median, 2.5);
  EXPECT_DOUBLE_EQ(box.high_whisker, 2.5);
  EXPECT_THROW(static_cast<void>(box_numbers({})), InvalidArgument);
}

TEST(BoxPlot, ShowsSignedAndAbsoluteErrorOfEachIncision) {
  const std::vector<ReportIncision> both{fixture().incision("Before", -0.5, 1.5),
                                         fixture().incision("After", 0.0, 0.4)};
  const std::string svg = box_plot_svg(both);
  expect_whole_svg(svg);
  EXPECT_THAT(svg, HasSubstr(">signed error, mm<"));
  EXPECT_THAT(svg, HasSubstr(">|error|, mm<"));
  EXPECT_EQ(texts_between(svg, ">Before<", "text>").size(), 2U);
}

TEST(CommonErrorLimit, CoversAllErrorsAndIsRound) {
  std::vector<ReportIncision> both{fixture().incision("Before", 0.0, 0.0), fixture().incision("After", 0.0, 0.0)};
  EXPECT_DOUBLE_EQ(common_error_limit_mm(both), 0.5);
  both[1].signed_error_mm[0] = -2.1;
  EXPECT_DOUBLE_EQ(common_error_limit_mm(both), 2.5);
}

TEST(Histogram, DrawsOneBarPerBinThatHoldsSomething) {
  const ReportHistogram histogram{.quantity = "dihedral angle", .unit = "°", .counts = {0, 10, 40, 0, 20, 0}};
  const std::string svg = histogram_svg(histogram);
  expect_whole_svg(svg);
  EXPECT_EQ(texts_between(svg, "fill=\"#5b7f95\"", ">").size(), 3U);
  EXPECT_THAT(svg, HasSubstr("dihedral angle, °"));
}

TEST(Histogram, RefusesNoBinsAndNegativeCounts) {
  EXPECT_THROW(static_cast<void>(histogram_svg({})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(histogram_svg({.counts = {1.0, -1.0}})), InvalidArgument);
}

ReplayPicture circle_picture() {
  ReplayPicture picture;
  for (int i = 0; i <= 5000; ++i) {
    const double angle = 2.0 * 3.14159265 * i / 5000.0;
    picture.tip_mm.emplace_back(15.0 * std::cos(angle), 15.0 * std::sin(angle), 100.0);
    picture.time_s.push_back(0.002 * i);
    picture.tip_speed_mm_s.push_back(7.0);
    picture.deviation_mm.push_back(0.01);
  }
  picture.intended_mm = picture.tip_mm;
  return picture;
}

TEST(ReplayFigure, ShowsPathSpeedAndDeviationWithUnits) {
  const std::string svg = replay_figure_svg(circle_picture());
  expect_whole_svg(svg);
  for (const char* text : {"5 mm", "tip speed, mm/s", "time, s", "deviation, mm", "path of the tip, mm"})
    EXPECT_THAT(svg, HasSubstr(std::string(">") + text + "<"));
  EXPECT_THAT(svg, HasSubstr("at most 0.01 mm off in the cut"));
  EXPECT_LT(svg.size(), 200000U);  // thinned out to what can be seen
}

TEST(ReplayFigure, RefusesTooLittleAndNumbersThatAreNotFinite) {
  ReplayPicture picture = circle_picture();
  picture.tip_speed_mm_s[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(replay_figure_svg(picture)), InvalidArgument);
  picture = circle_picture();
  picture.time_s.pop_back();
  EXPECT_THROW(static_cast<void>(replay_figure_svg(picture)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(replay_figure_svg({})), InvalidArgument);
}

}  // namespace
}  // namespace incise
