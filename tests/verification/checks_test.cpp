// Every check of `incise verify`, each a test of its own; and the rules by which a check passes.
#include "support/monitors.hpp"
#include "verification/beam_in_the_plane.hpp"
#include "verification/check.hpp"
#include "verification/closed_forms.hpp"
#include "verification/plane_reference.hpp"

#include <incise/core/error.hpp>
#include <incise/verification/verification.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace incise {
namespace {

class Check : public ::testing::TestWithParam<std::string> {};

TEST_P(Check, FindsWhatIsExpected) {
  Workers workers(2);
  Monitor monitor;
  int found = 0;
  for (const VerificationCheck& check : run_checks({GetParam(), 1.0}, workers, monitor)) {
    if (check.name != GetParam()) continue;
    ++found;
    EXPECT_TRUE(check.passed) << check.what << "\nexpected " << check.expected << " " << check.unit << ", found "
                              << check.found << ", tolerance " << check.tolerance << "\nsource: " << check.source
                              << "\n"
                              << check.note;
    RecordProperty("found", std::to_string(check.found));
    EXPECT_FALSE(check.source.empty());
    EXPECT_FALSE(check.plot.series.empty());
    for (const LineSeries& curve : check.plot.series) {
      EXPECT_EQ(curve.x.size(), curve.y.size());
      EXPECT_FALSE(curve.x.empty());
      for (const std::vector<double>* values : {&curve.x, &curve.y}) {
        EXPECT_TRUE(std::all_of(values->begin(), values->end(), [](double value) { return std::isfinite(value); }))
            << curve.name;
      }
    }
  }
  EXPECT_EQ(found, 1) << "checks of this name";
}

INSTANTIATE_TEST_SUITE_P(Physics, Check, ::testing::ValuesIn(physics_check_names()),
                         [](const auto& test) { return test.param; });

TEST(Checks, HaveNamesOfTheirOwn) {
  const std::vector<std::string> names = physics_check_names();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

TEST(Checks, ThatMissTheirToleranceFail) {
  Workers workers(1);
  Monitor monitor;
  const auto checks = run_checks({"cantilever_rate", 0.0}, workers, monitor);
  ASSERT_EQ(checks.size(), 1u);
  EXPECT_FALSE(checks[0].passed) << "no discretisation error at all?";
}

TEST(Checks, RefuseNamesThatSelectNothing) {
  Workers workers(1);
  Monitor monitor;
  EXPECT_THROW((void)run_checks({"no such check", 1.0}, workers, monitor), InvalidArgument);
  EXPECT_THROW((void)run_checks({"patch", -1.0}, workers, monitor), InvalidArgument);
}

TEST(Checks, StopWhenAsked) {
  Workers workers(1);
  testing::StopAfter monitor;
  EXPECT_THROW((void)run_checks({}, workers, monitor), Cancelled);
}

TEST(Criterion, AFinestMeshThatIsFarOffFailsWhateverItsExtrapolationSays) {
  EXPECT_NO_THROW(require_small_error(-0.009, 0.01));
  EXPECT_THROW(require_small_error(-0.011, 0.01), NotSolved);
  EXPECT_THROW(require_small_error(0.011, 0.01), NotSolved);
  EXPECT_THROW(require_small_error(std::numeric_limits<double>::quiet_NaN(), 0.01), NotSolved);
}

TEST(Criterion, WithinTakesBothSidesAndAtLeastOnlyOne) {
  VerificationCheck check{.expected = 10.0, .tolerance = 1.0};
  const auto passes = [&](double found, Criterion criterion) {
    check.found = found;
    check.criterion = criterion;
    return is_met(check);
  };
  EXPECT_TRUE(passes(9.5, Criterion::Within));
  EXPECT_FALSE(passes(8.5, Criterion::Within));
  EXPECT_FALSE(passes(11.5, Criterion::Within));
  EXPECT_TRUE(passes(11.5, Criterion::AtLeast));
  EXPECT_FALSE(passes(8.5, Criterion::AtLeast));
  EXPECT_FALSE(passes(std::numeric_limits<double>::quiet_NaN(), Criterion::Within));
  EXPECT_FALSE(passes(std::numeric_limits<double>::quiet_NaN(), Criterion::AtLeast));
  EXPECT_FALSE(passes(std::numeric_limits<double>::infinity(), Criterion::AtLeast));
}

// The references themselves, held against published numbers.

TEST(Reference, BentLineIsTheElasticaOfTheTables) {
  // F L²/EI, horizontal and vertical tip displacement over L: K. Mattiasson, Int. J. Numer. Meth. Eng. 17 (1981) 145.
  struct Row {
    double load, along, across;
  };
  for (const Row row : {Row{1.0, 0.05643, 0.30172}, Row{2.0, 0.16064, 0.49346}, Row{5.0, 0.38763, 0.71379},
                        Row{10.0, 0.55500, 0.81061}}) {
    PlaneBeam beam{.force_mn = row.load};
    const Vec2 tip = bent_line(beam).back();
    EXPECT_NEAR(1.0 - tip[0], row.along, 6e-6) << row.load;
    EXPECT_NEAR(-tip[1], row.across, 6e-6) << row.load;
  }
}

TEST(Reference, BentLineOfASmallForceIsTimoshenkosBeam) {
  PlaneBeam beam;
  beam.length_mm = 100.0;
  beam.bending_stiffness = 70.0 * 1000.0 / 12.0;
  beam.axial_stiffness = 700.0;
  beam.shear_stiffness = 5.0 / 6.0 * 350.0;
  beam.force_mn = 1e-5;
  EXPECT_NEAR(-bent_line(beam).back()[1] / beam_tip_mm(100.0, 10.0, 70.0, 1e-5), 1.0, 1e-6);
}

TEST(Reference, CooksPanelInPlaneStressIsThePublishedOne) {
  // E = 1, ν = 1/3, a shear force of 1: 23.96 at the middle of the right edge (Simo and Rifai 1990, and many since).
  PanelProblem problem{1.0, 1.0 / 3.0, 1.0 / 16.0, false};
  EXPECT_NEAR(panel_tip_mm(problem, 32), 23.96, 0.02);
}

TEST(Reference, CornerExponentIsTheKnownOneOfARightAngle) {
  // ω = 90°, plane strain, ν = 0.3: 0.7112 (Williams 1952; Karp and Karal 1962).
  EXPECT_NEAR(corner_exponent(0.5 * M_PI, 0.3), 0.7112, 5e-4);
}

TEST(Reference, ClosedFormsOfBothLawsHaveTheSmallStrainLimit) {
  for (const MaterialModel model : {MaterialModel::Corotational, MaterialModel::StableNeoHookean}) {
    Material material{.model = model, .poissons_ratio = 0.4};
    constexpr double kStrain = 1e-6;
    const double side = free_stretch_of_bar(material, 1.0 + kStrain);
    const double stress = principal_stress_kpa(material, Vec3(1.0 + kStrain, side, side))[0];
    EXPECT_NEAR(stress / kStrain, material.youngs_modulus_kpa, 1e-3);
    EXPECT_NEAR((1.0 - side) / kStrain, material.poissons_ratio, 1e-4);
    EXPECT_NEAR(simple_shear_stress_kpa(material, kStrain) / kStrain, material.youngs_modulus_kpa / 2.8, 1e-3);
    EXPECT_NEAR(principal_stress_kpa(material, Vec3::Ones()).norm(), 0.0, 1e-10);
  }
}

}  // namespace
}  // namespace incise
