// Rulers of many kinds, sound and misleading: which are measured, and which are found out.
#include "photo_scene.hpp"
#include "warped_photo.hpp"

#include <incise/core/random.hpp>
#include <incise/core/verdict.hpp>
#include <incise/imaging/photo_doubts.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <map>
#include <numbers>
#include <optional>

namespace incise {
namespace {

using ::testing::HasSubstr;
using testing::PaintedLine;
using testing::PaintedPhoto;

constexpr double kInchMm = 25.4;
const int kRulers = photo_scene::photo_cases(8);  // of each kind

/// One edge of a ruler.
struct Scale {
  double step_mm = 1.0;
  double from_mm = 1.0;
  double to_mm = 19.0;
  bool is_far_edge = false;
  double tick_mm = 0.0;       ///< 0: the ruler's
  double second_grey = 25.0;  ///< of every second tick
  double second_share = 1.0;  ///< length of every second tick
};

struct DrawnRuler {
  Vec2 corner{4.0, 5.0};  ///< mm
  double angle = 0.0;
  double length_mm = 20.0;
  double width_mm = 6.0;
  double tick_mm = 1.8;   ///< length of a short tick
  double line_mm = 0.15;  ///< width
  std::vector<Scale> scales{{}};
};

void draw(PaintedPhoto& photo, const DrawnRuler& ruler) {
  const Vec3 along(std::cos(ruler.angle), std::sin(ruler.angle), 0.0), across(-along.y(), along.x(), 0.0);
  const Vec3 corner(ruler.corner.x(), ruler.corner.y(), 0.0);
  photo.lines.push_back({.course = {{corner, corner + ruler.length_mm * along}, false},
                         .width_mm = ruler.width_mm,
                         .color = {235, 235, 230}});
  for (const Scale& scale : ruler.scales) {
    const double side = scale.is_far_edge ? 1.0 : -1.0;
    const int count = static_cast<int>(std::floor((scale.to_mm - scale.from_mm) / scale.step_mm + 1e-6));
    for (int i = 0; i <= count; ++i) {
      const Vec3 foot =
          corner + (scale.from_mm + i * scale.step_mm) * along + side * (0.5 * ruler.width_mm - 0.2) * across;
      const bool is_scale_of_halves = scale.second_share < 1.0;
      const int whole = is_scale_of_halves ? i / 2 : i;
      const double share = is_scale_of_halves && i % 2 == 1 ? scale.second_share
                           : whole % 10 == 0                ? 1.6
                           : whole % 5 == 0                 ? 1.3
                                                            : 1.0;
      const double length = (scale.tick_mm > 0.0 ? scale.tick_mm : ruler.tick_mm) * share;
      const double grey = i % 2 == 1 ? scale.second_grey : 25.0;
      photo.lines.push_back({.course = {{foot, foot - side * length * across}, false},
                             .width_mm = ruler.line_mm,
                             .color = {grey, grey, grey + 3.0}});
    }
  }
}

PaintedPhoto empty_photo() {
  PaintedPhoto photo;
  photo.width = photo.height = 900;
  photo.glare_spots = 4;
  return photo;
}

/// Anything that a sound photograph of a ruler may be like.
struct Drawn {
  PaintedPhoto photo;
  DrawnRuler ruler;
};
Drawn random_drawing(Random& random) {
  Drawn drawn{empty_photo(), {}};
  drawn.photo.seed = static_cast<std::uint64_t>(random.uniform(1.0, 1e9));
  drawn.photo.mm_per_pixel = random.uniform(0.024, 0.05);
  drawn.photo.noise = random.uniform(1.0, 8.0);
  drawn.photo.blur_px = random.uniform(0.5, 1.5);
  drawn.photo.shading = random.uniform(0.0, 0.5);
  const double side = drawn.photo.width * drawn.photo.mm_per_pixel;
  DrawnRuler& ruler = drawn.ruler;
  ruler.angle = random.uniform(-std::numbers::pi, std::numbers::pi);
  ruler.length_mm = random.uniform(0.65, 0.85) * side;
  ruler.tick_mm = random.uniform(1.3, 2.2);
  ruler.line_mm = random.uniform(0.13, 0.2);
  ruler.scales.front().to_mm = ruler.length_mm - 1.0;
  // Anywhere within the picture.
  const Vec2 half = 0.5 * ruler.length_mm * Vec2(std::cos(ruler.angle), std::sin(ruler.angle));
  const Vec2 room = Vec2::Constant(0.5 * side - 0.5 * ruler.width_mm) - half.cwiseAbs();
  const Vec2 middle = Vec2::Constant(0.5 * side) + Vec2(random.uniform(-1.0, 1.0) * std::max(0.0, room.x()),
                                                        random.uniform(-1.0, 1.0) * std::max(0.0, room.y()));
  ruler.corner = middle - half;
  return drawn;
}

ColorPicture photographed(const Drawn& drawn) {
  PaintedPhoto photo = drawn.photo;
  draw(photo, drawn.ruler);
  return testing::paint_photo(photo);
}

ColorPicture through_jpeg(const ColorPicture& picture) {
  return decode_picture(testing::encode_jpeg(picture, 80), "ruler.jpg");
}

/// What is said of a picture: "ok", "refused", or the worst reason's id.
struct Said {
  std::string what;
  std::string message;
  double mm_per_pixel = 0.0;
};
Said said_of(const ColorPicture& picture, RulerKind kind = RulerKind::Ticks, std::optional<double> length_mm = 1.0) {
  try {
    const Ruler ruler = find_ruler(through_jpeg(picture), kind, length_mm, "ruler.jpg");
    Verdict verdict;
    add_ruler_doubts(ruler, verdict);
    if (verdict.reasons().empty()) return {"ok", "", ruler.mm_per_pixel};
    return {verdict.reasons().front().id, verdict.reasons().front().message, ruler.mm_per_pixel};
  } catch (const DataError& error) {
    return {"refused", error.what(), 0.0};
  }
}

/// Counts what is said of many pictures of one kind and keeps an example of each.
class Counts {
 public:
  void add(const Said& said) {
    ++counts_[said.what];
    examples_[said.what] = said.message;
  }
  [[nodiscard]] int of(const std::string& what) const { return counts_.contains(what) ? counts_.at(what) : 0; }
  [[nodiscard]] std::string text() const {
    std::string text;
    for (const auto& [what, count] : counts_) text += fmt::format("{} {} ({})\n", count, what, examples_.at(what));
    return text;
  }

