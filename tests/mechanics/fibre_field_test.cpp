// Fibres that run from one region to another.
#include "mechanics/bodies.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/fibre_field.hpp>

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace incise {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::irregular_block;
using testing::plane_x;

const Vec3 kBlockMm(20, 12, 9);

/// The largest sine of the angle between a direction and x, over the tets.
double largest_deviation_from_x(const FibreDirections& found) {
  double largest = 0.0;
  for (const Vec3& direction : found.directions) largest = std::max(largest, direction.cross(Vec3::UnitX()).norm());
  return largest;
}

TEST(FibreField, IsExactBetweenTwoFacesOfABlock) {
  const TetMesh mesh = irregular_block(kBlockMm, {10, 6, 5}, 0.2, 7);
  const FibreDirections found = fibre_directions(mesh, {plane_x(0.0), plane_x(20.0)});
  ASSERT_EQ(found.outcome, Outcome::Success);
  ASSERT_EQ(found.directions.size(), mesh.tets.size());
  EXPECT_EQ(found.flat_tets, 0U);
  EXPECT_GT(found.iterations, 0);
  EXPECT_LE(found.residual, 1e-12);
  EXPECT_LT(largest_deviation_from_x(found), 1e-8);
  for (const Vec3& direction : found.directions) EXPECT_GT(direction.x(), 0.0) << "from `from` to `to`";
}

/// Within the regions and beyond them the potential does not change.
TEST(FibreField, GivesTetsWithoutAGradientTheDirectionOfTheirNeighbours) {
  const TetMesh mesh = irregular_block(kBlockMm, {20, 4, 3}, 0.2, 7);
  const Region slab = PlaneRegion{Vec3(14, 0, 0), Vec3::UnitX(), 2.4};
  const FibreDirections found = fibre_directions(mesh, {EndRegion{-Vec3::UnitX(), 4.5}, slab});
  ASSERT_EQ(found.outcome, Outcome::Success);
  const std::size_t tets_in_a_layer = std::size_t{6} * 4 * 3;
  EXPECT_EQ(found.flat_tets, (4 + 8) * tets_in_a_layer) << "in the end and from the slab on";
  // The sides of the regions are not plane in an irregular mesh, and fibres are perpendicular to them.
  EXPECT_LT(largest_deviation_from_x(found), 0.5);
  const TetMesh regular = make_block(kBlockMm, {20, 4, 3});
  EXPECT_LT(largest_deviation_from_x(fibre_directions(regular, {EndRegion{-Vec3::UnitX(), 4.5}, slab})), 1e-8);
}

/// From both ends to a slab: within it, directions that point against each other meet.
TEST(FibreField, TakesFibresThatPointAgainstEachOtherAsOneDirection) {
  TetMesh mesh = make_block(kBlockMm, {20, 4, 3});
  DataArray end{1, {}};
  for (const Vec3& p : mesh.vertices) end.values.push_back(std::abs(p.x() - 10.0) > 9.9 ? 1.0 : 0.0);
  mesh.point_data["end"] = std::move(end);
  const FibreDirections found =
      fibre_directions(mesh, {PointArrayRegion{"end", 1.0}, PlaneRegion{Vec3(9.5, 0, 0), Vec3::UnitX(), 2.6}});
  EXPECT_EQ(found.flat_tets, std::size_t{5} * 6 * 4 * 3);
  EXPECT_LT(largest_deviation_from_x(found), 1e-8);
}

TEST(FibreField, NeedsNoVertexBetweenItsRegions) {
  const TetMesh mesh = make_block(Vec3(1, 3, 3), {1, 3, 3});
  EXPECT_LT(largest_deviation_from_x(fibre_directions(mesh, {plane_x(0.0), plane_x(1.0)})), 1e-14);
}

/// A quarter of a ring of radii 10 and 16 mm about z, from its end at y = 0 to that at x = 0.
TetMesh quarter_ring(int cells) {
  TetMesh mesh = make_block(Vec3(1, 1, 1), {3 * cells, cells, cells});
  for (Vec3& p : mesh.vertices) {
    const double angle = 0.5 * std::numbers::pi * (1.0 - p.x()), radius = 10.0 + 6.0 * p.y();
    p = Vec3(radius * std::cos(angle), radius * std::sin(angle), 5.0 * p.z());
  }
  return mesh;
}

/// Root mean square, by volume, of the angle between the fibres and the circles about z.
double deviation_from_circles(int cells) {
  const TetMesh mesh = quarter_ring(cells);
  const FibreDirections found = fibre_directions(
      mesh, {PlaneRegion{Vec3::Zero(), Vec3::UnitY(), 1e-6}, PlaneRegion{Vec3::Zero(), Vec3::UnitX(), 1e-6}});
  EXPECT_EQ(found.outcome, Outcome::Success);
  double sum = 0.0, volume = 0.0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    std::array<Vec3, 4> corners;
    for (std::size_t c = 0; c < 4; ++c) corners[c] = vertex(mesh.vertices, mesh.tets[t][c]);
    const Vec3 middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
    const double angle = std::acos(std::min(1.0, found.directions[t].dot(Vec3::UnitZ().cross(middle).normalized())));
    const double own = signed_volume(corners[0], corners[1], corners[2], corners[3]);
    sum += own * angle * angle;
    volume += own;
  }
  return std::sqrt(sum / volume);
}

