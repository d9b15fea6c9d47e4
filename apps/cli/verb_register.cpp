#include "cloud_input.hpp"
#include "option_checks.hpp"

#include <incise/io/atomic_file.hpp>
#include <incise/io/camera_scale.hpp>
#include <incise/io/input_file.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/registration/nonrigid_drift.hpp>
#include <incise/report/registration_figure.hpp>
#include <incise/storage/registration_json.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ostream>
#include <sstream>

namespace incise::cli {
namespace {

struct RegisterArguments {
  std::filesystem::path source;
  std::filesystem::path target;
  std::string scale = "0.9,1.1";
  std::string method = "rigid";
  std::vector<double> approach{0.0, 0.0, -1.0};
  double max_rmse_mm = 0.0;
  double settling_mm = 0.0;
  bool no_icp = false;
  bool from_identity = false;
  RegistrationSettings settings;
  NonrigidSettings nonrigid;
};

/// free, fixed or LO,HI.
ScaleRange scale_of(const std::string& text) {
  if (text == "free") return ScaleRange::free();
  if (text == "fixed") return ScaleRange::fixed();
  std::istringstream in(text);
  ScaleRange range;
  char comma = '\0';
  std::string rest;
  const bool is_read = static_cast<bool>(in >> range.low >> comma >> range.high) && comma == ',' && !(in >> rest);
  if (!is_read || !(range.low > 0.0 && range.low <= range.high && range.high < 1e6)) {
    throw CaseError("command line", "--scale", text, "free, fixed, or LO,HI with 0 < LO <= HI",
                    "For example: --scale 0.95,1.05");
  }
  return range;
}

nlohmann::ordered_json settings_json(const RegisterArguments& arguments) {
  const RegistrationSettings& s = arguments.settings;
  const auto limit = [](double value) {
    return value < 1e300 ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
  };
  nlohmann::ordered_json json{
      {"method", arguments.method},
      {"scale", {limit(s.scale.low), limit(s.scale.high)}},
      {"outlier_weight", s.outlier_weight},
      {"start", s.start ? "identity" : "search"},
      {"rotations", s.rotations},
      {"icp", s.finish_with_icp},
      {"max_iterations", s.max_iterations},
      {"drift_points", s.drift_points},
      {"largest_rmse", s.largest_rmse},
      {"settling_mm", arguments.settling_mm},
      {"largest_rmse_mm", arguments.max_rmse_mm > 0.0 ? nlohmann::ordered_json(arguments.max_rmse_mm) : nullptr},
      {"least_inliers", s.least_inliers},
      {"least_fit", s.least_fit},
      {"largest_shape_residual", s.largest_shape_residual},
      {"largest_sd", s.largest_sd},
      {"largest_settled_sd", s.largest_settled_sd},
      {"least_sharpness", s.least_sharpness},
      {"largest_rival", s.largest_rival}};
  if (arguments.method == "nonrigid") {
    json["smoothness"] = arguments.nonrigid.smoothness;
    json["stiffness"] = arguments.nonrigid.stiffness;
  }
  return json;
}

/// The source laid on the target, and bent to it where that is asked for.
struct Laid {
  PointCloud source;  // in the target's frame
  nlohmann::ordered_json nonrigid;
  bool is_acceptable = true;
};

Laid laid_source(const PointCloud& source, const PointCloud& target, const Registration& found,
                 const RegisterArguments& arguments, Workers& workers, Monitor& monitor) {
  Laid laid;
  laid.source.points = moved(found.T_target_source, source.points);
  for (const Vec3& n : source.normals) laid.source.normals.push_back(found.T_target_source.rotation * n);
  if (arguments.method != "nonrigid") return laid;
  monitor.progress("bending", 0.0);
  NonrigidSettings settings = arguments.nonrigid;
  settings.outlier_weight = arguments.settings.outlier_weight;
  settings.first_sigma = 0.1;  // the clouds lie on each other but for what bending can do
  const NonrigidDrift bent = nonrigid_drift(laid.source.points, target.points, settings, workers, monitor);
  if (bent.outcome == DriftOutcome::Cancelled) throw Cancelled("register: stopped while bending");
  monitor.progress("bending", 1.0);
  laid.source.points = bent.moved_mm;
  laid.source.normals.clear();  // they have turned with the surface
  laid.nonrigid = {
      {"outcome", to_string(bent.outcome)}, {"sigma_mm", bent.sigma_mm}, {"largest_move_mm", bent.largest_move_mm},
      {"iterations", bent.iterations},      {"rank", bent.rank},         {"target_fraction", bent.matched_share}};
  laid.is_acceptable = bent.outcome == DriftOutcome::Converged;
  return laid;
}

int run_register(const RegisterArguments& given, const CommonOptions& options) {
  RegisterArguments arguments = given;
  Console console(options.level());
  const std::filesystem::path output = options.required_output("registration");
  refuse_input_as_output("-o", output, {arguments.source, arguments.target});
  require_replaceable(output);
  RegistrationSettings& settings = arguments.settings;
  settings.scale = scale_of(arguments.scale);
  settings.finish_with_icp = !arguments.no_icp;
  if (arguments.from_identity) settings.start = Similarity{std::clamp(1.0, settings.scale.low, settings.scale.high)};
  const Vec3 approach = direction_of(arguments.approach, "--approach");
  settings.settling_mm = arguments.settling_mm;
  require_valid(validate(settings));
  const std::array<std::filesystem::path, 2> clouds{arguments.source, arguments.target};
  const std::string specimen_id = common_specimen_id(clouds);
  const PointCloud source = read_points(arguments.source, 12);
  const PointCloud target = read_points(arguments.target, 12);
  require_extent(source.points, arguments.source);
  require_extent(target.points, arguments.target);
  const double camera_scale = camera_scale_of(arguments.target);
  Workers workers(options.threads);
  Registration found = register_clouds(source, target, settings, workers, console);
  if (found.outcome == RegistrationOutcome::Cancelled) throw Cancelled("register: stopped");
  if (arguments.max_rmse_mm > 0.0 && found.rmse_mm > arguments.max_rmse_mm) {
    if (found.outcome == RegistrationOutcome::Converged) found.outcome = RegistrationOutcome::PoorFit;
    found.reasons.push_back(
        fmt::format("the residual of {:.3g} mm (rms) is above --max-rmse-mm {}", found.rmse_mm, arguments.max_rmse_mm));
  }
  bool is_acceptable = found.outcome == RegistrationOutcome::Converged;
  for (const std::string& reason : found.reasons) console.message(Severity::Warning, reason);

  nlohmann::ordered_json result{{"schema", "incise.registration/1"}};
  result.update(to_json(found));
  AtomicFolder folder(output);
  if (found.outcome != RegistrationOutcome::Degenerate) {
    const Laid laid = laid_source(source, target, found, arguments, workers, console);
    is_acceptable = is_acceptable && laid.is_acceptable;
    if (!laid.nonrigid.is_null()) result["nonrigid"] = laid.nonrigid;
    write_ply(folder.path() / "moved_source.ply", mesh_of(laid.source), specimen_id);
    RegistrationFigure figure{
        fmt::format("{} on {}", arguments.source.filename().string(), arguments.target.filename().string()),
        fmt::format("{}; scale {:.4f}, rmse {:.3g} mm, {:.0f} % of the source on the target", to_string(found.outcome),
                    found.T_target_source.scale, found.rmse_mm, 100.0 * found.inlier_fraction),
        target.points,
        laid.source.points,
        found.residuals_mm,
        approach};
    write_atomically(folder.path() / "registration.svg", registration_figure_svg(figure));
  }
  result["camera_scale"] = camera_scale;
  result["source"] = arguments.source.string();
  result["target"] = arguments.target.string();
  if (!specimen_id.empty()) result["specimen_id"] = specimen_id;
  result["source_sha256"] = sha256_of_input(arguments.source);
  result["target_sha256"] = sha256_of_input(arguments.target);
  const double wall_s = options.wall_s();
  result["wall_s"] = wall_s;
  seal_registration(result);
  write_json(folder.path() / "registration.json", result);
  write_manifest(folder.path(),
                 manifest_of(options, settings_json(arguments).dump(), {arguments.source, arguments.target}, wall_s));
  folder.commit();
  result["folder"] = output.string();
  print_result(options, result);
  return is_acceptable ? kDone : kNotAcceptable;
}

}  // namespace

void add_register(Application& application) {
  auto [verb, a] = application.add_verb<RegisterArguments>(
      "register",
      "Find the similarity that lays one cloud on another, and how far it can be relied upon. Exit status 4 when it "
      "cannot",
      "incise register --source simulated.ply --target tissue.ply --scale fixed --settling-mm 1 -o registration",
      run_register);
  verb->add_option("--source", a.source, "Cloud or surface to be moved (.ply, .vtp, .stl, .obj)")->required();
  verb->add_option("--target", a.target, "Cloud or surface that stays")->required();
  verb->add_option("--scale", a.scale, "free, fixed, or LO,HI");
  verb->add_option("--method", a.method, "nonrigid: also bend the source to the target (moved_source.ply)")
      ->check(CLI::IsMember({"rigid", "nonrigid"}));
  verb->add_option("--outlier-weight", a.settings.outlier_weight,
                   "Share of the target that belongs to nothing in the source")
      ->check(CLI::Range(0.001, 0.95));
  verb->add_option("--rotations", a.settings.rotations, "Starts of the search")->check(CLI::Range(8, 2000));
  verb->add_flag("--from-identity", a.from_identity, "No search: the clouds lie nearly right");
  verb->add_flag("--no-icp", a.no_icp, "Coherent point drift alone");
  verb->add_option("--max-iterations", a.settings.max_iterations, "Of the drift and of the finish")
      ->check(CLI::Range(1, 100000));
  verb->add_option("--max-rmse-mm", a.max_rmse_mm, "A larger residual is not acceptable; 0: 3 % of the target's radius")
      ->check(between("--max-rmse-mm", 0.0, 1000.0));
  verb->add_option(
          "--settling-mm", a.settling_mm,
          "How far the tissue may have settled, up or down, since it was simulated: pose and settling are then "
          "found together; 0: the pose alone")
      ->check(CLI::Range(0.0, 20.0));
  verb->add_option("--smoothness", a.nonrigid.smoothness,
                   "nonrigid: range of the bending, share of the source's radius")
      ->check(between("--smoothness", 0.01, 10.0));
  verb->add_option("--stiffness", a.nonrigid.stiffness, "nonrigid: cost of bending against misfit")
      ->check(between("--stiffness", 1e-6, 1e6));
  verb->add_option("--approach", a.approach, "Line of sight of the picture")->expected(3);
}

}  // namespace incise::cli
