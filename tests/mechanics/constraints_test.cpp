#include "mechanics/bodies.hpp"
#include "support/refusal.hpp"

#include <incise/core/described_bytes.hpp>
#include <incise/core/error.hpp>
#include <incise/mechanics/constraints.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <limits>

namespace incise {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// 3 x 2 x 2 vertices at x = 0, 10, 20, y and z = 0, 10; x fastest.
TetMesh small_block() {
  return make_block(Vec3(20, 10, 10), {2, 1, 1});
}

TEST(Select, BoxTakesVerticesInsideAndOnItsFaces) {
  const Box3 box(Vec3(10, 0, 0), Vec3(15, 5, 10));
  EXPECT_THAT(select(small_block(), BoxRegion{box}), ElementsAre(VertexId{1}, VertexId{7}));
}

TEST(Select, SphereTakesVerticesWithinItsRadius) {
  EXPECT_THAT(select(small_block(), SphereRegion{Vec3::Zero(), 10.0}),
              ElementsAre(VertexId{0}, VertexId{1}, VertexId{3}, VertexId{6}));
}

TEST(Select, EndIsMeasuredFromTheExtremePointOfTheBody) {
  EXPECT_THAT(select(small_block(), EndRegion{-Vec3::UnitX(), 1.0}), SizeIs(4));
  EXPECT_THAT(select(small_block(), EndRegion{Vec3::UnitX(), 10.0}), SizeIs(8));
}

TEST(Select, PlaneWithADistanceIsABandOnBothItsSides) {
  PlaneRegion region{Vec3(10, 0, 0), Vec3(3, 0, 0), 0.5};
  EXPECT_THAT(select(small_block(), region), ElementsAre(VertexId{1}, VertexId{4}, VertexId{7}, VertexId{10}));
  region.within_mm = 10.0;
  EXPECT_THAT(select(small_block(), region), SizeIs(12));
}

TEST(Select, PlaneWithoutADistanceTakesTheNormalsSide) {
  EXPECT_THAT(select(small_block(), PlaneRegion{Vec3(10, 0, 0), Vec3(1, 0, 0), {}}), SizeIs(8));
  EXPECT_THAT(select(small_block(), PlaneRegion{Vec3(10, 0, 0), Vec3(-1, -1, 0), {}}),
              ElementsAre(VertexId{0}, VertexId{1}, VertexId{3}, VertexId{6}, VertexId{7}, VertexId{9}));
}

TEST(Select, PatchTakesTheSkinNearAPaintedLine) {
  const TetMesh mesh = make_block(Vec3(20, 20, 20), {4, 4, 4});
  const PatchRegion region{{Vec3(0, 10, 20), Vec3(10, 10, 20)}, 5.0};
  const std::vector<VertexId> held = select(mesh, region);
  EXPECT_EQ(held.size(), 11U);  // three along the line, as many on either side, one beyond each end
  for (const VertexId v : held) EXPECT_GE(mesh.vertices[v.index()].z(), 15.0);
  EXPECT_THAT(select(mesh, PatchRegion{{Vec3(10, 10, 10)}, 4.9}), IsEmpty());  // inside the body is no skin
}

TEST(Select, CellArrayTakesTheCornersOfItsTets) {
  TetMesh mesh = small_block();
  mesh.cell_data["label"] = {1, std::vector<double>(12, 1.0)};
  mesh.cell_data["label"].values[0] = 2.0;
  std::vector<VertexId> corners(mesh.tets[0].begin(), mesh.tets[0].end());
  std::sort(corners.begin(), corners.end());
  EXPECT_EQ(select(mesh, CellArrayRegion{"label", 2.0}), corners);
  EXPECT_THAT(select(mesh, CellArrayRegion{"label", 1.0}), SizeIs(12));
  EXPECT_THROW(static_cast<void>(select(mesh, CellArrayRegion{"labels", 2.0})), InvalidArgument);
}

TEST(Select, RegionsThatAreNotOneAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Region bad[] = {BoxRegion{Box3(Vec3(0, nan, 0), Vec3(1, 1, 1))},
                        BoxRegion{Box3(Vec3(2, 0, 0), Vec3(1, 1, 1))},
                        SphereRegion{Vec3(0, 0, 0), -1.0},
                        SphereRegion{Vec3(0, 0, 0), nan},
                        EndRegion{Vec3(2, 0, 0), 1.0},
                        EndRegion{Vec3::UnitX(), nan},
                        PlaneRegion{Vec3(nan, 0, 0), Vec3::UnitX(), {}},
                        PlaneRegion{Vec3::Zero(), Vec3::Zero(), {}},
                        PlaneRegion{Vec3::Zero(), Vec3::UnitX(), -1.0},
                        PlaneRegion{Vec3::Zero(), Vec3::UnitX(), nan},
                        PatchRegion{{}, 1.0},
                        PatchRegion{{Vec3::Zero()}, nan}};
  for (std::size_t i = 0; i < std::size(bad); ++i) {
    EXPECT_THROW(static_cast<void>(select(small_block(), bad[i])), InvalidArgument) << "region " << i;
  }
}

TEST(Select, PointArrayTakesItsValue) {
  TetMesh mesh = small_block();
  mesh.point_data["part"] = {1, {0, 0, 3, 0, 0, 0, 0, 3, 0, 0, 0, 0}};
  EXPECT_THAT(select(mesh, PointArrayRegion{"part", 3.0}), ElementsAre(VertexId{2}, VertexId{7}));
}

TEST(Select, AnUnknownArrayIsToldWithTheKnownOnes) {
  TetMesh mesh = small_block();
  mesh.point_data["part"] = {1, std::vector<double>(12, 0.0)};
  EXPECT_THAT(testing::refusal_of<InvalidArgument>([&] {
                return select(mesh, PointArrayRegion{"prat", 3.0});
              }),
              ::testing::HasSubstr("expected a point array named 'prat', found 'part'"));
}

TEST(Select, ARegionOutsideTheBodyIsEmpty) {
  EXPECT_THAT(select(small_block(), SphereRegion{Vec3(0, 0, 99), 1.0}), IsEmpty());
}

TEST(Constraint, IsTheSameAgainFromItsBytesWhateverItsRegion) {
  const Region regions[] = {BoxRegion{Box3(Vec3(1, 2, 3), Vec3(4, 5, 6))},
                            SphereRegion{Vec3(1, 2, 3), 4.0},
                            EndRegion{Vec3::UnitZ(), 3.0},
                            PlaneRegion{Vec3(1, 2, 3), Vec3(0, 0, 2), 0.1},
                            CellArrayRegion{"part", 0.1},
                            PointArrayRegion{"clamp", -2.0},
                            PatchRegion{{Vec3(1, 2, 3), Vec3(4, 5, 6)}, 2.5}};
  std::vector<Constraint> all;
  for (const Region& region : regions) all.emplace_back(FixedConstraint{region, {true, false, true}});
  all.emplace_back(DisplacedConstraint{regions[0], Vec3(0, 20, 0)});
  all.emplace_back(SupportConstraint{Vec3(1, 2, 3), Vec3::UnitX(), nullptr});
  all.emplace_back(TractionConstraint{regions[1], Vec3(0, 0, 1)});
  const auto back = from_bytes<std::vector<Constraint>>(bytes_of(all), "test");
  EXPECT_EQ(bytes_of(back), bytes_of(all));
  EXPECT_EQ(std::get<CellArrayRegion>(std::get<FixedConstraint>(back[4]).where).value, 0.1);
  EXPECT_FALSE(std::get<FixedConstraint>(back[0]).axes[1]);
}

TEST(Constraint, IsKnownByTheSurfaceOfItsHolderNotByTheFilesName) {
  TriMesh surface{.vertices = {Vec3(0, 0, 0), Vec3(9, 0, 0), Vec3(0, 9, 0)}};
  const auto bytes = [](const std::string& name, const TriMesh& of) {
    return bytes_of(Constraint(SupportConstraint{.holder = std::make_shared<HolderSurface>(HolderSurface{name, of})}));
  };
  EXPECT_EQ(bytes("a.stl", surface), bytes("b.stl", surface));
  EXPECT_NE(bytes("a.stl", surface), bytes("a.stl", TriMesh{}));
}

}  // namespace
}  // namespace incise
