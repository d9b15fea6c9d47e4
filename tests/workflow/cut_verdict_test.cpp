#include "support/contour_shapes.hpp"

#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/geometry/contour.hpp>
#include <incise/workflow/cut_verdict.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace incise {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> ids_of(const Verdict& verdict) {
  std::vector<std::string> ids;
  for (const VerdictReason& reason : verdict.reasons()) ids.push_back(reason.id);
  return ids;
}

Contour circle(double radius_mm, const Vec3& center = Vec3::Zero()) {
  return testing::circle(radius_mm, 120, center);
}

/// A ring at its intended place round a tumour of 20 mm, sound in every respect.
SimulatedCut sound_cut() {
  SimulatedCut cut{.outcome = Outcome::Success};
  IncisionResult& incision = cut.incision;
  incision.outcome = Outcome::Success;
  incision.is_closed_loop = true;
  incision.is_at_rest = true;
  incision.kerf_width_mm = 1.8;
  incision.steps.resize(100);
  for (const double depth_mm : {1.0, 2.5, 4.0, 5.0}) {
    KerfLayer layer{.depth_mm = depth_mm, .is_within_plan = true, .is_closed = true, .width_mm = 1.8};
    incision.kerf.layers.push_back(layer);
    cut.layers.push_back({Summary{.mean = 0.0, .min = -0.4, .max = 0.4}, {}});
  }
  DepthReached& depth = incision.kerf.depth;
  depth.profile.course = circle(15.0);
  for (std::size_t i = 0; i < depth.profile.course.points.size(); ++i) {
    depth.profile.arclength_mm.push_back(0.785 * static_cast<double>(i));
    depth.profile.depth_mm.push_back(5.2);
    depth.planned_at_mm.push_back(5.0);
  }
  incision.kerf.deep_margin = DeepMargin{.nearest_mm = 3.5, .beside_mm = 3.5, .beneath_mm = {}, .floor_below_mm = {}};
  cut.centerline.errors = contour_errors(circle(15.0), circle(10.0), 5.0, -Vec3::UnitZ());
  cut.centerline.signed_error_mm = Summary{.mean = 0.0, .min = -0.1, .max = 0.1};
  cut.centerline.target_mm = 5.0;
  incision.final_tumor_edge = circle(10.0);
  cut.inner_edge.errors = contour_errors(circle(14.1), circle(10.0), 4.5, -Vec3::UnitZ());
  cut.thermal_half_width_mm = 2.8;
  cut.thermal_margin_mm = 2.1;
  return cut;
}

TEST(VerdictOfCut, IsOkForASoundCut) { EXPECT_THAT(ids_of(verdict_of_cut(Case{}, sound_cut())), IsEmpty()); }

TEST(VerdictOfCut, RefusesAKerfAtOrBelowTheCloseMarginFromTheTumour) {
  SimulatedCut cut = sound_cut();
  cut.incision.kerf.deep_margin->nearest_mm = 2.21;
  EXPECT_EQ(verdict_of_cut(Case{}, cut).status(), VerdictStatus::Ok);
  for (const double nearest_mm : {2.2, 0.78, 0.0, -1.66}) {
    cut.incision.kerf.deep_margin->nearest_mm = nearest_mm;
    const Verdict verdict = verdict_of_cut(Case{}, cut);
    ASSERT_FALSE(verdict.reasons().empty()) << nearest_mm;
    EXPECT_EQ(verdict.reasons().front().id, "tumor_distance") << nearest_mm;
    EXPECT_EQ(verdict.status(), VerdictStatus::Refused) << nearest_mm;
    EXPECT_EQ(verdict.reasons().front().value, nearest_mm);
    EXPECT_EQ(verdict.reasons().front().limit, 2.2);
  }
  EXPECT_THAT(verdict_of_cut(Case{}, cut).reasons().front().message, HasSubstr("enters the tumour by 1.66 mm"));
  Case careful;
  careful.close_margin_mm = 4.0;
  cut = sound_cut();
  EXPECT_EQ(verdict_of_cut(careful, cut).reasons().front().id, "tumor_distance") << "the limit is the case's close margin";
}

