// Supports that are the surface of a holder: contact, reactions, and what is no holder.
#include "mechanics/bodies.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/statics.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace incise {
namespace {

using ::testing::HasSubstr;
using testing::plane_x;
using testing::plane_z;
using testing::solve;

/// Largest penetration that a support may allow, mm.
constexpr double kPenetrationMm = 0.05;

/// A sheet over [-size, size]² at the height z(x, y), normals up.
template <class Height>
TriMesh sheet(double size, int cells, const Height& height) {
  TriMesh surface;
  const auto id = [cells](int i, int j) { return VertexId(static_cast<std::size_t>(i + (cells + 1) * j)); };
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const double x = size * (2.0 * i / cells - 1.0);
      const double y = size * (2.0 * j / cells - 1.0);
      surface.vertices.emplace_back(x, y, height(x, y));
    }
  }
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      surface.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      surface.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  }
  return surface;
}

TriMesh flat_sheet() {
  return sheet(200.0, 7, [](double, double) { return 0.0; });
}

SupportConstraint support_of(TriMesh surface) {
  SupportConstraint support;
  support.holder = std::make_shared<HolderSurface>(HolderSurface{"holder.stl", std::move(surface)});
  return support;
}

TissueModel resting_block(const SupportConstraint& support, double z = 0.0, const Vec3& gravity = Vec3(0, 0, -9810)) {
  TetMesh mesh = make_block(Vec3(60, 30, 15), {8, 4, 3});
  for (Vec3& p : mesh.vertices) p[2] += z;
  Material material{.poissons_ratio = 0.45};
  return make_tissue_model(std::move(mesh), material, {FixedConstraint{plane_x(0.0)}, support}, gravity);
}

Vec3 imbalance(const TissueModel& model, const StaticResult& result) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& reaction : result.reactions_mn) sum += reaction;
  double mass = 0.0;
  for (const double m : model.vertex_mass_kg) mass += m;
  return sum + mass * Vec3(0, 0, -9810);
}

TEST(Holder, AFlatSheetHoldsTissueAsThePlaneDoes) {
  const StaticResult on_plane = solve(resting_block(SupportConstraint{Vec3::Zero(), Vec3::UnitZ()}));
  const StaticResult on_sheet = solve(resting_block(support_of(flat_sheet())));
  ASSERT_EQ(on_plane.outcome, Outcome::Success);
  ASSERT_EQ(on_sheet.outcome, Outcome::Success);
  for (std::size_t v = 0; v < on_plane.state.positions.size(); ++v) {
    ASSERT_LT((on_plane.state.positions[v] - on_sheet.state.positions[v]).norm(), 1e-6) << "vertex " << v;
  }
  EXPECT_LT((on_plane.reactions_mn[1] - on_sheet.reactions_mn[1]).norm(), 1e-3);
}

TEST(Holder, ATrayCarriesSaggingTissueWithoutPenetrationAndItsReactionIsInTheBalance) {
  // A cantilever that sags onto a tray 2 mm below it, shallower towards its rims.
  const TissueModel model =
      resting_block(support_of(sheet(90.0, 30, [](double x, double y) { return 1e-4 * (x * x + y * y) - 2.0; })));
  const StaticResult result = solve(model);
  ASSERT_EQ(result.outcome, Outcome::Success) << result.relative_residual;
  EXPECT_GT(result.reactions_mn[1][2], 10.0) << "nothing touches: the test shows nothing";
  EXPECT_GT(result.penetration_mm, 0.0);
  EXPECT_LT(result.penetration_mm, kPenetrationMm);
  EXPECT_LT(imbalance(model, result).norm(), 1e-4 * result.reactions_mn[0].norm());
}

TEST(Holder, AClosedBodyPushesFromWhereverItIsTouched) {
  // Tissue pressed onto a ball, which is dented but not entered.
  TriMesh ball = boundary_surface(make_block(Vec3(2, 2, 2), {10, 10, 10}));
  std::vector<bool> is_used(ball.vertices.size(), false);
  for (const Triangle& t : ball.triangles) {
    for (const VertexId v : t) is_used[v.index()] = true;
  }
  for (std::size_t v = 0; v < ball.vertices.size(); ++v) {
    const Vec3 from_center = ball.vertices[v] - Vec3::Ones();
    ball.vertices[v] =
        Vec3(45, 15, -9.9) + (is_used[v] ? (10.0 * from_center.normalized()).eval() : Vec3::Zero().eval());
  }
  const TissueModel model = make_tissue_model(
      make_block(Vec3(60, 30, 15), {12, 6, 3}), {},
      {FixedConstraint{plane_x(0.0)}, support_of(ball), TractionConstraint{plane_z(15.0), Vec3(0, 0, -0.3)}});
  const StaticResult result = solve(model);
  ASSERT_EQ(result.outcome, Outcome::Success) << result.relative_residual;
  EXPECT_GT(result.reactions_mn[1][2], 10.0);
  EXPECT_LT(result.penetration_mm, kPenetrationMm);
  Vec3 sum = Vec3::Zero();
  for (const Vec3& reaction : result.reactions_mn) sum += reaction;
  EXPECT_LT(sum.norm(), 1e-4 * result.reactions_mn[0].norm());
}

TEST(Holder, NeverPulls) {
  const TissueModel model = resting_block(support_of(flat_sheet()), 0.0, Vec3(0, 0, 9810));  // gravity upwards
  const StaticResult result = solve(model);
  ASSERT_EQ(result.outcome, Outcome::Success);
  EXPECT_GE(result.reactions_mn[1][2], 0.0);
  EXPECT_LT(result.reactions_mn[1][2], 0.2 * result.reactions_mn[0].norm());
  EXPECT_GT(result.state.positions[8][2], 0.1) << "the free end lifts off";
}

