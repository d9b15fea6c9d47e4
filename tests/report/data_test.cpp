#include "report/ring_fixture.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/report/html_report.hpp>

#include <gmock/gmock.h>

#include <limits>

namespace incise {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(FindProblems, HasNoneInEmptyData) {
  EXPECT_THAT(find_problems(ReportData{}), IsEmpty());
}

TEST(FindProblems, HasNoneInAFullReport) {
  EXPECT_THAT(find_problems(testing::RingFixture(4.0).data(3)), IsEmpty());
}

TEST(FindProblems, NamesEachPlaceOfANumberThatIsNotFinite) {
  ReportData data = testing::RingFixture(4.0).data(2);
  data.incisions[1].signed_error_mm[5] = kNan;
  data.evaluation[0].after = std::numeric_limits<double>::infinity();
  data.animations[0].frames[1].positions_mm[7].y() = kNan;
  data.mesh.mesh.vertices[3].z() = kNan;
  EXPECT_THAT(find_problems(data),
              ElementsAre(HasSubstr("mesh: vertices: point 3"), HasSubstr("frame 1: positions: point 7"),
                          HasSubstr("incision \"After\": signed_error_mm"), HasSubstr("mean absolute error, after")));
}

TEST(FindProblems, NamesListsOfUnequalLength) {
  ReportData data = testing::RingFixture(4.0).data(2);
  data.incisions[0].signed_error_mm.pop_back();
  data.animations[0].frames[0].is_kerf.pop_back();
  data.tables[0].rows[1].pop_back();
  const auto problems = find_problems(data);
  EXPECT_THAT(problems, Contains(HasSubstr("one error per point, found 71 for 72")));
  EXPECT_THAT(problems, Contains(HasSubstr("one kerf flag per triangle")));
  EXPECT_THAT(problems, Contains(HasSubstr("Calibration of speed and dullness")));
}

TEST(FindProblems, NamesWhatIsWrongWithTheKerfAndTheCorrection) {
  ReportData data = testing::RingFixture(4.0).data(2);
  data.incisions[0].kerf_allowance_mm = kNan;
  data.kerf_plots = {
      {.title = "Depth of the kerf", .x_label = "way, mm", .y_label = "mm", .series = {{"before", {0, 1}, {4, kNan}}}}};
  data.kerf_layers = {"Mid-line by depth", {"cut", "depth, mm"}, {{"as planned", "2.50"}, {"corrected"}}};
  data.correction = {"Pass by pass", {"pass", "mean, mm"}, {{"1"}}};
  data.correction_plots = {{.title = "Mean error against the pass", .x_label = "pass", .y_label = "mm", .series = {}}};
  EXPECT_THAT(find_problems(data),
              ElementsAre(HasSubstr("incision \"Before\": kerf_allowance_mm: is not a finite number"),
                          HasSubstr("plot \"Depth of the kerf\": series \"before\": expected numbers that the axis can "
                                    "show, found nan"),
                          HasSubstr("table \"Mid-line by depth\": has a row whose length"),
                          HasSubstr("table \"Pass by pass\": has a row whose length"),
                          HasSubstr("plot \"Mean error against the pass\": expected at least one series")));
}

TEST(FindProblems, NamesIndicesOutOfRangeAndAZeroDirection) {
  ReportData data = testing::RingFixture(4.0).data(2);
  data.mesh.mesh.tets[0][1] = VertexId{data.mesh.mesh.vertices.size()};
  data.animations[0].frames[2].skin[0][0] = VertexId{};
  data.approach = Vec3::Zero();
  const auto problems = find_problems(data);
  EXPECT_THAT(problems, Contains(HasSubstr("mesh: tets: has an index out of range")));
  EXPECT_THAT(problems, Contains(HasSubstr("frame 2: skin: has an index out of range")));
  EXPECT_THAT(problems, Contains(HasSubstr("approach")));
}

TEST(HtmlReport, RefusesWhatHasProblemsAndListsThem) {
  ReportData data{.stages = {{"mesh", "done", kNan}}, .checks = {{"speed", "mm/s", 1.0, "<=", kNan, true}}};
  EXPECT_THAT(testing::refusal_of<InvalidArgument>([&] { return html_report(data); }),
              ::testing::AllOf(HasSubstr("stage mesh: wall_s"), HasSubstr("check speed: limit")));
}

TEST(FrameOf, MarksExactlyTheFacesThatTheCutLaidOpen) {
  const TetMesh mesh = make_block({2.0, 1.0, 1.0}, {2, 1, 1});  // two cells of six tets
  const auto on_skin = skin_faces(mesh);
  std::vector<std::uint8_t> is_live(12, 1);
  std::fill(is_live.begin() + 6, is_live.end(), std::uint8_t{0});  // the second cell goes
  const ReportFrame frame = frame_of(mesh, on_skin, mesh.vertices, is_live);
  ASSERT_EQ(frame.skin.size(), 12U);  // a cube has 6 sides of 2 triangles
  std::size_t kerf = 0;
  for (std::size_t k = 0; k < frame.skin.size(); ++k) {
    if (frame.is_kerf[k] == 0) continue;
    ++kerf;
    for (const VertexId id : frame.skin[k]) EXPECT_DOUBLE_EQ(mesh.vertices[id.index()].x(), 1.0);
  }
  EXPECT_EQ(kerf, 2U);
}

TEST(FrameOf, HasNoKerfBeforeTheCut) {
  const TetMesh mesh = make_block({3.0, 2.0, 1.0}, {3, 2, 1});
  const auto uncut = boundary_faces(mesh);
  const ReportFrame frame = frame_of(mesh, skin_faces(mesh), mesh.vertices, {});
  EXPECT_EQ(frame.skin.size(), uncut.size());
  EXPECT_THAT(frame.is_kerf, ::testing::Each(0));
}

TEST(FrameOf, RefusesPositionsOfAnotherMesh) {
  const TetMesh mesh = make_block({1.0, 1.0, 1.0}, {1, 1, 1});
  EXPECT_THROW(static_cast<void>(frame_of(mesh, skin_faces(mesh), Points(3, Vec3::Zero()), {})), InvalidArgument);
}

TEST(OccupancyOf, IsOneWhereverThereIsALabel) {
  LabelVolume labels{.grid = {.size = {3, 1, 1}}, .voxels = {0, 1, 7}};
  EXPECT_THAT(occupancy_of(labels).voxels, ElementsAre(0.0F, 1.0F, 1.0F));
}

}  // namespace
}  // namespace incise