TEST(VerdictOfCut, RefusesALayerWithinThePlanThatStayedOpen) {
  SimulatedCut cut = sound_cut();
  cut.incision.kerf.layers[1].is_closed = false;
  cut.incision.kerf.layers[2].is_closed = false;
  cut.incision.kerf.layers[2].gap_mm = 3.25;
  cut.incision.kerf.layers[2].gap_place_mm = Vec3(4, 5, 6);
  const Verdict verdict = verdict_of_cut(Case{}, cut);
  EXPECT_THAT(ids_of(verdict), ElementsAre("open_layer", "open_layer"));
  EXPECT_EQ(verdict.status(), VerdictStatus::Refused);
  EXPECT_EQ(verdict.reasons()[1].value, 3.25);
  EXPECT_EQ(verdict.reasons()[1].at->text, "4 mm below the skin");
  EXPECT_EQ(verdict.reasons()[1].at->position_mm, Vec3(4, 5, 6));
  for (KerfLayer& layer : cut.incision.kerf.layers) layer.is_within_plan = layer.depth_mm < 2.0;
  EXPECT_EQ(verdict_of_cut(Case{}, cut).status(), VerdictStatus::Ok) << "a shallower plan";
}

TEST(VerdictOfCut, CautionsWhereTheKerfIsShallowerThanNineTenthsOfThePlan) {
  SimulatedCut cut = sound_cut();
  cut.incision.kerf.depth.profile.depth_mm[40] = 4.51;
  EXPECT_EQ(verdict_of_cut(Case{}, cut).status(), VerdictStatus::Ok);
  cut.incision.kerf.depth.profile.depth_mm[40] = 4.49;
  cut.incision.kerf.depth.profile.depth_mm[41] = 1.0;
  const Verdict verdict = verdict_of_cut(Case{}, cut);
  ASSERT_THAT(ids_of(verdict), ElementsAre("depth"));
  EXPECT_EQ(verdict.status(), VerdictStatus::Caution);
  EXPECT_NEAR(*verdict.reasons()[0].value, 0.2, 1e-12);
  EXPECT_NEAR(*verdict.reasons()[0].at->arclength_mm, 0.785 * 41, 1e-9);
  EXPECT_THAT(verdict.reasons()[0].message, HasSubstr("1 mm deep at its shallowest, 20 % of the planned 5 mm, and too shallow on 2 % of the path"));
}

TEST(VerdictOfCut, HoldsAShallowPathAgainstTheDepthThatTheCasePlans) {
  SimulatedCut cut = sound_cut();
  for (double& depth : cut.incision.kerf.depth.profile.depth_mm) depth = 3.1;
  for (double& planned : cut.incision.kerf.depth.planned_at_mm) planned = 3.0;
  EXPECT_THAT(ids_of(verdict_of_cut(Case{}, cut)), ElementsAre("depth"));
  Case shallow;
  shallow.plan.depth_mm = 3.0;
  EXPECT_EQ(verdict_of_cut(shallow, cut).status(), VerdictStatus::Ok);
}

TEST(VerdictOfCut, NamesDepthAndPlaceAlsoWhereThePathBeginsWithoutAny) {
  SimulatedCut cut = sound_cut();
  DepthReached& depth = cut.incision.kerf.depth;
  for (const std::size_t i : {0, 1, 2}) depth.planned_at_mm[i] = 0.0;
  depth.planned_at_mm[41] = 4.0;
  depth.profile.depth_mm[41] = 1.0;
  Case along_normals;
  along_normals.plan.axis_mode = AxisMode::SurfaceNormal;
  const Verdict verdict = verdict_of_cut(along_normals, cut);
  ASSERT_THAT(ids_of(verdict), ElementsAre("depth"));
  EXPECT_NEAR(*verdict.reasons()[0].at->arclength_mm, 0.785 * 41, 1e-9);
  EXPECT_THAT(verdict.reasons()[0].message, HasSubstr("1 mm deep at its shallowest, 25 % of the planned 4 mm"));
}

