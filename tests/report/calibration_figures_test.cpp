#include "report/markup.hpp"

#include <incise/core/error.hpp>
#include <incise/report/calibration_figures.hpp>

#include <gmock/gmock.h>

#include <limits>

namespace incise {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

ScoreGrid small_grid() {
  ScoreGrid grid;
  grid.speeds_mm_s = {1.0, 17.0};
  grid.dullnesses = {5.0, 9.0};
  grid.cells = {{false, 80.4, -0.14}, {false, 81.2, -0.15}, {false, 103.6, -1.44}, {true, 0.0, std::nullopt}};
  grid.chosen = 2;
  return grid;
}

TEST(ScoreHeatMap, SaysEveryCellsNumberHatchesFailuresAndFramesTheChosenOne) {
  const std::string svg = score_heat_map_svg(small_grid());
  EXPECT_EQ(testing::nesting_problem(svg), "");
  for (const char* text : {">80.4<", ">103.6<", ">−1.44<", ">failure<", ">dullness<", ">mm/s<"}) {
    const std::string plain = std::string(text) == ">−1.44<" ? ">-1.44<" : text;
    EXPECT_THAT(svg, ::testing::AnyOf(HasSubstr(text), HasSubstr(plain))) << text;
  }
  const auto count = [&svg](const std::string& what) { return testing::texts_between(svg, what, ">").size(); };
  EXPECT_EQ(count("stroke=\"#d55e00\" stroke-width=\"3\""), 2U);  // the chosen one, in both maps
  EXPECT_EQ(testing::texts_between(svg, ">failur", "<").size(), 2U);
  EXPECT_THAT(svg, Not(HasSubstr("virtual")));
  ScoreGrid made_up = small_grid();
  made_up.is_virtual = true;
  EXPECT_THAT(score_heat_map_svg(made_up), HasSubstr("virtual specimens"));
}

TEST(ScoreHeatMap, RefusesAGridWithHolesAndNumbersThatAreNotFinite) {
  ScoreGrid grid = small_grid();
  grid.cells.pop_back();
  EXPECT_THROW(static_cast<void>(score_heat_map_svg(grid)), InvalidArgument);
  grid = small_grid();
  grid.cells[0].score_percent = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(score_heat_map_svg(grid)), InvalidArgument);
  grid = small_grid();
  grid.speeds_mm_s[1] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(static_cast<void>(score_heat_map_svg(grid)), InvalidArgument);
  grid = small_grid();
  grid.dullnesses[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(score_heat_map_svg(grid)), InvalidArgument);
}

TEST(DragFitFigure, ShowsEverySpecimenAndEveryMarginal) {
  const ProfileCurves first{"tongue 1", {-1.0, -1.5, -2.0, -1.5}, {-1.1, -1.4, -1.9, -1.6}, {-1.0, -1.4, -1.8, -1.6}};
  ProfileCurves open = first;
  open.name = "tongue <2>";
  open.simulated_mm.clear();
  const MarginalCurve marginal{"drag length, mm", {1.0, 2.0, 3.0}, {0.1, 0.8, 0.1}, 1.2, 2.8};
  const std::string svg = drag_fit_svg({first, open}, {marginal}, true);
  EXPECT_EQ(testing::nesting_problem(svg), "");
  for (const char* text : {"tongue 1", "tongue &lt;2&gt;", "drag length, mm", "virtual specimens", "photographed"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
  EXPECT_EQ(testing::texts_between(svg, "<polyline", ">").size(), 6U);  // three and two curves, and the marginal
  ProfileCurves bad = first;
  bad.fitted_mm.pop_back();
  EXPECT_THROW(static_cast<void>(drag_fit_svg({bad}, {marginal}, false)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(drag_fit_svg({}, {marginal}, false)), InvalidArgument);
}

}  // namespace
}  // namespace incise
