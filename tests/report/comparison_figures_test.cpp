#include "report/markup.hpp"
#include "report/plot.hpp"

#include <incise/core/error.hpp>
#include <incise/report/category_plot.hpp>
#include <incise/report/comparison_figures.hpp>
#include <incise/report/svg_png.hpp>

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>
#include <set>

namespace incise {
namespace {

using ::testing::HasSubstr;
using testing::nesting_problem;
using ::testing::Not;
using ::testing::StartsWith;
using testing::texts_between;

ErrorSeries series(const char* name, bool is_after, double offset) {
  ErrorSeries result{.name = name, .is_after = is_after, .signed_error_mm = {}, .clock_h = {}};
  for (int k = 0; k < 120; ++k) {
    result.clock_h.push_back(0.1 * k);
    result.signed_error_mm.push_back(offset + std::cos(0.1 * k));
  }
  return result;
}

const std::vector<ErrorSeries> kFour{series("s1", false, -1.5), series("s2", false, -1.0), series("s3", true, 0.2),
                                     series("s4", true, 0.0)};

void expect_whole(const std::string& svg) {
  EXPECT_THAT(svg, StartsWith("<svg xmlns="));
  EXPECT_EQ(nesting_problem(svg), "");
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(ComparisonBoxPlot, ShowsBothSidesEachSpecimenAndBothZonesInBothPanels) {
  const std::string svg = comparison_box_plot_svg(kFour);
  expect_whole(svg);
  for (const char* text : {"a) absolute", "before", "after", "s1", "s4", "|error|, mm", "signed error, mm", "too close",
                           "tumour edge reached", "in a): where the error is towards the tumour"}) {
    EXPECT_THAT(svg, HasSubstr(std::string(">") + text + "<"));
  }
  // A box for each of 2 sides and 4 incisions in 2 panels, each with its diamond.
  EXPECT_EQ(texts_between(svg, "<polygon points=\"", "\"").size(), 12U);
}

TEST(ComparisonBoxPlot, KeepsLongNamesWhole) {
  const char* name = "specimen_12_as_planned_by_the_surgeon";
  const std::string svg =
      comparison_box_plot_svg(std::vector<ErrorSeries>{series(name, false, 0.1), series("s2", true, 0.1)});
  expect_whole(svg);
  EXPECT_EQ(texts_between(svg, std::string(">") + name + "<", "text>").size(), 2U) << "in both panels";
  EXPECT_THAT(svg, HasSubstr("rotate(-35"));
  EXPECT_THAT(comparison_box_plot_svg(kFour), Not(HasSubstr("rotate(-35")));
}

TEST(ErrorByClock, KeepsTheNamesOfManyIncisionsInThePicture) {
  const auto names_at = [](std::size_t count) {
    std::vector<ErrorSeries> many;
    for (std::size_t k = 0; k < count; ++k) many.push_back(series("specimen_12", k % 2 == 1, 0.1));
    const std::string svg = error_by_clock_svg(many);
    expect_whole(svg);
    std::vector<std::pair<double, double>> places;
    const std::regex name(R"re(<text x="([\d.]+)" y="([\d.]+)"[^>]*>specimen_12<)re");
    for (std::sregex_iterator at(svg.begin(), svg.end(), name), end; at != end; ++at)
      places.emplace_back(std::stod((*at)[1]), std::stod((*at)[2]));
    return places;
  };
  EXPECT_EQ(names_at(3).back().second, names_at(3).front().second) << "few names stand in one row";
  const auto places = names_at(36);
  ASSERT_EQ(places.size(), 36U);
  for (std::size_t k = 0; k < places.size(); ++k) {
    EXPECT_LT(places[k].first + 11.0 * 7.0, 760.0);
    EXPECT_EQ(std::count(places.begin(), places.end(), places[k]), 1) << "none over another";
  }
}

TEST(ComparisonBoxPlot, ZonesLieWhereTheirBordersSay) {
  // The limit is 5 mm: 300 px show 10 mm with sign, so the zones meet 30 px a millimetre below the middle.
  const std::string svg = comparison_box_plot_svg(kFour);
  const double middle = 36.0 + 150.0;
  EXPECT_THAT(svg, HasSubstr("y=\"" + std::to_string(static_cast<int>(middle + 2.3 * 30.0)) + ".00\""));
  EXPECT_THAT(svg, HasSubstr("y=\"" + std::to_string(static_cast<int>(middle + 4.5 * 30.0)) + ".00\""));
}

TEST(ComparisonBoxPlot, NamesItsZonesBeneathTheBoxesAndNotOnThem) {
  const std::string svg = comparison_box_plot_svg(kFour);
  const double lowest = 36.0 + 300.0;  // of the panels
  for (const char* name : {"too close", "tumour edge reached"}) {
    const std::size_t end = svg.find(std::string(">") + name + "<");
    const std::size_t begin = svg.rfind("<text", end);
    ASSERT_NE(end, std::string::npos) << name;
    EXPECT_EQ(svg.find(std::string(">") + name + "<", end + 1), std::string::npos) << name << ": more than once";
    const std::vector<std::string> y = texts_between(svg.substr(begin, end - begin), " y=\"", "\"");
    ASSERT_EQ(y.size(), 1U);
    EXPECT_GT(std::stod(y.front()), lowest) << name;
  }
}

TEST(ErrorByClock, GoesFromTwelveToTwelveAndLeavesGapsOpen) {
  EXPECT_EQ(texts_between(error_by_clock_svg(kFour), "<polyline", "/>").size(), 4U);
  ErrorSeries gap = series("gap", true, 0.0);
  gap.clock_h.erase(gap.clock_h.begin() + 40, gap.clock_h.begin() + 60);
  gap.signed_error_mm.erase(gap.signed_error_mm.begin() + 40, gap.signed_error_mm.begin() + 60);
  const std::string svg = error_by_clock_svg({&gap, 1});
  expect_whole(svg);
  EXPECT_EQ(texts_between(svg, "<polyline", "/>").size(), 2U);
  EXPECT_EQ(texts_between(svg, "text-anchor=\"middle\" >12<", "/text>").size(), 2U);
}

TEST(ErrorByClock, DrawsFourIncisionsAfterInFourShadesOfBlue) {
  const std::string svg = error_by_clock_svg(std::vector<ErrorSeries>{
      series("s1", true, 0.0), series("s2", true, 0.1), series("s3", true, 0.2), series("s4", true, 0.3)});
  std::set<std::string> shades;
  for (const std::string& line : texts_between(svg, "<polyline", "/>")) {
    const std::string shade = line.substr(line.find("stroke=\"#") + 8, 7);
    shades.insert(shade);
    const int red = std::stoi(shade.substr(1, 2), nullptr, 16), green = std::stoi(shade.substr(3, 2), nullptr, 16),
              blue = std::stoi(shade.substr(5, 2), nullptr, 16);
    EXPECT_LT(red, green) << shade;
    EXPECT_LT(green, blue) << shade;
  }
  EXPECT_EQ(shades.size(), 4U);
  EXPECT_EQ(shades.count(std::string(ink::kTumorEdge)), 0U);
}

TEST(ComparisonFigures, RefuseWhatCannotBeDrawn) {
  EXPECT_THROW(static_cast<void>(comparison_box_plot_svg({})), InvalidArgument);
  ErrorSeries broken = series("broken", false, 0.0);
  broken.signed_error_mm[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(comparison_box_plot_svg({&broken, 1})), InvalidArgument);
  ErrorSeries open = series("open", false, 0.0);
  open.clock_h.clear();
  EXPECT_THROW(static_cast<void>(error_by_clock_svg({&open, 1})), InvalidArgument);
}

/// Big-endian number in a PNG's header.
int header_number(const std::string& png, std::size_t at) {
  int value = 0;
  for (std::size_t k = 0; k < 4; ++k) value = 256 * value + static_cast<unsigned char>(png[at + k]);
  return value;
}

TEST(PngOfSvg, HasTheFiguresSizeTimesTheScale) {
  const std::string svg = error_by_clock_svg(kFour);  // 760 x 420
  const std::string png = png_of_svg(svg, 1.5);
  EXPECT_THAT(png, StartsWith("\x89PNG\r\n\x1a\n"));
  EXPECT_EQ(header_number(png, 16), 1140);
  EXPECT_EQ(header_number(png, 20), 630);
  EXPECT_GT(png.size(), 10'000U);  // more than white
}

TEST(PngOfSvg, RefusesWhatIsNoFigure) {
  EXPECT_THROW(static_cast<void>(png_of_svg("no figure")), Error);
  EXPECT_THROW(static_cast<void>(png_of_svg("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"10\"")), Error);
  EXPECT_THROW(static_cast<void>(png_of_svg(error_by_clock_svg(kFour), 0.0)), InvalidArgument);
}

CategoryPlot two_panels() {
  return {.title = "effects",
          .categories = {"drift", "wander", "idle"},
          .panels = {{"moved, mm",
                      {{.name = "mean", .values = {0.1, 0.2, 0.0}, .chance = 0.05},
                       {.name = "shift", .values = {0.6, 0.1, 0.1}}}},
                     {"change, mm",
                      {{.name = "", .values = {0.0, 0.3, -0.1}, .low = {-0.1, 0.2, -0.2}, .high = {0.1, 0.4, 0.0}}}}}};
}

TEST(CategoryPlot, ShowsEachCategoryOnceAndAMarkForEachValue) {
  const std::string svg = category_plot_svg(two_panels());
  expect_whole(svg);
  for (const char* text : {"drift", "wander", "idle", "mean", "shift", "moved, mm", "change, mm"})
    EXPECT_THAT(svg, HasSubstr(std::string(">") + text + "<"));
  EXPECT_EQ(texts_between(svg, "<circle", "/>").size(), 9U + 2U) << "marks, and those of the legend";
  EXPECT_EQ(texts_between(svg, "stroke-dasharray=\"4 3\"", ">").size(), 1U) << "chance";
}

TEST(CategoryPlot, RefusesWhatItCannotDraw) {
  CategoryPlot plot = two_panels();
  plot.panels[0].series[0].values.pop_back();
  EXPECT_THROW((void)category_plot_svg(plot), InvalidArgument);
  plot = two_panels();
  plot.panels[1].series[0].low.pop_back();
  EXPECT_THROW((void)category_plot_svg(plot), InvalidArgument);
  plot = two_panels();
  plot.panels[0].series[1].values[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)category_plot_svg(plot), InvalidArgument);
  plot = two_panels();
  plot.categories.clear();
  EXPECT_THROW((void)category_plot_svg(plot), InvalidArgument);
}

}  // namespace
}  // namespace incise
