#include "cutting/ring_in_a_block.hpp"
#include "support/monitors.hpp"

#include <incise/core/memory.hpp>
#include <incise/cutting/incision_memory.hpp>

#include <malloc.h>

#include <fstream>

namespace incise {
namespace {

/// Lets the peak of this process begin anew from what it holds now. @returns whether the system can.
bool reset_peak() {
  malloc_trim(0);
  std::ofstream reset("/proc/self/clear_refs");
  reset << "5";
  reset.close();
  return reset.good() && peak_memory_bytes().has_value();
}

class IncisionMemory : public testing::RingInABlock {
 protected:
  // Some systems do not let a process begin its peak anew: there is nothing to hold the estimate against.
  void SetUp() override {
    if (!reset_peak()) GTEST_SKIP() << "this system does not tell the peak of a process";
  }

  /// What a cut of a block of 32 x 32 x 8 mm was expected to take, over what it took.
  [[nodiscard]] double expected_over_measured(const std::array<int, 3>& cells, VolumeTreatment volume) const {
    TetMesh mesh = make_block({32, 32, 8}, cells);
    const double expected =
        static_cast<double>(expected_memory_bytes(mesh.vertices.size(), mesh.tets.size(), volume, 0));
    Material material{.volume = volume};
    const std::uint64_t before = *peak_memory_bytes();
    const TissueModel model = make_tissue_model(
        std::move(mesh), material, {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(33, 33, 0.1))}}});
    const TissueState stretched = rest_state(model);
    Workers workers(1);
    testing::StopAfter monitor(3);  // by then all is held that a cut holds, but for frames
    EXPECT_EQ(simulate_incision(model, stretched, ring(4.0), settings_, workers, monitor).outcome, Outcome::Cancelled);
    return expected / static_cast<double>(*peak_memory_bytes() - before);
  }
};

TEST_F(IncisionMemory, OfTheDemosSizeIsWithinThirtyPercentOfWhatWasExpected) {
  EXPECT_NEAR(expected_over_measured({32, 32, 7}, VolumeTreatment::PerTet), 1.0, 0.3);
}

TEST_F(IncisionMemory, WithAveragedVolumeIsWithinThirtyPercentOfWhatWasExpected) {
  EXPECT_NEAR(expected_over_measured({22, 22, 6}, VolumeTreatment::Averaged), 1.0, 0.3);
}

TEST_F(IncisionMemory, OfACutByPointsIsWithinThirtyPercentOfWhatWasExpected) {
  settings_.cut.rule = CutRule::Lattice;
  settings_.cut.dullness = 5.4;
  Workers workers(1);
  Monitor silent;
  for (const std::array<int, 3> cells : {std::array{22, 22, 6}, std::array{40, 40, 10}}) {
    TetMesh mesh = make_block({32, 32, 8}, cells);
    ASSERT_TRUE(reset_peak());
    const std::uint64_t before = *peak_memory_bytes();
    const std::uint64_t of_model =
        expected_memory_bytes(mesh.vertices.size(), mesh.tets.size(), VolumeTreatment::PerTet, 0);
    const TissueModel model = make_tissue_model(
        std::move(mesh), Material{}, {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(33, 33, 0.1))}}});
    const IncisionResult done = simulate_incision(model, rest_state(model), ring(4.0), settings_, workers, silent);
    ASSERT_EQ(done.outcome, Outcome::Success);  // measuring the kerf takes most
    const std::uint64_t expected =
        of_model + expected_point_memory_bytes(of_model, model.volumes_mm3, length_mm(entry_contour(ring(4.0))), 4.0,
                                               settings_.cut);
    EXPECT_NEAR(static_cast<double>(expected) / static_cast<double>(*peak_memory_bytes() - before), 1.0, 0.3)
        << model.mesh.tets.size() << " tets";
  }
}

TEST(ExpectedMemory, GrowsByWhatTheFramesHold) {
  const auto without = expected_memory_bytes(1000, 5000, VolumeTreatment::PerTet, 0);
  EXPECT_EQ(expected_memory_bytes(1000, 5000, VolumeTreatment::PerTet, 10) - without, 10U * 24 * 1000);
}

TEST(ExpectedMemory, OfPointsIsLimitedByTheBodyAndGrowsWithTheNumberOfFineTets) {
  const CutSettings cut;
  const auto of_points = [&cut](std::size_t tets, double volume_mm3, double length_mm) {
    return expected_point_memory_bytes(0, std::vector<double>(tets, volume_mm3), length_mm, 5.0, cut);
  };
  EXPECT_EQ(of_points(0, 1.0, 100.0), 0U);
  EXPECT_EQ(of_points(1000, 1.0, 1e3), of_points(1000, 1.0, 1e6)) << "the whole body is touched";
  EXPECT_GT(of_points(100000, 1.0, 100.0), of_points(100000, 1.0, 50.0));
  EXPECT_GT(of_points(1000000, 0.02, 1e6), 2 * of_points(20000, 1.0, 1e6)) << "tets with points of their own";
}

}  // namespace
}  // namespace incise
