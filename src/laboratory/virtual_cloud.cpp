#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/core/units.hpp>
#include <incise/geometry/visible_surface.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/laboratory/bench_steps.hpp>
#include <incise/storage/case_run.hpp>
#include <incise/virtual_bench/readings.hpp>

namespace incise::laboratory {
namespace {

constexpr double kSpacingMm = 1.0;
constexpr double kNoiseMm = 0.1;
constexpr double kMissingShare = 0.1;
constexpr double kMostTiltDeg = 5.0, kMostTurnDeg = 20.0, kMostShiftMm = 20.0;

/// Returns the place that the case states; else the virtual bench's holder.
Mat4 believed_place(const Case& settings, const Points& positions) {
  if (settings.T_robot_sim) return *settings.T_robot_sim;
  Box3 box;
  for (const Vec3& p : positions) box.extend(p);
  Mat4 T = Mat4::Identity();
  T.topRightCorner<3, 1>() = kHolderMm - box.center();
  return T;
}

/// Returns a place near `believed`: turned and shifted about the middle of the visible points.
Mat4 true_place(const Mat4& believed, const Points& seen, Random& random) {
  const auto angle = [&](double most_deg) { return units::rad_from_deg(random.uniform(-most_deg, most_deg)); };
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : seen) middle += p / static_cast<double>(seen.size());
  const Vec3 there = (believed * middle.homogeneous()).head<3>();
  Mat4 move = Mat4::Identity();
  const Eigen::AngleAxisd turn(angle(kMostTurnDeg), Vec3::UnitZ()), roll(angle(kMostTiltDeg), Vec3::UnitX()),
      pitch(angle(kMostTiltDeg), Vec3::UnitY());
  move.topLeftCorner<3, 3>() = (turn * roll * pitch).toRotationMatrix();
  const auto shift = [&] { return random.uniform(-kMostShiftMm, kMostShiftMm); };
  const double x = shift(), y = shift(), z = shift();
  move.topRightCorner<3, 1>() = there - move.topLeftCorner<3, 3>() * there + Vec3(x, y, z);
  return move * believed;
}

/// Returns the surface as a camera sees it: with noise, and incomplete.
PointCloud measured(const PointCloud& surface, const Mat4& T, Random& random) {
  PointCloud cloud;
  const auto noise = [&] { return kNoiseMm * random.normal(); };
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    const double x = noise(), y = noise(), z = noise();
    if (random.uniform() < kMissingShare) continue;
    cloud.points.push_back((T * surface.points[i].homogeneous()).head<3>() + Vec3(x, y, z));
    cloud.normals.push_back(T.topLeftCorner<3, 3>() * surface.normals[i]);
  }
  return cloud;
}

}  // namespace

steps::StepResult make_virtual_cloud(const VirtualCloudRequest& request, const steps::StepContext& context) {
  CaseRun run(read_case_with_inputs(request.case_file), output_beside(request.case_file), {.until = Stage::Stretch},
              context.run);
  const Study study = run.study(context.workers, context.monitor);
  if (!study.stretched || study.stretched->outcome != Outcome::Success)
    throw DataError(request.case_file, "stretch", study.stretched ? explain_stretch(*study.stretched) : "none",
                    "a specimen that comes to rest");
  const Case& settings = run.folder.case_file().settings;
  TriMesh skin = boundary_surface(study.model->mesh);
  skin.vertices = study.stretched->state.positions;
  const VisibleSurface seen =
      visible_surface(skin, {.approach = settings.plan.approach, .spacing_mm = kSpacingMm}, context.workers);
  Random random(context.run.seed);
  const Mat4 T = true_place(believed_place(settings, skin.vertices), seen.cloud.points, random);
  TriMesh cloud = mesh_of(measured(seen.cloud, T, random));
  cloud.point_data[kVirtualMark] = {1, std::vector<double>(cloud.vertices.size(), 1.0)};
  write_ply(request.output, cloud, run.folder.specimen_id());
  return {{{"cloud", request.output.string()}, {"points", cloud.vertices.size()}, {"cloud_is", "virtual"}}};
}

}  // namespace incise::laboratory
