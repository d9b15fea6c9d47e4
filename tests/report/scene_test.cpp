#include "report/scene.hpp"

#include "report/markup.hpp"
#include "report/ring_fixture.hpp"

#include <incise/core/error.hpp>
#include <incise/report/html_report.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace incise {
namespace {

using testing::decoded_base64;

unsigned number_at(const std::string& bytes, std::size_t at, int count) {
  unsigned value = 0;
  for (int k = count - 1; k >= 0; --k)
    value = value << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(k)]);
  return value;
}

/// Corner `corner` of triangle `triangle` of a frame's outer part, mm.
Vec3 corner_of(const nlohmann::ordered_json& scene, std::size_t frame, std::size_t triangle, std::size_t corner) {
  const int size = scene["index_bytes"];
  const std::string indices = decoded_base64(scene["frames"][frame]["outer"].get<std::string>());
  const std::string positions = decoded_base64(scene["frames"][frame]["positions"].get<std::string>());
  const unsigned vertex = number_at(indices, (3 * triangle + corner) * static_cast<std::size_t>(size), size);
  Vec3 p;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = scene["low"][static_cast<std::size_t>(axis)];
    const double step = scene["step_mm"][static_cast<std::size_t>(axis)];
    p[axis] = low + step * number_at(positions, 6 * vertex + 2 * static_cast<std::size_t>(axis), 2);
  }
  return p;
}

TEST(AnimationJson, GivesPositionsBackToHalfAStep) {
  const ReportAnimation animation = testing::RingFixture(4.0).animation("Before", 3);
  const auto scene = animation_json(animation, 10'000'000);
  ASSERT_EQ(scene["frames"].size(), animation.frames.size());
  // The box is at most 66 mm long: half a step of 1/65535 is 0.0005 mm.
  for (const std::size_t frame : {std::size_t{0}, std::size_t{2}}) {
    std::size_t outer = 0;
    for (std::size_t k = 0; k < animation.frames[frame].skin.size(); ++k) {
      if (animation.frames[frame].is_kerf[k] != 0) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3& expected = vertex(animation.frames[frame].positions_mm, animation.frames[frame].skin[k][c]);
        EXPECT_LT((corner_of(scene, frame, outer, c) - expected).cwiseAbs().maxCoeff(), 0.0006);
      }
      ++outer;
    }
    EXPECT_EQ(decoded_base64(scene["frames"][frame]["outer"].get<std::string>()).size(), 6 * outer);
  }
}

TEST(AnimationJson, LeavesOutVerticesThatNoSkinUses) {
  const testing::RingFixture fixture(4.0);
  ReportAnimation animation{
      .name = "rest", .frames = {frame_of(fixture.mesh, skin_faces(fixture.mesh), fixture.mesh.vertices, {})}};
  const auto scene = animation_json(animation, 10'000'000);
  // 16 x 12 x 4 grid points, of which 14 x 10 x 2 lie inside.
  EXPECT_EQ(scene["vertices"].get<int>(), 16 * 12 * 4 - 14 * 10 * 2);
}

TEST(AnimationJson, KeepsEvenlySpacedFramesWhenTheyDoNotAllFit) {
  const ReportAnimation animation = testing::RingFixture(4.0).animation("Before", 9);  // 11 frames
  const std::size_t all = animation_json(animation, 10'000'000).dump().size();
  const auto scene = animation_json(animation, all / 2);
  EXPECT_LT(scene.dump().size(), all / 2 + 20'000);  // lines and names do not count
  EXPECT_EQ(scene["total_frames"].get<int>(), 11);
  EXPECT_GE(scene["frames"].size(), 3U);
  EXPECT_LT(scene["frames"].size(), 7U);
  EXPECT_EQ(scene["frames"].front()["phase"], "rest");
  EXPECT_DOUBLE_EQ(scene["frames"].back()["time_s"].get<double>(), animation.frames.back().time_s);
}

TEST(MeshJson, HoldsEveryTet) {
  const TetMesh mesh = make_block({2.0, 1.0, 1.0}, {2, 1, 1});
  const auto scene = mesh_json(mesh);
  EXPECT_EQ(scene["tet_count"].get<int>(), 12);
  EXPECT_EQ(decoded_base64(scene["tets"].get<std::string>()).size(), 12U * 4U * 2U);
  EXPECT_EQ(decoded_base64(scene["positions"].get<std::string>()).size(), 12U * 6U);
}

TEST(ScriptJson, CannotEndItsScriptElement) {
  EXPECT_EQ(script_json({{"name", "</script>"}}), "{\"name\":\"\\u003c/script>\"}");
}

TEST(FramePng, IsAPngOfTheSizeAskedFor) {
  const ReportAnimation animation = testing::RingFixture(4.0).animation("Before", 2);
  const std::string png = frame_png(animation, 2, -Vec3::UnitZ(), 160, 90);
  ASSERT_GT(png.size(), 24U);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(static_cast<unsigned char>(png[19]), 160);  // width, big endian, bytes 16 to 19
  EXPECT_EQ(static_cast<unsigned char>(png[23]), 90);
  EXPECT_THROW(static_cast<void>(frame_png(animation, 99, -Vec3::UnitZ(), 160, 90)), InvalidArgument);
}

TEST(FrameFigure, SaysWhatItShowsHowLargeAndThatItIsSimulated) {
  const ReportAnimation animation = testing::RingFixture(4.0).animation("Before", 2);
  const std::string figure = frame_figure_svg(animation, 2, -Vec3::UnitZ(), 600, 300);
  for (const char* text : {"Before (simulated)", "data:image/png;base64,", ">tissue<", ">kerf<", ">needle<", ">tumour edge<", ">10 mm, "}) {
    EXPECT_NE(figure.find(text), std::string::npos) << text;
  }
}

TEST(FrameFigure, ItsScaleBarIsAsLongAsWhatItMeasures) {
  // A line of 10 mm across the line of sight, alone in the picture: it fills 92 % of the width, and so does the bar.
  const Vec3 across = Vec3(std::cos(-0.6), std::sin(-0.6), 0.0);
  ReportAnimation animation{.name = "line"};
  animation.lines.push_back({LineKind::TumorEdge, {{Vec3::Zero(), 10.0 * across}, false}});
  animation.frames.emplace_back();
  const std::string figure = frame_figure_svg(animation, 0, -Vec3::UnitZ(), 500, 400);
  const std::size_t bar = figure.find("stroke-width=\"3\"");
  ASSERT_NE(bar, std::string::npos);
  const std::string element = figure.substr(figure.rfind('<', bar), bar - figure.rfind('<', bar));
  const auto number = [&element](const std::string& name) {
    return std::stod(element.substr(element.find(" " + name + "=\"") + name.size() + 3));
  };
  EXPECT_NEAR(number("x2") - number("x1"), 0.92 * 500.0, 0.1) << element;
}

}  // namespace
}  // namespace incise