TEST(VerdictOfCut, RefusesTooLittleTissueBesideTheEdgeInTheMidLineTheInnerEdgeOrALayer) {
  SimulatedCut cut = sound_cut();
  cut.inner_edge.errors = contour_errors(circle(12.15), circle(10.0), 4.5, -Vec3::UnitZ());
  EXPECT_THAT(ids_of(verdict_of_cut(Case{}, cut)), ElementsAre("lateral_margin"));
  cut = sound_cut();
  cut.centerline.errors = contour_errors(circle(12.6), circle(10.0), 5.0, -Vec3::UnitZ());
  const Verdict by_midline = verdict_of_cut(Case{}, cut);
  ASSERT_THAT(ids_of(by_midline), ElementsAre("lateral_margin")) << "2.6 mm less the electrode's radius";
  EXPECT_NEAR(*by_midline.reasons()[0].value, 2.1, 0.02);
  EXPECT_TRUE(by_midline.reasons()[0].at->position_mm.has_value());
  cut = sound_cut();
  cut.layers[3].signed_error_mm->min = -2.0;  // 5.0 - 2.0 - 0.9 of kerf
  EXPECT_EQ(verdict_of_cut(Case{}, cut).status(), VerdictStatus::Ok) << "the tumour's surface says how near the kerf comes";
  cut.incision.kerf.deep_margin.reset();
  EXPECT_THAT(ids_of(verdict_of_cut(Case{}, cut)), ElementsAre("lateral_margin"));
}

/// In four sectors; the first about the start direction.
Case expecting(std::vector<double> residual_mm) {
  Case settings;
  settings.compensation.observable = ContourKind::InnerEdge;
  settings.compensation.residual_mm = std::move(residual_mm);
  return settings;
}

TEST(VerdictOfCut, RefusesAMarginThatIsTooThinWithTheErrorsThatCompensationExpects) {
  const SimulatedCut cut = sound_cut();  // 4.1 mm left beside the edge
  const auto judged = [&cut](const Case& settings) {
    return verdict_of_cut(settings, cut, expected_errors(settings, cut, circle(10.0)));
  };
  EXPECT_THAT(ids_of(judged(expecting({-1.8}))), IsEmpty());
  const Verdict verdict = judged(expecting({-2.0}));
  ASSERT_THAT(ids_of(verdict), ElementsAre("lateral_margin"));
  EXPECT_NEAR(*verdict.reasons()[0].value, 2.1, 0.02);
  EXPECT_THAT(verdict.reasons()[0].message,
              HasSubstr("tool out, with the errors that compensation expects of real cuts, leaves"));
  Case biased;
  biased.compensation.bias_mm = -2.0;
  EXPECT_THAT(ids_of(judged(biased)), ElementsAre("lateral_margin"));
  biased.compensation.method = CompensationMethod::Paper;
  EXPECT_THAT(ids_of(judged(biased)), IsEmpty()) << "it knows no bias";
}

TEST(VerdictOfCut, LooksForTheThinPlaceWhereItIsExpected) {
  const SimulatedCut cut = sound_cut();
  const Case settings = expecting({0.0, 0.0, -2.5, 0.0});
  const Verdict verdict = verdict_of_cut(settings, cut, expected_errors(settings, cut, circle(10.0)));
  ASSERT_THAT(ids_of(verdict), ElementsAre("lateral_margin"));
  EXPECT_NEAR(*verdict.reasons()[0].value, 1.6, 0.02);
  const Vec3 at = *verdict.reasons()[0].at->position_mm;
  EXPECT_LT(at.dot(settings.plan.start_direction), -0.99 * at.norm()) << "opposite the start";
}

