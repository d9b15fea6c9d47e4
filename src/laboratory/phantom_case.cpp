#include <incise/imaging/phantom.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/volume_io.hpp>
#include <incise/laboratory/bench_steps.hpp>

#include <fmt/format.h>

namespace incise::laboratory {
namespace {

std::string volume_name(PhantomForm form) {
  if (form == PhantomForm::Dicom) return "ct";
  return form == PhantomForm::Nrrd ? "ct.nrrd" : "ct.nii.gz";
}

void write_volume(const std::filesystem::path& folder, PhantomForm form, const Phantom& phantom, std::uint64_t seed) {
  if (form != PhantomForm::Dicom) {
    write_ct(folder / volume_name(form), phantom.ct);
    return;
  }
  write_dicom_series(folder / "ct", phantom.ct,
                     {.patient_id = fmt::format("VIRTUAL-{}", seed),
                      .series_description = fmt::format("Synthetic CT of a virtual tongue, seed {}", seed)});
}

/// Places the middle of the tumour 600 mm in front of the robot's base and 200 mm above it, with the tip of the tongue
/// pointing away from the base.
std::string case_text(const Phantom& phantom, PhantomForm form, std::uint64_t seed) {
  const Vec3 origin = phantom.tumor_center_mm;
  return fmt::format(R"(# A virtual specimen made by `incise phantom --seed {seed}`: no real tissue.
# Fields that are not given keep their defaults: `incise schema case --defaults`.
schema: incise.case/1
title: Virtual tongue, seed {seed}
specimen_is: virtual
ct:
  volume: {volume}
  window_hu: [-20, 180]
meshing:
  tets: 40000   # quick to cut; leave it out for the finer default
tumor:
  contour: tumor.csv        # drawn as seen from above; laid onto the stretched tissue along the approach
  surface: tumor.ply        # its closed surface, placed as the edge is: for the deep margin
  configuration: stretched
plan:
  kind: ring
  lateral_margin_mm: 5
  depth_mm: 5
robot:
  # A chosen place under the arm; registration to a camera's view would measure it.
  T_robot_sim: [[0, 1, 0, {tx:.3f}], [-1, 0, 0, {ty:.3f}], [0, 0, 1, {tz:.3f}], [0, 0, 0, 1]]
)",
                     fmt::arg("seed", seed), fmt::arg("volume", volume_name(form)), fmt::arg("tx", 600.0 - origin.y()),
                     fmt::arg("ty", origin.x()), fmt::arg("tz", 200.0 - origin.z()));
}

nlohmann::ordered_json truth_json(const Phantom& phantom, std::uint64_t seed) {
  const auto vector = [](const Vec3& v) { return nlohmann::ordered_json{v.x(), v.y(), v.z()}; };
  nlohmann::ordered_json json;
  json["note"] = "The exact specimen, for tests: nothing of this is in the CT.";
  json["seed"] = seed;
  json["volume_mm3"] = phantom.true_volume_mm3;
  json["tumor_center_mm"] = vector(phantom.tumor_center_mm);
  json["tissue_below_tumor_mm"] = phantom.tissue_below_tumor_mm;
  json["tip_end_mm"] = phantom.tip_end_mm;
  json["posterior_end_mm"] = phantom.posterior_end_mm;
  json["platform_z_mm"] = phantom.platform_z_mm;
  return json;
}

}  // namespace

steps::StepResult make_phantom_case(const PhantomRequest& request, const steps::StepContext& context) {
  const std::filesystem::path& folder = request.output;
  const PhantomSettings settings{.seed = context.run.seed};
  Monitor& monitor = context.monitor;
  monitor.message(Severity::Notice, fmt::format("phantom: making a virtual specimen, seed {}", settings.seed));
  const Phantom phantom = make_phantom(settings, monitor);
  steps::make_parent(folder);
  AtomicFolder target(folder);
  write_volume(target.path(), request.form, phantom, settings.seed);
  write_contour_csv(target.path() / "tumor.csv", phantom.tumor_edge);
  write_ply(target.path() / "tumor.ply", phantom.tumor);
  write_json(target.path() / "truth.json", truth_json(phantom, settings.seed));
  write_atomically(target.path() / "case.yaml", case_text(phantom, request.form, settings.seed));
  Manifest manifest = steps::manifest_of(context.run, "{}", {}, context.wall_s());
  manifest.command = fmt::format("incise phantom --seed {} --format {}", settings.seed, to_string(request.form));
  write_manifest(target.path(), manifest);
  target.commit();

  const VolumeGrid& grid = phantom.ct.grid;
  steps::StepResult result;
  result.json["volume"] = (folder / volume_name(request.form)).string();
  result.json["case"] = (folder / "case.yaml").string();
  result.json["spacing_mm"] = {grid.spacing_mm.x(), grid.spacing_mm.y(), grid.spacing_mm.z()};
  result.json["size"] = grid.size;
  result.json["true_volume_mm3"] = phantom.true_volume_mm3;
  return result;
}

}  // namespace incise::laboratory
