#include <incise/core/random.hpp>
#include <incise/virtual_bench/pictures.hpp>
#include <incise/virtual_bench/readings.hpp>

#include <algorithm>

namespace incise {
namespace {

constexpr std::uint64_t kReadingStream = 0xc2b2ae35ULL;
constexpr double kForceNoise = 0.05;       // standard deviation, relative
constexpr double kElasticityNoise = 0.20;  // standard deviation, relative
constexpr double kElasticityVoxelMm = 2.0;

GrayVolume elasticity_of(const BenchBody& body, Random& random) {
  const TissueModel& model = *body.tissue;
  const Box3 box = bounding_box(model.mesh.vertices);
  GrayVolume map;
  map.grid.spacing_mm = Vec3::Constant(kElasticityVoxelMm);
  map.grid.origin_mm = box.min();
  for (int axis = 0; axis < 3; ++axis)
    map.grid.size[static_cast<std::size_t>(axis)] = static_cast<int>(box.sizes()[axis] / kElasticityVoxelMm) + 1;
  map.voxels.assign(map.grid.voxel_count(), 0.0F);
  const TetLocator locator(model.mesh, model.mesh.vertices);
  for (int k = 0; k < map.grid.size[2]; ++k) {
    for (int j = 0; j < map.grid.size[1]; ++j) {
      for (int i = 0; i < map.grid.size[0]; ++i) {
        const auto point = locator.locate(map.grid.world_from_index(Vec3(i, j, k)), 0.0);
        if (!point) continue;
        const LameParameters& lame = model.lame[point->tet.index()];
        const double e = lame.mu_kpa * (3.0 * lame.lambda_kpa + 2.0 * lame.mu_kpa) / (lame.lambda_kpa + lame.mu_kpa);
        map.at(i, j, k) = static_cast<float>(e * std::max(0.1, 1.0 + kElasticityNoise * random.normal()));
      }
    }
  }
  return map;
}

}  // namespace

Placement placement_of(const Specimen& specimen) {
  return {specimen.placement_x_mm, specimen.placement_y_mm, specimen.placement_turn_deg, specimen.camera_tilt_deg};
}

Readings take_readings(const BenchBody& body, bool has_elasticity, Monitor& monitor) {
  Random random(body.specimen.seed ^ kReadingStream);
  Readings readings;
  readings.stretch_force_noise_percent = 100.0 * kForceNoise;
  readings.stretch_force_n = body.stretch_force_n * (1.0 + kForceNoise * random.normal());
  readings.ct = make_phantom(phantom_settings(body.specimen), monitor).ct;
  const Placement placement = placement_of(body.specimen);
  readings.T_robot_camera = T_robot_camera(placement);
  const Mat4 T_camera_specimen = readings.T_robot_camera.inverse() * T_robot_specimen(placement);
  readings.frame = shoot_frame(body, T_camera_specimen);
  readings.cloud_mm = cloud_of(readings.frame);
  if (has_elasticity) readings.elasticity_kpa = elasticity_of(body, random);
  return readings;
}

}  // namespace incise