TEST(VerdictOfCut, CautionsWhereTheSimulationAloneLeavesTooLittle) {
  SimulatedCut cut = sound_cut();
  cut.inner_edge.errors = contour_errors(circle(11.8), circle(10.0), 4.5, -Vec3::UnitZ());
  const Case settings = expecting({0.6});
  const Verdict verdict = verdict_of_cut(settings, cut, expected_errors(settings, cut, circle(10.0)));
  ASSERT_THAT(ids_of(verdict), ElementsAre("simulated_margin"));
  EXPECT_EQ(verdict.status(), VerdictStatus::Caution);
  EXPECT_NEAR(*verdict.reasons()[0].value, 1.8, 0.02);
  EXPECT_THAT(verdict.reasons()[0].message, HasSubstr("leaves 1.80 mm"));
  EXPECT_THAT(
      verdict.reasons()[0].message,
      HasSubstr(
          "its inner edge, the tool out, with the errors that compensation expects of real cuts, leaves 2.40 mm"));
  EXPECT_THAT(ids_of(verdict_of_cut(settings, cut)), ElementsAre("lateral_margin")) << "nothing is expected beyond it";
}

TEST(VerdictOfCut, ExpectsLayersToErrAsTheRestDoes) {
  SimulatedCut cut = sound_cut();
  cut.incision.kerf.deep_margin.reset();
  for (KerfLayer& layer : cut.incision.kerf.layers) {
    layer.centerline = circle(15.0, -layer.depth_mm * Vec3::UnitZ());
  }
  cut.incision.kerf.layers[3].centerline = circle(13.0, -5.0 * Vec3::UnitZ());
  cut.layers[3].signed_error_mm->min = -2.0;  // 5.0 - 2.0 - 0.9 of kerf
  const Case settings = expecting({0.5});
  EXPECT_THAT(ids_of(verdict_of_cut(settings, cut, expected_errors(settings, cut, circle(10.0)))),
              ElementsAre("simulated_margin"));
  const Case on_one_side = expecting({0.0, 0.0, 0.5, 0.0});
  EXPECT_THAT(ids_of(verdict_of_cut(on_one_side, cut, expected_errors(on_one_side, cut, circle(10.0)))),
              ElementsAre("lateral_margin"));
}

TEST(VerdictOfCut, RefusesACutThatIsSimulatedToEnterTheEdgeWhateverIsExpected) {
  SimulatedCut cut = sound_cut();
  cut.inner_edge.errors = contour_errors(circle(9.9), circle(10.0), 4.5, -Vec3::UnitZ());
  const Case settings = expecting({5.0});
  const Verdict verdict = verdict_of_cut(settings, cut, expected_errors(settings, cut, circle(10.0)));
  ASSERT_THAT(ids_of(verdict), ElementsAre("lateral_margin"));
  EXPECT_NEAR(*verdict.reasons()[0].value, -0.1, 0.01);
}

/// Signed errors of both lines, mm: mid-line -1.0, inner edge -0.4.
SimulatedCut measured_cut() {
  SimulatedCut cut = sound_cut();
  cut.incision.centerline = circle(14.0);
  cut.centerline.errors = contour_errors(circle(14.0), circle(10.0), 5.0, -Vec3::UnitZ());
  cut.centerline.abs_error_mm = Summary{.mean = 1.0};
  cut.incision.inner_edge = circle(14.1);
  cut.incision.kerf.inner_edge_reference = circle(14.1);
  cut.inner_edge.abs_error_mm = Summary{.mean = 0.4};
  return cut;
}

