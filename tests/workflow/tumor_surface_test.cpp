#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/workflow/study.hpp>

#include <gmock/gmock.h>

namespace incise {
namespace {

/// A block of 20 x 20 x 10 mm whose stretched state is itself moved by 3 mm along x.
class TumorSurface : public ::testing::Test {
 protected:
  TumorSurface()
      : model_(make_tissue_model(make_block({20, 20, 10}, {5, 5, 4}), Material{},
                                 {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(21, 21, 0.1))}}})),
        stretched_(model_.mesh.vertices) {
    for (Vec3& p : stretched_) p.x() += 3.0;
  }

  /// A closed box whose lowest corner is `low`, 4 x 4 x 2 mm.
  static TriMesh box(const Vec3& low) {
    TriMesh surface = boundary_surface(make_block({4, 4, 2}, {1, 1, 1}));
    for (Vec3& p : surface.vertices) p += low;
    return surface;
  }
  /// The edge of such a box, drawn at this height.
  static Contour edge(double z) { return {{Vec3(8, 8, z), Vec3(12, 8, z), Vec3(12, 12, z), Vec3(8, 12, z)}, true}; }

  TissueModel model_;
  Points stretched_;
  Case settings_;
};

TEST_F(TumorSurface, IsLaidDownAsFarAsItsEdge) {
  const TriMesh placed = tumor_in_stretched(settings_, model_, stretched_, box(Vec3(8, 8, 9.5)), edge(11.5));
  const Box3 bounds = bounding_box(placed.vertices);
  EXPECT_NEAR(bounds.max().z(), 10.0, 1e-9) << "the edge was drawn 1.5 mm above the skin";
  EXPECT_NEAR(bounds.min().z(), 8.0, 1e-9);
  EXPECT_NEAR(bounds.min().x(), 8.0, 1e-12) << "drawn on the stretched tissue: it is not moved along";
}

TEST_F(TumorSurface, DrawnOnTheTissueAsScannedIsCarriedAlong) {
  settings_.tumor_configuration = TumorConfiguration::Rest;
  const TriMesh placed = tumor_in_stretched(settings_, model_, stretched_, box(Vec3(8, 8, 8)), edge(10.0));
  EXPECT_NEAR(bounding_box(placed.vertices).min().x(), 11.0, 1e-9);
  EXPECT_NEAR(bounding_box(placed.vertices).max().z(), 10.0, 1e-9);
}

TEST_F(TumorSurface, WithoutAnEdgeIsTakenAsItLies) {
  EXPECT_EQ(tumor_in_stretched(settings_, model_, stretched_, box(Vec3(8, 8, 5)), std::nullopt).vertices,
            box(Vec3(8, 8, 5)).vertices);
}

TEST_F(TumorSurface, FarFromTheTissueIsRefusedByVertex) {
  const auto error = testing::error_of<CaseError>(
      [&] { return tumor_in_stretched(settings_, model_, stretched_, box(Vec3(8, 8, 30)), std::nullopt); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->field(), "surface");
  EXPECT_THAT(error->what(), ::testing::HasSubstr("vertex 0 at (8.00, 8.00, 30.00) mm"));
}

}  // namespace
}  // namespace incise
