#include <incise/core/error.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/volume_io.hpp>
#include <incise/meshing/mesher.hpp>
#include <incise/steps/tissue_steps.hpp>
#include <incise/storage/own_files.hpp>
#include <incise/storage/result_json.hpp>

#include <fmt/format.h>

namespace incise::steps {
namespace {

/// The reader of labels judges what it knows, such as a slice; of other files it would not say that surfaces will do.
void require_known_format(const std::filesystem::path& input) {
  const std::filesystem::path ending = input.extension();
  if (is_surface_name(input) || !std::filesystem::is_regular_file(input) || ending.empty() || ending == ".dcm") return;
  try {
    require_volume_name(input);
  } catch (const DataError&) {
    throw DataError(input, "extension", fmt::format("'{}'", input.extension().string()),
                    fmt::format("labels ({}) or a closed surface ({})", kLabelFormats, kSurfaceFormats));
  }
}

void require_order(double fine_mm, double coarse_mm) {
  if (fine_mm <= coarse_mm) return;
  throw CaseError("command line", "--fine-mm", fmt::format("{:.3g} mm", fine_mm),
                  fmt::format("at most --coarse-mm = {:.3g} mm", coarse_mm));
}

/// Edge lengths for a body whose longest side is this long.
SizingField sizing_of(const MeshRequest& request, const PlannedCut& cut, double longest_mm) {
  SizingSettings sizes = default_lengths(longest_mm);
  sizes.fine_mm = request.fine_mm.value_or(sizes.fine_mm);
  sizes.coarse_mm = request.coarse_mm.value_or(sizes.coarse_mm);
  if (request.around.empty()) return SizingField::uniform(sizes.coarse_mm);
  require_order(sizes.fine_mm, sizes.coarse_mm);
  return SizingField::around_cut(cut, sizes);
}

/// Meshes the input. A violated precondition of the mesher is due to the file and the lengths: a DataError.
MeshingResult meshed(const MeshRequest& request, const PlannedCut& cut, const MeshingSettings& settings,
                     Monitor& monitor) {
  const std::filesystem::path& input = request.input;
  try {
    if (!is_surface_name(input)) {
      const LabelVolume labels = read_labels(input);
      return mesh_labels(labels, sizing_of(request, cut, longest_side_mm(labels)), settings, monitor);
    }
    const TriMesh surface = read_surface(input);
    require_closed_manifold(surface, input);
    const Box3 box = bounding_box(surface.vertices);
    require_body_size(box, input);
    return mesh_surface(surface, sizing_of(request, cut, box.sizes().maxCoeff()), settings, monitor);
  } catch (const InvalidArgument& error) {
    throw DataError(input, "", error);
  }
}

}  // namespace

StepResult mesh_body(const MeshRequest& request, const StepContext& context) {
  require_own_manifest_beside(request.output);
  require_known_format(request.input);
  MeshingSettings settings;
  if (request.tets > 0) settings.target_tets = request.tets;
  if (request.fine_mm && request.coarse_mm) require_order(*request.fine_mm, *request.coarse_mm);
  PlannedCut cut;
  if (!request.around.empty()) cut.path = read_contour(request.around, true);
  cut.depth_mm = request.depth_mm;
  const MeshingResult made = meshed(request, cut, settings, context.monitor);
  const nlohmann::json chosen{
      {"around", request.around.string()}, {"depth_mm", request.depth_mm}, {"tets", request.tets}};
  const Manifest manifest = manifest_of(context.run, chosen.dump(), {request.input, request.around}, context.wall_s());
  write_vtu(request.output, made.mesh);
  write_manifest_beside(request.output, manifest);
  context.monitor.message(Severity::Detail, to_text(made.quality));
  StepResult result{to_json(made), made.meets_quality && made.meets_volume};
  result.json["mesh"] = request.output.string();
  return result;
}

}  // namespace incise::steps