TEST(FibreField, FollowsTheCirclesOfARingTheBetterTheFinerTheMesh) {
  const double coarse = deviation_from_circles(3), middle = deviation_from_circles(6),
               fine = deviation_from_circles(12);
  RecordProperty("coarse", std::to_string(coarse));
  RecordProperty("middle", std::to_string(middle));
  RecordProperty("fine", std::to_string(fine));
  EXPECT_LT(coarse, 0.1);
  EXPECT_GT(coarse / middle, 1.7) << coarse << " and " << middle << ": linear tets are of first order in the gradient";
  EXPECT_GT(middle / fine, 1.7) << middle << " and " << fine;
}

std::string field_refusal(const TetMesh& mesh, const FibreField& field) {
  return testing::refusal_of<CaseError>([&] { return fibre_directions(mesh, field); });
}

TEST(FibreField, RefusesRegionsThatDoNotFitTheMesh) {
  const TetMesh mesh = make_block(kBlockMm, {4, 3, 3});
  EXPECT_THAT(
      field_refusal(mesh, {plane_x(0.0), plane_x(30.0)}),
      AllOf(HasSubstr("specimen.material.fibre_field.to: found a region without any vertex"), HasSubstr("20, 12, 9")));
  EXPECT_THAT(field_refusal(mesh, {plane_x(1.0), plane_x(20.0)}), HasSubstr("specimen.material.fibre_field.from"));
  EXPECT_THAT(
      field_refusal(mesh, {EndRegion{-Vec3::UnitX(), 11.0}, EndRegion{Vec3::UnitX(), 11.0}}),
      AllOf(HasSubstr("specimen.material.fibre_field.to: found vertex 2 at"), HasSubstr("apart from each other")));
  EXPECT_THAT(field_refusal(mesh, {PointArrayRegion{"origin", 1.0}, plane_x(20.0)}),
              AllOf(HasSubstr("specimen.material.fibre_field.from: found an unusable region"), HasSubstr("'origin'")));
}

TEST(FibreField, SaysWhenItsPotentialDoesNotConverge) {
  const FibreDirections found =
      fibre_directions(irregular_block(kBlockMm, {10, 6, 5}, 0.2, 7), {plane_x(0.0), plane_x(20.0)}, 5);
  EXPECT_EQ(found.outcome, Outcome::NotConverged);
  EXPECT_TRUE(found.directions.empty());
  EXPECT_EQ(found.iterations, 5);
  EXPECT_GT(found.residual, 1e-12);
}

TEST(FibreField, NeedsASoundMesh) {
  TetMesh mesh = make_block(kBlockMm, {4, 3, 3});
  mesh.vertices.emplace_back(1, 1, 1);
  EXPECT_THROW(static_cast<void>(fibre_directions(mesh, {plane_x(0.0), plane_x(20.0)})), InvalidArgument);
}

}  // namespace
}  // namespace incise
