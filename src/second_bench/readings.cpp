#include "second_bench/body_state.hpp"

#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/imaging/phantom.hpp>
#include <incise/second_bench/readings.hpp>

#include <Eigen/Geometry>
#include <cmath>

namespace incise::second_bench {
namespace {

constexpr std::uint64_t kReadingStream = 0x94d049bbULL;
constexpr double kHandWaveMm = 8.0;
constexpr double kForceNoise = 0.05;  // standard deviation of one reading, relative

/// The specimen's shape in the scanner, with the error of its segmentation.
TongueShape scanned_shape(const TongueShape& shape, const Specimen& specimen) {
  TongueShape scanned = shape;
  scanned.length_mm += 2.0 * specimen.segmentation_mm;
  scanned.width_mm = (shape.width_mm + 2.0 * specimen.segmentation_mm) * (1.0 + specimen.sag);
  scanned.height_mm = (shape.height_mm + specimen.segmentation_mm) * (1.0 - specimen.sag);
  return scanned;
}

/// Distorts points as a lens with radial distortion does, seen from the camera at the origin.
void distort(Points& points, const Mat4& T_camera_specimen, double coefficient) {
  const Mat4 back = T_camera_specimen.inverse();
  for (Vec3& p : points) {
    Vec3 seen = (T_camera_specimen * p.homogeneous()).head<3>();
    const double squared = seen.head<2>().squaredNorm() / (seen.z() * seen.z());
    seen.head<2>() *= 1.0 + coefficient * squared;
    p = (back * seen.homogeneous()).head<3>();
  }
}

}  // namespace

Placement placement_of(const Specimen& specimen) {
  return {specimen.placement_x_mm, specimen.placement_y_mm, specimen.placement_turn_deg, 0.0};
}

Readings take_readings(const Body& body, Monitor& monitor) {
  INCISE_REQUIRE(body.outcome == Outcome::Success, "expected a body in equilibrium");
  const Specimen& specimen = body.specimen;
  Random random(specimen.seed ^ kReadingStream);
  Readings readings;
  readings.stretch_force_n = body.gauge_force_n * (1.0 + kForceNoise * random.normal());
  PhantomSettings scanner;
  scanner.seed = specimen.seed;
  scanner.blur_mm = specimen.ct_blur_mm;
  scanner.spacing_mm.y() = specimen.ct_slice_mm;
  readings.ct = scan_shape(scanned_shape(body.state->shape, specimen), scanner, monitor);
  readings.T_robot_camera = T_robot_camera(placement_of(specimen));
  const Mat4 T_camera_specimen = readings.T_robot_camera.inverse() * T_robot_specimen(placement_of(specimen));
  SeenTissue seen = seen_from_above(*body.state);
  distort(seen.vertices, T_camera_specimen, specimen.lens_distortion);
  distort(seen.tumor_edge.points, T_camera_specimen, specimen.lens_distortion);
  FrameNoise noise;
  noise.seed = specimen.seed;
  readings.frame = shoot_frame(seen, noise, T_camera_specimen);
  readings.cloud_mm = cloud_of(readings.frame);
  return readings;
}

std::vector<TipPose> tip_course(const std::vector<TipPose>& asked, const Specimen& specimen,
                                const Mat4& T_specimen_robot) {
  std::vector<TipPose> late = asked;
  for (std::size_t n = 1; n < late.size(); ++n) {
    if (specimen.lag_s <= 0.0) break;
    const double share = std::exp(-(asked[n].time_s - asked[n - 1].time_s) / specimen.lag_s);
    late[n].tip_mm = asked[n].tip_mm + share * (late[n - 1].tip_mm - asked[n].tip_mm);
  }
  const ArmErrors errors{
      specimen.seed, {specimen.hand_eye_x_mm, specimen.hand_eye_y_mm, specimen.hand_eye_z_mm}, 0.0, specimen.wander_mm};
  return incise::tip_course(late, errors, T_specimen_robot);
}

SeenTissue seen_by_camera(const Body& body, const Cut& cut) {
  const Specimen& specimen = body.specimen;
  SeenTissue seen = seen_from_above(*cut.after);
  const Vec3 middle = curve_centroid(seen.tumor_edge);
  Random random(stream_of(specimen.seed, "photograph"));
  const double heading = random.uniform(0.0, 2.0 * units::kPi);
  const Mat3 tilt = Eigen::AngleAxisd(units::rad_from_deg(specimen.photograph_tilt_deg),
                                      Vec3(std::cos(heading), std::sin(heading), 0.0))
                        .toRotationMatrix();
  const auto look = [&](Vec3& p) {
    p = tilt * (p - middle);
    p.head<2>() *= specimen.camera_distance_mm / (specimen.camera_distance_mm - p.z());
    p += middle;
  };
  for (Vec3& p : seen.vertices) look(p);
  for (Vec3& p : seen.tumor_edge.points) look(p);
  return seen;
}

ColorPicture photograph(const Body& body, const Cut& cut, const PhotographSettings& settings) {
  const SeenTissue seen = seen_by_camera(body, cut);
  Marked marked;
  marked.seed = body.specimen.seed;
  marked.inner_edge = inner_edge_of(seen);
  marked.hand_mm = body.specimen.annotator_mm;
  marked.hand_wave_mm = kHandWaveMm;
  marked.stains = body.specimen.stains;
  return incise::photograph(seen, marked, settings);
}

std::optional<std::vector<double>> true_errors_mm(const Cut& cut, double target_mm) {
  const SeenTissue seen = seen_from_above(*cut.after);
  const std::optional<Contour> edge = inner_edge_of(seen);
  if (!edge) return std::nullopt;
  return errors_seen_mm(edge->points, seen.tumor_edge, target_mm);
}

}  // namespace incise::second_bench
