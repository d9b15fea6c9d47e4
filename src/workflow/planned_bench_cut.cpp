#include <incise/core/error.hpp>
#include <incise/robot/program.hpp>
#include <incise/virtual_bench/course.hpp>
#include <incise/workflow/planned_bench_cut.hpp>

namespace incise {
namespace {

constexpr double kRingOverlapMm = 8.0;  // as `incise export` has it

}  // namespace

BenchCut cut_as_planned(const BenchBody& body, const PlanSettings& plan, Workers& workers, Monitor& monitor) {
  INCISE_REQUIRE(body.outcome != Outcome::NotConverged, "expected a stretched body, found one without equilibrium");
  const SurfaceQuery skin(skin_at(body, body.stretched.positions));
  ToolPath path = plan_ring(skin, tumor_edge_at(body, body.stretched.positions), plan);
  path.frame = PathFrame::Robot;  // the robot's base is taken to be the specimen's frame: program poses need no other
  ProgramSettings settings;
  settings.plunge_speed_mm_s = plan.speed_mm_s;
  settings.overlap_mm = kRingOverlapMm;
  const RobotProgram program = make_program(path, settings);
  const std::vector<TipPose> course = tip_course(asked_course(program), body.specimen, Mat4::Identity());
  return cut_specimen(body, course, plan.power_w, workers, monitor);
}

}  // namespace incise