TEST(Holder, ForceIsMinusTheGradientOfTheEnergyOnFacesEdgesAndCorners) {
  // A ridge along y and a valley along x under the block: vertices meet faces, edges and corners of them.
  const TissueModel model = resting_block(support_of(
      sheet(80.0, 16, [](double x, double y) { return -0.04 * std::abs(x - 20.0) + 0.05 * std::abs(y - 10.0); })));
  TissueState state = testing::shaken(model, 0.4, 11);
  for (Vec3& p : state.positions) p[2] -= 0.8;
  Points forces(state.positions.size(), Vec3::Zero());
  add_support_response(model, state, forces, nullptr);
  std::size_t touching = 0;
  constexpr double kMovedMm = 1e-6;
  for (std::size_t v = 0; v < forces.size(); ++v) {
    if (forces[v].norm() == 0.0) continue;
    ++touching;
    for (int i = 0; i < 3; ++i) {
      TissueState moved = state;
      moved.positions[v][i] += kMovedMm;
      const double above = support_energy_uj(model, moved);
      moved.positions[v][i] -= 2.0 * kMovedMm;
      const double slope = (above - support_energy_uj(model, moved)) / (2.0 * kMovedMm);
      ASSERT_NEAR(-slope, forces[v][i], 1e-5 * forces[v].norm()) << "vertex " << v << " axis " << i;
    }
  }
  EXPECT_GT(touching, 10U);
}

TEST(Holder, WhatLiesBesideASheetIsNotTouched) {
  // The sheet covers x and y up to 10 mm only; the block sags past its rim.
  const TissueModel model = resting_block(support_of(sheet(10.0, 4, [](double, double) { return 0.0; })));
  TissueState state = rest_state(model);
  for (Vec3& p : state.positions) p[2] -= 0.03;
  Points forces(state.positions.size(), Vec3::Zero());
  add_support_response(model, state, forces, nullptr);
  for (std::size_t v = 0; v < forces.size(); ++v) {
    const Vec3& p = state.positions[v];
    const bool is_over_sheet = p[0] > 1.0 && p[0] < 10.0 && p[1] < 10.0 && p[2] < 0.0;
    EXPECT_EQ(forces[v][2] > 0.0, is_over_sheet) << "vertex " << v << " at " << p.transpose();
  }
}

/// The message of the CaseError for a holder that cannot be used.
std::string refusal(const TriMesh& surface, double z = 0.0) {
  const auto error = testing::error_of<CaseError>([&] { return resting_block(support_of(surface), z); });
  if (!error) return "accepted";
  EXPECT_EQ(error->field(), "specimen.constraints[1].surface");
  return error->what();
}

TEST(Holder, SaysWhatIsWrongWithASurface) {
  EXPECT_THAT(refusal(TriMesh{}), HasSubstr("at least 1 triangle"));
  TriMesh not_finite = flat_sheet();
  not_finite.vertices[5][0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(not_finite), HasSubstr("Vertex 5 is not finite"));
  TriMesh mixed = flat_sheet();
  std::swap(mixed.triangles[3][0], mixed.triangles[3][1]);
  EXPECT_THAT(refusal(mixed), HasSubstr("same orientation"));
  TriMesh fin = flat_sheet();
  fin.vertices.emplace_back(0, 0, -5);
  fin.triangles.push_back({fin.triangles[8][0], fin.triangles[8][2], VertexId(fin.vertices.size() - 1)});
  EXPECT_THAT(refusal(fin), HasSubstr("at most 2 triangles"));
  TriMesh inside_out = boundary_surface(make_block(Vec3(5, 5, 5), {1, 1, 1}));
  for (Triangle& t : inside_out.triangles) std::swap(t[0], t[1]);
  EXPECT_THAT(refusal(inside_out), HasSubstr("inside out"));
  TriMesh folded;
  folded.vertices = {Vec3(0, 0, 0), Vec3(5, 0, 0), Vec3(0, 5, 0)};
  folded.triangles = {{VertexId{0}, VertexId{1}, VertexId{2}}, {VertexId{0}, VertexId{2}, VertexId{1}}};
  EXPECT_THAT(refusal(folded), HasSubstr("face each other"));
}

TEST(Holder, RefusesASurfaceThatPassesThroughItselfWithTheTwoTriangles) {
  // A second, tilted sheet through the first one.
  TriMesh crossing = flat_sheet();
  const std::size_t first = crossing.vertices.size();
  const std::size_t triangles = crossing.triangles.size();
  crossing.vertices.insert(crossing.vertices.end(), {Vec3(5, 1, -3), Vec3(15, 2, -3), Vec3(8, 3, 4)});
  crossing.triangles.push_back({VertexId(first), VertexId(first + 1), VertexId(first + 2)});
  EXPECT_THAT(refusal(crossing), HasSubstr(fmt::format("and {} cross", triangles)));
  for (std::size_t v = first; v < first + 3; ++v) crossing.vertices[v][2] -= 10.0;  // clear of it
  EXPECT_EQ(refusal(crossing), "accepted");
}

TEST(Holder, TissueThatStartsInsideItIsRefusedWithTheVertexAndTheDepth) {
  EXPECT_THAT(refusal(flat_sheet(), -4.0), HasSubstr("4 mm inside the holder"));
  EXPECT_EQ(refusal(flat_sheet(), -1.0), "accepted");
}

}  // namespace
}  // namespace incise
