#include "virtual_bench/small_bench.hpp"

#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/virtual_bench/course.hpp>
#include <incise/virtual_bench/pictures.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace incise {
namespace {

using test::coarse_body;
using test::coarse_cut;
using test::middle_specimen;

const BenchBody& body() {
  return test::middle_body();
}
const BenchCut& cut_at_35() {
  static const BenchCut made = coarse_cut(body(), 35.0);
  return made;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

void expect_suture_drawn_and_clamp_slipped() {
  const TissueModel& model = *body().tissue;
  const Box3 rest = bounding_box(model.mesh.vertices);
  const Box3 now = bounding_box(body().stretched.positions);
  EXPECT_NEAR(rest.min().y() - now.min().y(), 20.0, 0.05);
  EXPECT_NEAR(rest.max().y() - now.max().y(), middle_specimen().clamp_slip_mm, 0.05);
}

TEST(BenchBody, IsStretchedAsDrawnInEquilibriumAndItsPullGrowsWithItsStiffness) {
  expect_suture_drawn_and_clamp_slipped();
  EXPECT_EQ(body().outcome, Outcome::Success);
  EXPECT_EQ(body().inverted_tets, 0U);
  EXPECT_LE(body().equilibrium_residual, 1e-4);
  Specimen stiff = middle_specimen();
  stiff.youngs_modulus_kpa *= 2.0;
  const BenchBody other = coarse_body(stiff);
  // Displacements are prescribed, so force goes with stiffness; weight and friction-free rest on the platform take a
  // little.
  EXPECT_NEAR(other.stretch_force_n / body().stretch_force_n, 2.0, 0.06);
  EXPECT_GT(body().stretch_force_n, 0.5);
  EXPECT_LT(body().stretch_force_n, 20.0);
}

void expect_the_same_again() {
  const BenchCut again = coarse_cut(body(), 35.0);
  EXPECT_EQ(again.after.is_live, cut_at_35().after.is_live);
  for (std::size_t v = 0; v < again.after.positions.size(); ++v)
    ASSERT_EQ(again.after.positions[v], cut_at_35().after.positions[v]) << "vertex " << v;
}

TEST(BenchCut, ClosesTheRingRoundThePlugComesToRestAndIsTheSameTwice) {
  ASSERT_EQ(cut_at_35().outcome, Outcome::Success);
  const Contour& edge = *cut_at_35().inner_edge;
  EXPECT_TRUE(contains_in_view(edge, curve_centroid(cut_at_35().tumor_edge), body().approach));
  EXPECT_GT(cut_at_35().removed_tets, 200U);
  // The drag takes the cut towards the tumour.
  EXPECT_LT(mean(true_errors_mm(body(), cut_at_35(), 4.5)), -0.3);
  EXPECT_GT(cut_at_35().unrest_mm, 0.0);
  EXPECT_LT(cut_at_35().unrest_mm, 0.02);
  expect_the_same_again();
}

TEST(BenchCut, AnElectrodeThatDragsLessCutsNearerToThePlan) {
  BenchBody slick = body();
  slick.specimen.adhesion_kpa_s_mm2 = 1.0;
  slick.specimen.adhesion_limit_kpa_mm = 5.0;
  const BenchCut cut = coarse_cut(slick, 35.0);
  ASSERT_EQ(cut.outcome, Outcome::Success);
  EXPECT_LT(cut.mean_force_mn, 0.2 * cut_at_35().mean_force_mn);
  EXPECT_GT(mean(true_errors_mm(slick, cut, 4.5)), mean(true_errors_mm(body(), cut_at_35(), 4.5)) + 0.2);
}

TEST(BenchCut, ThePowerSeriesHasThePapersOrder) {
  const BenchCut at_25 = coarse_cut(body(), 25.0);
  const BenchCut at_30 = coarse_cut(body(), 30.0);
  const BenchCut at_40 = coarse_cut(body(), 40.0);
  EXPECT_GT(at_25.bulge_mm, 1.05 * at_30.bulge_mm);
  EXPECT_GT(at_30.bulge_mm, 1.05 * cut_at_35().bulge_mm);
  EXPECT_GT(cut_at_35().bulge_mm, 1.2 * at_40.bulge_mm);
  EXPECT_GT(at_25.mean_force_mn, 1.2 * at_30.mean_force_mn);
  EXPECT_GT(at_30.mean_force_mn, 1.2 * cut_at_35().mean_force_mn);
  EXPECT_LT(cut_at_35().thermal_width_mm, 1.0) << "not discoloured at 35 W";
  EXPECT_GT(at_40.thermal_width_mm, 1.0) << "discoloured at 40 W";
}

TEST(BenchCut, ACourseThatDoesNotCutIsRefusedAndOneBesideTheSpecimenIsNamed) {
  Workers workers(1);
  Monitor monitor;
  std::vector<TipPose> course = test::ring_course(body(), 7.0);
  EXPECT_THROW(static_cast<void>(cut_specimen(body(), course, -5.0, workers, monitor)), InvalidArgument);
  for (TipPose& pose : course) pose.is_cutting = false;
  EXPECT_THROW(static_cast<void>(cut_specimen(body(), course, 35.0, workers, monitor)), InvalidArgument);
  course = test::ring_course(body(), 7.0);
  EXPECT_FALSE(find_misfit(body(), course));
  std::vector<TipPose> high = course;
  for (TipPose& pose : high) pose.tip_mm.z() += 8.0;
  EXPECT_TRUE(find_misfit(body(), high));
  std::vector<TipPose> aside = course;
  for (TipPose& pose : aside) pose.tip_mm.y() += 60.0;
  EXPECT_TRUE(find_misfit(body(), aside));
}

/// Pixels that are clearly of an ink, the mean distance of their places from the picture's ink centre, and the widest
/// angle there without any.
struct Ink {
  std::size_t pixels = 0;
  double mean_radius_px = 0.0;
  double gap_deg = 0.0;
};

double widest_gap_deg(const std::vector<Vec2>& places, const Vec2& centre) {
  std::vector<double> angles;
  for (const Vec2& p : places) angles.push_back(std::atan2(p.y() - centre.y(), p.x() - centre.x()));
  std::sort(angles.begin(), angles.end());
  angles.push_back(angles.front() + 2.0 * M_PI);
  double gap = 0.0;
  for (std::size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
  return units::deg_from_rad(gap);
}

Ink find_ink(ColorPicture picture, bool is_red) {
  std::vector<Vec2> places;
  Vec2 centre = Vec2::Zero();
  for (int v = 0; v < picture.height; ++v) {
    for (int u = 0; u < picture.width; ++u) {
      const std::uint8_t* p = picture.rgb.data() + 3 * (v * picture.width + u);
      const bool is_ink = is_red ? p[0] > 170 && p[1] < 60 && p[2] < 70 : p[1] > 120 && p[0] < 80 && p[2] < 110;
      if (!is_ink) continue;
      places.emplace_back(u, v);
      centre += Vec2(u, v);
    }
  }
  centre /= static_cast<double>(places.size());
  Ink ink{places.size(), 0.0, widest_gap_deg(places, centre)};
  for (const Vec2& p : places) ink.mean_radius_px += (p - centre).norm() / static_cast<double>(places.size());
  return ink;
}

double mean_radius_mm(const Contour& contour) {
  const Contour even = resample(contour, 360);
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : even.points) centre += p / 360.0;
  double sum = 0.0;
  for (const Vec3& p : even.points) sum += (p - centre).head<2>().norm() / 360.0;
  return sum;
}

void expect_both_lines_at_their_scale() {
  PhotographSettings settings{.mm_per_pixel = 0.06};
  const ColorPicture picture = photograph(body(), cut_at_35(), settings);
  const Ink green = find_ink(picture, false);
  const Ink red = find_ink(picture, true);
  EXPECT_NEAR(0.06 * green.mean_radius_px, mean_radius_mm(cut_at_35().tumor_edge), 0.1);
  EXPECT_NEAR(0.06 * red.mean_radius_px, mean_radius_mm(*cut_at_35().inner_edge), 0.1);
  EXPECT_NEAR(0.06 * 0.06 * static_cast<double>(green.pixels) / length_mm(cut_at_35().tumor_edge),
              settings.green_line_mm, 0.12);
}

TEST(Photograph, ShowsBothLinesAtTheirScaleAndAnOpenRingAsAnOpenLine) {
  expect_both_lines_at_their_scale();
  BenchCut open = cut_at_35();
  // The tissue of one side is put back: no kerf there.
  const Vec3 middle = curve_centroid(open.tumor_edge);
  for (std::size_t t = 0; t < open.after.is_live.size(); ++t) {
    const Vec3& p = open.after.positions[body().tissue->mesh.tets[t][0].index()];
    if (p.x() > middle.x() + 6.0) open.after.is_live[t] = 1;
  }
  open.inner_edge.reset();
  open.outcome = Outcome::OpenLoop;
  PhotographSettings settings{.mm_per_pixel = 0.06};
  const Ink whole = find_ink(photograph(body(), cut_at_35(), settings), true);
  const Ink part = find_ink(photograph(body(), open, settings), true);
  EXPECT_GT(part.pixels, whole.pixels / 3);
  EXPECT_LT(whole.gap_deg, 10.0);
  EXPECT_GT(part.gap_deg, 30.0);
}

}  // namespace
}  // namespace incise