 private:
  std::map<std::string, int> counts_;
  std::map<std::string, std::string> examples_;
};

/// Nearly all are found out; the long form prints how many.
void expect_found_out(const char* kind, const Counts& counts, double least_share) {
  if (kRulers > 50) fmt::print("{}:\n{}", kind, counts.text());
  EXPECT_LE(counts.of("ok"), (1.0 - least_share) * kRulers) << counts.text();
}

TEST(RandomRuler, SoundOnesAreMeasured) {
  Random random(1);
  Counts counts;
  for (int i = 0; i < kRulers; ++i) {
    const Drawn drawn = random_drawing(random);
    Said said = said_of(photographed(drawn), RulerKind::Ticks, {});
    if (said.what == "ok" && std::abs(said.mm_per_pixel / drawn.photo.mm_per_pixel - 1.0) > 0.005) {
      said = {"wrong", fmt::format("{} for {}", said.mm_per_pixel, drawn.photo.mm_per_pixel)};
    }
    counts.add(said);
  }
  if (kRulers > 50) fmt::print("sound:\n{}", counts.text());
  EXPECT_GE(counts.of("ok"), 0.99 * kRulers) << counts.text();
}

/// What is said of many random rulers, each changed first. @param change  of (drawn, random, number of the ruler)
template <class Change>
Counts said_of_changed(std::uint64_t seed, const Change& change, std::optional<double> length_mm = 1.0) {
  Random random(seed);
  Counts counts;
  for (int i = 0; i < kRulers; ++i) {
    Drawn drawn = random_drawing(random);
    change(drawn, random, i);
    counts.add(said_of(photographed(drawn), RulerKind::Ticks, length_mm));
  }
  return counts;
}

TEST(RandomRuler, AnotherUnitOnTheOtherEdgeIsFoundOut) {
  const auto change = [](Drawn& drawn, Random&, int i) {
    Scale other = drawn.ruler.scales.front();
    other.step_mm = i % 2 == 0 ? 0.5 : kInchMm / 32.0;
    other.is_far_edge = true;
    drawn.ruler.scales.push_back(other);
  };
  expect_found_out("other unit on the other edge", said_of_changed(2, change), 0.98);
}

TEST(RandomRuler, HalfMillimetresAlongAPartAreFoundOut) {
  const auto change = [](Drawn& drawn, Random& random, int) {
    Scale& scale = drawn.ruler.scales.front();
    Scale fine = scale;
    fine.step_mm = 0.5;
    const double share = random.uniform(0.3, 0.7);
    fine.to_mm = scale.from_mm = fine.from_mm + std::round(share * (scale.to_mm - fine.from_mm));
    drawn.ruler.scales.push_back(fine);
  };
  expect_found_out("half millimetres along a part", said_of_changed(3, change), 0.98);
}

TEST(RandomRuler, ASecondRulerOfAnotherUnitIsFoundOut) {
  Random random(4);
  Counts counts;
  for (int i = 0; i < kRulers; ++i) {
    Drawn drawn = random_drawing(random);
    const double side = drawn.photo.width * drawn.photo.mm_per_pixel;
    DrawnRuler& first = drawn.ruler;
    first.angle = random.uniform(-0.1, 0.1);
    first.corner = {0.1 * side, 0.25 * side};
    DrawnRuler second = first;
    second.angle = random.uniform(-0.3, 0.1);
    second.corner = {0.1 * side, 0.8 * side};
    const std::array<double, 4> steps{0.5, kInchMm / 32.0, kInchMm / 16.0, 2.0};
    second.scales.front().step_mm = steps[static_cast<std::size_t>(i) % steps.size()];
    draw(drawn.photo, second);
    counts.add(said_of(photographed(drawn)));
  }
  expect_found_out("a second ruler", counts, 0.98);
}

TEST(RandomRuler, AnObliqueViewIsFoundOut) {
  Random random(5);
  Counts counts;
  for (int i = 0; i < kRulers; ++i) {
    const Drawn drawn = random_drawing(random);
    const testing::TiltedCamera camera{.tilt_rad = random.uniform(30.0, 45.0) * std::numbers::pi / 180.0,
                                       .azimuth_rad = random.uniform(0.0, 2.0 * std::numbers::pi),
                                       .distance_mm = random.uniform(200.0, 350.0)};
    counts.add(said_of(testing::seen_obliquely(photographed(drawn), camera, drawn.photo.mm_per_pixel)));
  }
  expect_found_out("oblique by 30 to 45 degrees", counts, 0.9);
}

TEST(RandomRuler, AnUncorrectedLensIsFoundOut) {
  Random random(6);
  Counts counts;
  for (int i = 0; i < kRulers; ++i) {
    const Drawn drawn = random_drawing(random);
    counts.add(said_of(testing::through_barrel(photographed(drawn), random.uniform(0.08, 0.2))));
  }
  expect_found_out("barrel of 8 to 20 % at the corner", counts, 0.9);
}

TEST(RandomRuler, ABarIsNotLookedForAmongTicks) {
  Random random(7);
  Counts counts;
  for (int i = 0; i < kRulers; ++i) {
    counts.add(said_of(photographed(random_drawing(random)), RulerKind::Bar, 5.0));
  }
  expect_found_out("ticks taken for a bar", counts, 1.0);
}

TEST(RandomRuler, HalfMillimetresTooShortToBeStrokesAreFoundOut) {
  const auto change = [](Drawn& drawn, Random& random, int) {
    Scale halves = drawn.ruler.scales.front();
    halves.from_mm += 0.5;
    halves.tick_mm = random.uniform(0.3, 0.5);
    drawn.ruler.scales.push_back(halves);
  };
  expect_found_out("half millimetres as short stubs", said_of_changed(8, change, {}), 0.98);
}

TEST(RandomRuler, FaintHalfMillimetresAreFoundOut) {
  const auto change = [](Drawn& drawn, Random& random, int) {
    Scale& scale = drawn.ruler.scales.front();
    scale.step_mm = 0.5;
    scale.second_grey = random.uniform(170.0, 200.0);
    drawn.ruler.line_mm = std::min(drawn.ruler.line_mm, 0.14);
  };
  expect_found_out("every second tick faint", said_of_changed(9, change, 0.5), 0.98);
}

TEST(RandomRuler, HalfMillimetresOfTwoLengthsAskForTheirDistance) {
  Random random(10);
  Counts counts, told;
  for (int i = 0; i < kRulers; ++i) {
    Drawn drawn = random_drawing(random);
    drawn.ruler.scales.front().step_mm = 0.5;
    drawn.ruler.scales.front().second_share = random.uniform(0.55, 0.75);
    drawn.ruler.line_mm = std::min(drawn.ruler.line_mm, 0.14);
    const ColorPicture picture = photographed(drawn);
    counts.add(said_of(picture, RulerKind::Ticks, {}));
    told.add(said_of(picture, RulerKind::Ticks, 0.5));
  }
  expect_found_out("half millimetres of two lengths", counts, 0.98);
  EXPECT_GE(told.of("ok"), 0.98 * kRulers) << told.text();
}

TEST(FindRuler, TakesASecondRulerAcrossForATest) {
  Drawn drawn{empty_photo(), {}};
  DrawnRuler across = drawn.ruler;
  drawn.ruler.corner = {2.0, 4.0};
  across.corner = {23.0, 2.0};
  across.angle = 0.5 * std::numbers::pi;
  draw(drawn.photo, across);
  const ColorPicture straight = photographed(drawn);
  EXPECT_EQ(said_of(straight).what, "ok") << said_of(straight).message;
  // Far away and leaning along one of the two: that one's spacing shrinks by a fifth, and nothing else changes.
  const testing::TiltedCamera camera{
      .tilt_rad = 35.0 * std::numbers::pi / 180.0, .azimuth_rad = 0.0, .distance_mm = 5000.0};
  const Said said = said_of(testing::seen_obliquely(straight, camera, drawn.photo.mm_per_pixel));
  EXPECT_EQ(said.what, "refused");
  EXPECT_THAT(said.message, HasSubstr("ticks of two spacings"));
}

TEST(FindRuler, NamesBothSpacingsOfARulerWithTwo) {
  Drawn drawn{empty_photo(), {}};
  drawn.ruler.scales.push_back({.step_mm = 0.5, .is_far_edge = true});
  const Said said = said_of(photographed(drawn));
  EXPECT_EQ(said.what, "refused");
  EXPECT_THAT(said.message, HasSubstr("ticks of two spacings"));
  EXPECT_THAT(said.message, ::testing::ContainsRegex(" 16\\.[67][0-9] pixels apart"));
  EXPECT_THAT(said.message, ::testing::ContainsRegex(" 33\\.[23][0-9] pixels apart"));
}

TEST(FindRuler, TakesTheSameUnitOnBothEdges) {
  Drawn drawn{empty_photo(), {}};
  drawn.ruler.scales.push_back({.step_mm = 1.0, .from_mm = 1.4, .is_far_edge = true});
  const Said said = said_of(photographed(drawn));
  EXPECT_EQ(said.what, "ok") << said.message;
  EXPECT_NEAR(said.mm_per_pixel / 0.03, 1.0, 0.002);
}

TEST(FindRuler, TakesNoTickAndNoRulersBodyForABar) {
  const Said said = said_of(photographed({empty_photo(), {}}), RulerKind::Bar, 5.0);
  EXPECT_EQ(said.what, "refused");
  EXPECT_THAT(said.message, HasSubstr("a ruler's ticks"));
}

}  // namespace
}  // namespace incise
