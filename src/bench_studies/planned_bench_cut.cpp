#include <incise/bench_studies/planned_bench_cut.hpp>
#include <incise/core/error.hpp>
#include <incise/robot/program.hpp>
#include <incise/virtual_bench/course.hpp>

namespace incise {
namespace {

/// Cuts along a path in the specimen's frame, as the specimen's arm would.
BenchCut cut_along(const BenchBody& body, ToolPath path, const PlanSettings& plan, Workers& workers, Monitor& monitor) {
  path.frame = PathFrame::Robot;  // the robot's base frame is taken as the specimen's frame
  const RobotProgram program = make_program(path, {.plunge_speed_mm_s = plan.speed_mm_s});
  const std::vector<TipPose> course = tip_course(asked_course(program), body.specimen, Mat4::Identity());
  return cut_specimen(body, course, plan.power_w, workers, monitor);
}

/// Returns points of a contour that are evenly spaced in the flat picture along the approach, as in true_errors_mm.
Points places_seen_even(const Contour& contour, std::size_t count, const Vec3& approach) {
  Contour flat = contour;
  for (Vec3& p : flat.points) p -= p.dot(approach) * approach;
  Points places;
  for (const Vec3& p : resample(flat, count).points) {
    const ContourPoint at = nearest_on(flat, p);
    const Vec3& start = contour.points[at.segment];
    const Vec3& end = contour.points[(at.segment + 1) % contour.points.size()];
    places.push_back(start + at.fraction * (end - start));
  }
  return places;
}

/// Returns the same specimen with an arm without errors.
BenchBody with_true_arm(BenchBody body) {
  Specimen& specimen = body.specimen;
  for (double Specimen::*error : {&Specimen::robot_offset_x_mm, &Specimen::robot_offset_y_mm,
                                  &Specimen::robot_offset_z_mm, &Specimen::robot_turn_deg, &Specimen::robot_wander_mm})
    specimen.*error = 0.0;
  return body;
}

}  // namespace

BenchCut cut_as_planned(const BenchBody& body, const PlanSettings& plan, Workers& workers, Monitor& monitor) {
  INCISE_REQUIRE(body.outcome != Outcome::NotConverged, "expected a stretched body, found one without equilibrium");
  const SurfaceQuery skin(skin_at(body, body.stretched.positions));
  return cut_along(body, plan_ring(skin, tumor_edge_at(body, body.stretched.positions), plan), plan, workers, monitor);
}

KnownPhysicsCut cut_knowing_physics(const BenchBody& body, const PlanSettings& plan, int simulations, Workers& workers,
                                    Monitor& monitor) {
  INCISE_REQUIRE(body.outcome != Outcome::NotConverged, "expected a stretched body, found one without equilibrium");
  const SurfaceQuery skin(skin_at(body, body.stretched.positions));
  const BenchBody known = with_true_arm(body);
  const MeasureCut measure = [&](const ToolPath& path) -> std::optional<PathErrors> {
    const BenchCut cut = cut_along(known, path, plan, workers, monitor);
    if (!cut.inner_edge) return std::nullopt;
    PathErrors errors;
    errors.signed_error_mm = true_errors_mm(known, cut, kInnerEdgeTargetMm);
    errors.places = places_seen_even(*cut.inner_edge, errors.signed_error_mm.size(), known.approach);
    errors.lag_mm = cut.shove_mm;  // mean distance that tissue is dragged along, known to the bench
    errors.is_success = cut.outcome == Outcome::Success;
    return errors;
  };
  ConvergenceSettings settings;
  settings.simulations = simulations;
  settings.region.approach = plan.approach;
  settings.region.axis_mode = plan.axis_mode;
  settings.region.rim_clearance_mm = plan.rim_clearance_mm;
  KnownPhysicsCut result;
  const ToolPath intended = plan_ring(skin, tumor_edge_at(body, body.stretched.positions), plan);
  result.correction = compensate_converging(intended, skin, measure, settings);
  result.cut = cut_along(body, result.correction.path, plan, workers, monitor);
  return result;
}

}  // namespace incise
