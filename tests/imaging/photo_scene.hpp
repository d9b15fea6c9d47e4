#pragma once

#include "support/contour_shapes.hpp"
#include "support/encode_jpeg.hpp"
#include "support/photo_painter.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/evaluation/evaluation.hpp>
#include <incise/evaluation/level_loop.hpp>
#include <incise/imaging/photo_contours.hpp>
#include <incise/io/picture_io.hpp>

#include <gtest/gtest.h>

#include <cstdlib>

namespace incise::photo_scene {

using testing::PaintedLine;
using testing::PaintedPhoto;
using testing::Rgb;

inline constexpr double kScale = 0.03;      // mm per pixel, as the paper's photographs
inline constexpr double kContourMm = 0.03;  // the bar: mean absolute error of a contour
inline constexpr double kMeasureMm = 0.02;  // of a measure in mm
inline constexpr double kHu = 0.01;         // of a Hu score
inline const char* const kName = "photo.jpg";

/// Number of random pictures of each kind: INCISE_PHOTO_CASES, which asks for the long form, else `unless_asked`.
inline int photo_cases(int unless_asked) {
  const char* const asked = std::getenv("INCISE_PHOTO_CASES");
  return asked == nullptr ? unless_asked : std::atoi(asked);
}

/// A tumour of 12 mm with its incision 4.5 mm outside, moved a little, as a photograph with everything that photographs
/// suffer from.
struct Scene {
  PaintedPhoto photo;  ///< lines: green, red
  Contour tumor;
  Contour incision;
  RedLine red = RedLine::Annotation;
};

inline Scene scene(double width_px, bool is_kerf, std::uint64_t seed = 1) {
  Scene s{.red = is_kerf ? RedLine::Kerf : RedLine::Annotation};
  s.photo.width = s.photo.height = 1000;
  s.photo.mm_per_pixel = kScale;
  s.photo.seed = seed;
  s.photo.glare_spots = 10;
  const Vec3 middle(15.0, 15.0, 0.0);
  s.tumor = testing::moved(testing::irregular_tumor(720), 0.4 * static_cast<double>(seed), 0.6, middle);
  s.incision = testing::moved(outer_offset(s.tumor, 4.5, -Vec3::UnitZ()), 0.0, 1.0, Vec3(0.4, -0.3, 0.0));
  const PaintedLine green{.course = s.tumor, .width_mm = (is_kerf ? 5.0 : width_px) * kScale};
  const PaintedLine red{.course = s.incision,
                        .width_mm = width_px * kScale,
                        .color = seed % 2 == 1 ? Rgb{205, 20, 35} : Rgb{225, 45, 20},
                        .is_outside = is_kerf};
  s.photo.lines = {green, red};
  return s;
}

/// Through JPEG at quality 70, as a camera would deliver it.
inline ColorPicture photographed(const Scene& s) {
  return decode_picture(testing::encode_jpeg(testing::paint_photo(s.photo), 70), kName);
}

inline PhotoContours found_in(const ColorPicture& picture, RedLine red = RedLine::Annotation) {
  return find_photo_contours(picture, scale_from_mm_per_pixel(kScale, picture.height), {.red = red}, kName);
}

inline PhotoContours found_in(const Scene& s) {
  return found_in(photographed(s), s.red);
}

/// What the refusal of a scene says.
inline std::string refusal(const Scene& s, double mm_per_pixel = kScale) {
  const ColorPicture picture = photographed(s);
  return testing::refusal_of<DataError>([&] {
    return find_photo_contours(picture, scale_from_mm_per_pixel(mm_per_pixel, picture.height), {.red = s.red}, kName);
  });
}

inline double mean_error(const Contour& found, const Contour& truth) {
  double sum = 0.0;
  const Contour even = resample(found, 600);
  for (const Vec3& p : even.points) sum += nearest_on(truth, p).distance_mm;
  return sum / 600.0;
}

/// Ways round both: a contour that is right but covers half the ring would otherwise pass.
inline void expect_contour(const Contour& found, const Contour& truth) {
  EXPECT_TRUE(found.is_closed);
  EXPECT_LT(mean_error(found, truth), kContourMm);
  EXPECT_LT(mean_error(truth, found), kContourMm);
}

inline void expect_same_measures(const PhotoContours& found, const Scene& truth) {
  EvaluationSettings settings{.contour = ContourKind::InnerEdge};
  const Evaluation seen = evaluate(found.incision, found.tumor_edge, settings);
  const Evaluation real = evaluate(truth.incision, truth.tumor, settings);
  EXPECT_EQ(seen.outcome, real.outcome);
  EXPECT_NEAR(seen.abs_error_mm->mean, real.abs_error_mm->mean, kMeasureMm);
  EXPECT_NEAR(seen.abs_error_mm->sd, real.abs_error_mm->sd, kMeasureMm);
  EXPECT_NEAR(seen.signed_error_mm->mean, real.signed_error_mm->mean, kMeasureMm);
  EXPECT_NEAR(*seen.centroid_shift_mm, *real.centroid_shift_mm, kMeasureMm);
  if (!seen.hu_unstable && !real.hu_unstable) {
    EXPECT_NEAR(*seen.hu_score, *real.hu_score, kHu);
  }
}

/// Finds both lines and holds everything against the bars. @param may_be_unseen  a line may also be said to be none.
inline void expect_measured(const Scene& truth, bool may_be_unseen = false) {
  try {
    const PhotoContours found = found_in(truth);
    expect_contour(found.tumor_edge, truth.tumor);
    expect_contour(found.incision, truth.incision);
    if (!found.red_in_tumor.empty()) {
      const PhotoMark& mark = found.red_in_tumor.front();
      ADD_FAILURE() << "red where there is none: " << mark.longest_mm << " mm at pixel " << mark.at_px.transpose();
    }
    if (!found.green_beside.empty()) {
      const PhotoMark& mark = found.green_beside.front();
      ADD_FAILURE() << "green where there is none: " << mark.longest_mm << " mm at pixel " << mark.at_px.transpose();
    }
    if (!found.incision.is_closed) ADD_FAILURE() << "an opening of " << found.red.max_gap_mm() << " mm was seen";
    expect_same_measures(found, truth);
  } catch (const DataError& error) {
    const bool is_unseen = std::string(error.what()).find("the strongest ") != std::string::npos;
    if (!may_be_unseen || !is_unseen) ADD_FAILURE() << error.what();
  }
}

}  // namespace incise::photo_scene
