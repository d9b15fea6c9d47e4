// One photograph after another with something about it that makes lines hard to see; each is held against the bars.
#include "photo_scene.hpp"

#include <incise/core/error.hpp>
#include <incise/core/random.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <functional>
#include <string>

namespace incise {
namespace {

using namespace photo_scene;

struct Condition {
  std::string name;
  std::function<void(Scene&)> apply;
  double thinnest_px = 2.0;  ///< thinner lines are measured just as well, or said not to be seen
};

void PrintTo(const Condition& condition, std::ostream* out) {
  *out << condition.name;
}

/// Every condition with thin and thick lines and with painted kerfs.
class PhotoOf : public ::testing::TestWithParam<Condition> {};

TEST_P(PhotoOf, IsMeasuredWithinTheBars) {
  struct Kind {
    double width_px;
    bool is_kerf;
  };
  std::uint64_t seed = 1;
  for (const auto [width_px, is_kerf] : {Kind{2, false}, Kind{6, false}, Kind{60, true}}) {
    SCOPED_TRACE(fmt::format("{} of {} pixels, seed {}", is_kerf ? "kerf" : "line", width_px, seed));
    Scene truth = scene(width_px, is_kerf, seed++);
    GetParam().apply(truth);
    expect_measured(truth, width_px < GetParam().thinnest_px);
  }
}

/// A burnt rim, outside of the red line, as wide as an electrode and its heat leave it.
void char_beside(Scene& s, const Rgb& color) {
  if (s.red == RedLine::Kerf) return;
  PaintedLine kerf{.course = s.incision, .width_mm = 1.0, .color = color, .is_outside = true};
  s.photo.lines.insert(s.photo.lines.begin(), kerf);
}

/// Burnt spots on the painted band itself, each 0.7 mm long, over its whole width.
void char_upon(Scene& s) {
  if (s.red != RedLine::Kerf) return;
  PaintedLine spots = s.photo.lines.back();
  spots.color = {52, 34, 28};
  constexpr double kSpotMm = 0.7;
  constexpr int kSpots = 6;
  const double apart = length_mm(s.incision) / kSpots;
  for (int i = 0; i < kSpots; ++i) spots.gaps_mm.emplace_back(i * apart + kSpotMm, apart - kSpotMm);
  s.photo.lines.push_back(spots);
}

void on_paper(Scene& s) {
  const double beyond = 2.5 + (s.red == RedLine::Kerf ? s.photo.lines.back().width_mm : 0.0);
  s.photo.specimen = outer_offset(s.incision, beyond, -Vec3::UnitZ());
}

void inks(Scene& s, const Rgb& red, const Rgb& green) {
  s.photo.lines.front().color = green;
  s.photo.lines.back().color = red;
}

INSTANTIATE_TEST_SUITE_P(FindPhotoContours, PhotoOf,
                         ::testing::Values(Condition{"RedTissue",
                                                     [](Scene& s) {
                                                       s.photo.tissue = {170, 70, 65};
                                                     },
                                                     4},
                                           Condition{"PaleTissue",
                                                     [](Scene& s) {
                                                       s.photo.tissue = {215, 170, 160};
                                                     }},
                                           Condition{"MottledTissue", [](Scene& s) { s.photo.mottle = 0.2; }, 4},
                                           Condition{"StrongShading", [](Scene& s) { s.photo.shading = 0.6; }},
                                           Condition{"Noise", [](Scene& s) { s.photo.noise = 8.0; }},
                                           Condition{"NoBlur", [](Scene& s) { s.photo.blur_px = 0.4; }},
                                           Condition{"MuchBlur", [](Scene& s) { s.photo.blur_px = 2.0; }, 4},
                                           Condition{"WhitePaper", on_paper},
                                           Condition{"BlackCloth",
                                                     [](Scene& s) {
                                                       on_paper(s);
                                                       s.photo.sheet = {22, 22, 24};
                                                     }},
                                           Condition{"BlueDrape",
                                                     [](Scene& s) {
                                                       on_paper(s);
                                                       s.photo.sheet = {60, 110, 190};
                                                     }},
                                           Condition{"BrownKerf",
                                                     [](Scene& s) {
                                                       char_beside(s, {101, 67, 33});
                                                     }},
                                           Condition{"CharredKerf",
                                                     [](Scene& s) {
                                                       char_beside(s, {48, 33, 28});
                                                     }},
                                           Condition{"CharredSpots", char_upon},
                                           Condition{"DarkRedAndLimeInk",
                                                     [](Scene& s) {
                                                       inks(s, {150, 30, 30}, {0, 220, 0});
                                                     },
                                                     4},
                                           Condition{"LightRedAndDarkGreenInk",
                                                     [](Scene& s) {
                                                       inks(s, {255, 80, 80}, {20, 90, 40});
                                                     },
                                                     5},
                                           Condition{"CrimsonAndYellowGreenInk",
                                                     [](Scene& s) {
                                                       inks(s, {200, 20, 80}, {130, 200, 60});
                                                     }},
                                           Condition{"OrangeRedAndTealInk",
                                                     [](Scene& s) {
                                                       inks(s, {235, 70, 20}, {0, 160, 120});
                                                     }}),
                         [](const auto& condition) { return condition.param.name; });

/// A highlight hides what lies under it. Small ones are bridged; where two run into one that hides more than the
/// largest gap, the ring may be open or not: that is said, with its reason, and no third thing happens.
TEST(FindPhotoContours, ManyHighlightsAreBridgedOrNamed) {
  int measured = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    Scene truth = scene(5, false, seed);
    truth.photo.glare_spots = 24;
    try {
      const PhotoContours found = found_in(truth);
      EXPECT_LT(mean_error(found.tumor_edge, truth.tumor), kContourMm);
      EXPECT_LT(mean_error(found.incision, truth.incision), kContourMm);
      if (found.incision.is_closed) {
        expect_same_measures(found, truth);
        ++measured;
      } else {
        EXPECT_TRUE(found.red.gaps.at(0).is_glare);
      }
    } catch (const DataError& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("A highlight hides it"));
    }
  }
  EXPECT_GE(measured, 3);
}

/// Openings of any place and width beyond the largest gap, in lines of any width, with highlights about them.
TEST(FindPhotoContours, NoTrueOpeningIsEverCalledClosed) {
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    Random random(seed);
    const bool is_kerf = seed % 3 == 0;
    const double width_px = is_kerf ? random.uniform(30.0, 100.0) : random.uniform(2.0, 12.0);
    const double gap_mm = random.uniform(1.35, 4.0);
    SCOPED_TRACE(fmt::format("seed {}: {} of {:.0f} px, opening of {:.2f} mm", seed, is_kerf ? "kerf" : "line",
                             width_px, gap_mm));
    Scene truth = scene(width_px, is_kerf, seed);
    truth.photo.lines[1].gaps_mm = {{random.uniform(0.0, length_mm(truth.incision) - gap_mm), gap_mm}};
    const PhotoContours found = found_in(truth);
    EXPECT_FALSE(found.incision.is_closed);
    EXPECT_GE(found.red.max_gap_mm(), gap_mm - 0.2);
    EXPECT_LT(mean_error(found.incision, truth.incision), kContourMm);
  }
}

}  // namespace
}  // namespace incise