TEST(ExpectedErrors, AreBiasResidualAndWhatTheShareLeavesOfTheFirstCut) {
  SimulatedCut first = measured_cut();
  const Points start{Vec3(0.0, -14.0, 0.0)};  // the start direction
  const auto at_start = [&](const Case& settings) {
    return expected_errors(settings, first, circle(10.0)).at(settings, start, circle(10.0)).front();
  };
  Case settings;
  EXPECT_FALSE(expected_errors(settings, first, circle(10.0)).is_any());
  settings.compensation.bias_mm = 0.2;
  EXPECT_NEAR(at_start(settings), 0.2, 1e-12);
  settings.compensation.residual_mm = {0.1, 0.2, 0.3, 0.4};
  EXPECT_NEAR(at_start(settings), 0.3, 1e-9);
  settings.compensation.simulated_share = 0.5;  // half of -1.0 + 0.2 mm is taken back
  EXPECT_NEAR(at_start(settings), 0.7, 0.01);
  settings.compensation.residual_mm.assign(360, 0.1);
  EXPECT_NEAR(at_start(settings), 0.7, 0.01) << "more sectors than the ring has points";
  first.incision.is_closed_loop = false;
  first.incision.kerf.layers.clear();
  const ExpectedErrors unmeasured = expected_errors(settings, first, circle(10.0));
  EXPECT_FALSE(unmeasured.is_measured) << "no ring to take a share of";
  EXPECT_FALSE(unmeasured.is_any());
  EXPECT_THAT(ids_of(verdict_of_cut(settings, sound_cut(), unmeasured)), ElementsAre("simulated_margin"));
}

TEST(ExpectedErrors, PutTheInnerEdgeWhereItWasPhotographed) {
  const SimulatedCut first = measured_cut();
  Case settings;
  settings.compensation.method = CompensationMethod::Profile;
  settings.compensation.photographed_mm = {-0.1};
  const ExpectedErrors expected = expected_errors(settings, first, circle(10.0));
  const Points& places = first.inner_edge.errors.points.points;
  const std::vector<double> beyond = expected.at(settings, places, circle(10.0));
  for (std::size_t i = 0; i < places.size(); ++i)
    EXPECT_NEAR(first.inner_edge.errors.signed_error_mm[i] + beyond[i], -0.1, 0.01);
}

TEST(VerdictOfCut, CautionsOfHeatThatReachesEdgeOrSurface) {
  SimulatedCut cut = sound_cut();
  cut.thermal_margin_mm = -0.48;
  EXPECT_THAT(ids_of(verdict_of_cut(Case{}, cut)), ElementsAre("heat"));
  cut = sound_cut();
  cut.thermal_half_width_mm = 4.5;  // 3.5 + 0.9 mm from the electrode to the surface
  EXPECT_THAT(ids_of(verdict_of_cut(Case{}, cut)), ElementsAre("heat"));
}

TEST(VerdictOfCut, CautionsOfASimulationThatIsNotSolved) {
  SimulatedCut cut = sound_cut();
  cut.incision.is_at_rest = false;
  EXPECT_THAT(ids_of(verdict_of_cut(Case{}, cut)), ElementsAre("convergence"));
  cut = sound_cut();
  cut.tets = 10000;
  cut.incision.inverted_tets = 1;
  EXPECT_THAT(ids_of(verdict_of_cut(Case{}, cut)), IsEmpty());
  cut.incision.inverted_tets = 3;
  EXPECT_THAT(ids_of(verdict_of_cut(Case{}, cut)), ElementsAre("convergence"));
  cut = sound_cut();
  cut.tets = 1000;
  cut.incision.held_back_vertices = 199;  // in 100 steps
  EXPECT_THAT(ids_of(verdict_of_cut(Case{}, cut)), IsEmpty());
  cut.incision.held_back_vertices = 201;
  EXPECT_THAT(ids_of(verdict_of_cut(Case{}, cut)), ElementsAre("convergence"));
}

TEST(VerdictOfCut, RefusesEveryOutcomeButSuccess) {
  for (const Outcome outcome : {Outcome::PositiveMargin, Outcome::OpenLoop, Outcome::NotConverged, Outcome::ElementInverted}) {
    SimulatedCut cut = sound_cut();
    cut.outcome = outcome;
    EXPECT_EQ(verdict_of_cut(Case{}, cut).reasons().front().id, "outcome") << to_string(outcome);
  }
}

