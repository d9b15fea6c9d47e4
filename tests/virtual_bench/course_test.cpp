#include <incise/core/error.hpp>
#include <incise/virtual_bench/course.hpp>
#include <incise/virtual_bench/readings.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

RobotProgram square_program() {
  ToolPath path{.frame = PathFrame::Robot};
  for (const Vec3& p : {Vec3(600, -15, 180), Vec3(615, 0, 180), Vec3(600, 15, 180), Vec3(585, 0, 180)})
    path.waypoints.push_back({p});
  return make_program(path);
}

Specimen without_errors() {
  Specimen specimen;
  specimen.robot_wander_mm = 0.0;
  return specimen;
}

TEST(TipCourse, AnArmWithoutErrorsGoesWhereTheProgramSays) {
  const RobotProgram program = square_program();
  const std::vector<TipPose> course = tip_course(asked_course(program), without_errors(), Mat4::Identity());
  ASSERT_EQ(course.size(), program.poses.size());
  for (std::size_t i = 0; i < course.size(); ++i) {
    EXPECT_LT((course[i].tip_mm - program.poses[i].tip_mm).norm(), 1e-9);
    EXPECT_LT((course[i].axis + Vec3::UnitZ()).norm(), 1e-9);
    const ProgramPhase phase = program.poses[i].phase;
    EXPECT_EQ(course[i].is_cutting, phase == ProgramPhase::Plunge || phase == ProgramPhase::Cut ||
                                        phase == ProgramPhase::Overlap || phase == ProgramPhase::Dwell);
  }
}

TEST(TipCourse, OffsetsOfTheArmMoveEveryTipAndWanderingHasTheStatedSpread) {
  Specimen specimen = without_errors();
  specimen.robot_offset_x_mm = 0.4;
  specimen.robot_offset_z_mm = -0.2;
  const RobotProgram program = square_program();
  const std::vector<TipPose> moved = tip_course(asked_course(program), specimen, Mat4::Identity());
  for (std::size_t i = 0; i < moved.size(); ++i)
    EXPECT_LT((moved[i].tip_mm - program.poses[i].tip_mm - Vec3(0.4, 0.0, -0.2)).norm(), 1e-9);
  double squares = 0.0;
  std::size_t count = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    specimen = without_errors();
    specimen.seed = seed;
    specimen.robot_wander_mm = 0.1;
    const std::vector<TipPose> course = tip_course(asked_course(program), specimen, Mat4::Identity());
    for (std::size_t i = 0; i < course.size(); ++i, count += 3)
      squares += (course[i].tip_mm - program.poses[i].tip_mm).squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(count)), 0.1, 0.02);
}

TEST(TipCourse, TransformsLieAsTheirNamesSay) {
  Specimen specimen = without_errors();
  specimen.placement_turn_deg = 10.0;
  specimen.camera_tilt_deg = 5.0;
  const Mat4 T_robot_sim = T_robot_specimen(placement_of(specimen));
  const Mat3 turn = T_robot_sim.topLeftCorner<3, 3>();
  EXPECT_NEAR(turn.determinant(), 1.0, 1e-12);
  const Mat4 camera = T_robot_camera(placement_of(specimen));
  const Mat3 look = camera.topLeftCorner<3, 3>();
  EXPECT_LT((look * look.transpose() - Mat3::Identity()).norm(), 1e-12);
  EXPECT_NEAR(look.determinant(), 1.0, 1e-12);
  EXPECT_LT(camera(2, 2), -0.99) << "the camera looks down";
}

TEST(TipCourse, RefusesAProgramWithoutACourse) {
  EXPECT_THROW(static_cast<void>(asked_course(RobotProgram{})), InvalidArgument);
}

}  // namespace
}  // namespace incise
