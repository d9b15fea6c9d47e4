#include "steps/cloud_input.hpp"

#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/camera_scale.hpp>
#include <incise/io/input_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/report/registration_figure.hpp>
#include <incise/steps/camera_steps.hpp>
#include <incise/storage/registration_json.hpp>

#include <fmt/format.h>

#include <array>

namespace incise::steps {
namespace {

nlohmann::ordered_json settings_json(const RegisterRequest& request) {
  const RegistrationSettings& s = request.settings;
  const auto limit = [](double value) {
    return value < 1e300 ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
  };
  nlohmann::ordered_json json{
      {"method", request.nonrigid ? "nonrigid" : "rigid"},
      {"scale", {limit(s.scale.low), limit(s.scale.high)}},
      {"outlier_weight", s.outlier_weight},
      {"start", s.start ? "identity" : "search"},
      {"rotations", s.rotations},
      {"icp", s.finish_with_icp},
      {"max_iterations", s.max_iterations},
      {"drift_points", s.drift_points},
      {"largest_rmse", s.largest_rmse},
      {"settling_mm", s.settling_mm},
      {"largest_rmse_mm", request.max_rmse_mm > 0.0 ? nlohmann::ordered_json(request.max_rmse_mm) : nullptr},
      {"least_inliers", s.least_inliers},
      {"least_fit", s.least_fit},
      {"largest_shape_residual", s.largest_shape_residual},
      {"largest_sd", s.largest_sd},
      {"largest_settled_sd", s.largest_settled_sd},
      {"least_sharpness", s.least_sharpness},
      {"largest_rival", s.largest_rival}};
  if (request.nonrigid) {
    json["smoothness"] = request.nonrigid->smoothness;
    json["stiffness"] = request.nonrigid->stiffness;
  }
  return json;
}

/// The source moved onto the target, and bent to it if requested.
struct Laid {
  PointCloud source;  // in the target's frame
  nlohmann::ordered_json nonrigid;
  bool is_acceptable = true;
};

Laid laid_source(const PointCloud& source, const PointCloud& target, const Registration& found,
                 const RegisterRequest& request, Workers& workers, Monitor& monitor) {
  Laid laid;
  laid.source.points = moved(found.T_target_source, source.points);
  for (const Vec3& n : source.normals) laid.source.normals.push_back(found.T_target_source.rotation * n);
  if (!request.nonrigid) return laid;
  monitor.progress("bending", 0.0);
  NonrigidSettings settings = *request.nonrigid;
  settings.outlier_weight = request.settings.outlier_weight;
  settings.first_sigma = 0.1;  // the clouds already coincide but for the bending
  const NonrigidDrift bent = nonrigid_drift(laid.source.points, target.points, settings, workers, monitor);
  if (bent.outcome == DriftOutcome::Cancelled) throw Cancelled("register: stopped while bending");
  monitor.progress("bending", 1.0);
  laid.source.points = bent.moved_mm;
  laid.source.normals.clear();  // outdated: the surface has turned
  laid.nonrigid = {
      {"outcome", to_string(bent.outcome)}, {"sigma_mm", bent.sigma_mm}, {"largest_move_mm", bent.largest_move_mm},
      {"iterations", bent.iterations},      {"rank", bent.rank},         {"target_fraction", bent.matched_share}};
  laid.is_acceptable = bent.outcome == DriftOutcome::Converged;
  return laid;
}

}  // namespace

StepResult lay_clouds(const RegisterRequest& request, const StepContext& context) {
  require_replaceable(request.output);
  const std::array<std::filesystem::path, 2> clouds{request.source, request.target};
  const std::string specimen_id = common_specimen_id(clouds);
  const PointCloud source = read_points(request.source, 12);
  const PointCloud target = read_points(request.target, 12);
  require_extent(source.points, request.source);
  require_extent(target.points, request.target);
  const double camera_scale = camera_scale_of(request.target);
  Registration found = register_clouds(source, target, request.settings, context.workers, context.monitor);
  if (found.outcome == RegistrationOutcome::Cancelled) throw Cancelled("register: stopped");
  if (request.max_rmse_mm > 0.0 && found.rmse_mm > request.max_rmse_mm) {
    if (found.outcome == RegistrationOutcome::Converged) found.outcome = RegistrationOutcome::PoorFit;
    found.reasons.push_back(
        fmt::format("the residual of {:.3g} mm (rms) is above --max-rmse-mm {}", found.rmse_mm, request.max_rmse_mm));
  }
  bool is_acceptable = found.outcome == RegistrationOutcome::Converged;
  for (const std::string& reason : found.reasons) context.monitor.message(Severity::Warning, reason);

  StepResult done{{{"schema", "incise.registration/1"}}};
  nlohmann::ordered_json& result = done.json;
  result.update(to_json(found));
  AtomicFolder folder(request.output);
  if (found.outcome != RegistrationOutcome::Degenerate) {
    const Laid laid = laid_source(source, target, found, request, context.workers, context.monitor);
    is_acceptable = is_acceptable && laid.is_acceptable;
    if (!laid.nonrigid.is_null()) result["nonrigid"] = laid.nonrigid;
    write_ply(folder.path() / "moved_source.ply", mesh_of(laid.source), specimen_id);
    RegistrationFigure figure{
        fmt::format("{} on {}", request.source.filename().string(), request.target.filename().string()),
        fmt::format("{}; scale {:.4f}, rmse {:.3g} mm, {:.0f} % of the source on the target", to_string(found.outcome),
                    found.T_target_source.scale, found.rmse_mm, 100.0 * found.inlier_fraction),
        target.points,
        laid.source.points,
        found.residuals_mm,
        request.approach};
    write_atomically(folder.path() / "registration.svg", registration_figure_svg(figure));
  }
  result["camera_scale"] = camera_scale;
  result["source"] = request.source.string();
  result["target"] = request.target.string();
  if (!specimen_id.empty()) result["specimen_id"] = specimen_id;
  result["source_sha256"] = sha256_of_input(request.source);
  result["target_sha256"] = sha256_of_input(request.target);
  const double wall_s = context.wall_s();
  result["wall_s"] = wall_s;
  seal_registration(result);
  write_json(folder.path() / "registration.json", result);
  write_manifest(folder.path(),
                 manifest_of(context.run, settings_json(request).dump(), {request.source, request.target}, wall_s));
  folder.commit();
  result["folder"] = request.output.string();
  done.is_acceptable = is_acceptable;
  return done;
}

}  // namespace incise::steps