/// A ball that stands for a tumour's surface; only its corners count.
TriMesh ball(double radius_mm, const Vec3& center = Vec3::Zero()) {
  TriMesh mesh;
  for (int i = 0; i <= 12; ++i) {
    for (const Vec3& p : circle(radius_mm * std::sin(units::kPi * i / 12.0)).points) {
      mesh.vertices.push_back(center + p + Vec3(0.0, 0.0, radius_mm * std::cos(units::kPi * i / 12.0)));
    }
  }
  return mesh;
}

TEST(EdgeFit, IsHowFarTheTwoLieOutsideEachOtherWhateverTheirHeights) {
  const Vec3 down = -Vec3::UnitZ();
  EXPECT_NEAR(edge_fit(circle(10.0, Vec3(3, 4, 50)), ball(10.0, Vec3(3, 4, 0)), down).apart_mm, 0.0, 0.02);
  EXPECT_NEAR(edge_fit(circle(10.0), ball(12.0), down).apart_mm, 2.0, 0.02) << "the tumour is wider than its edge";
  EXPECT_NEAR(edge_fit(circle(10.0), ball(7.0), down).apart_mm, 3.0, 0.02);
  EXPECT_NEAR(edge_fit(circle(10.0), ball(10.0, Vec3(15, 0, 0)), down).apart_mm, 15.0, 0.05);
}

TEST(VerdictOfContour, RefusesAShiftedEdgeASurfaceInMetresAndAFlip) {
  const Vec3 down = -Vec3::UnitZ();
  const TriMesh surface = ball(10.0, Vec3(12, -30, 20));
  const auto verdict = [&](const Contour& edge) { return ids_of(verdict_of_contour(edge, surface, down)); };
  EXPECT_THAT(verdict(circle(10.0, Vec3(12, -30, 25))), IsEmpty());
  EXPECT_THAT(verdict(circle(10.0, Vec3(14, -31, 25))), IsEmpty()) << "a hand's error";
  EXPECT_THAT(verdict(circle(10.0, Vec3(27, -30, 25))), ElementsAre("contour_surface"));
  EXPECT_THAT(verdict(circle(10.0, Vec3(-12, 30, 25))), ElementsAre("contour_flipped"));
  TriMesh in_metres = surface;
  for (Vec3& p : in_metres.vertices) p *= 1e-3;
  EXPECT_THAT(ids_of(verdict_of_contour(circle(10.0, Vec3(0, 0, 25)), in_metres, down)), ElementsAre("contour_surface"));
}

TEST(VerdictOfRun, CautionsOfATypedTransformOfABodyThatIsNotVirtual) {
  const SimulatedCut cut = sound_cut();
  Case settings;
  settings.T_robot_sim = Mat4::Identity();
  EXPECT_THAT(ids_of(verdict_of_run(settings, {}, &cut, {})), ElementsAre("typed_transform"));
  settings.is_virtual = true;
  EXPECT_THAT(ids_of(verdict_of_run(settings, {}, &cut, {})), IsEmpty());
}

TEST(VerdictOfRun, IsThatOfTheCutWhichVerifiesThePathAndOfTheInputs) {
  Verdict inputs;
  inputs.add("contour_flipped", 60.0, "RAS");
  SimulatedCut cut = sound_cut();
  cut.verdict.add("depth", 0.5, "shallow");
  EXPECT_THAT(ids_of(verdict_of_run(Case{}, inputs, &cut, {})), ElementsAre("contour_flipped", "depth"));
  EXPECT_THAT(ids_of(verdict_of_run(Case{}, {}, &cut, "its cut is open")), ElementsAre("depth", "not_corrected"));
  EXPECT_THAT(ids_of(verdict_of_run(Case{}, {}, nullptr, {})), ElementsAre("outcome"));
}

}  // namespace
}  // namespace incise
