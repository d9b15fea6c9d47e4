#include <incise/core/error.hpp>
#include <incise/workflow/correction.hpp>
#include <incise/workflow/study.hpp>

#include <cmath>

namespace incise {
namespace {

/// Tissue that does not move passes the tool at full speed, so it is in contact for a shorter time than dragged tissue.
/// A tet is removed if it stays in reach for this share of the widest way through the tool's reach. The kerf is then
/// about as wide as the needle.
constexpr double kContactShare = 13.0 / 15.0;
constexpr double kDoseShare =
    0.5;  // the same for a cut by points: its kerf is then about as wide as its kernel's radius
constexpr double kBeyondTissueMm = 1e4;

/// Returns the stretched body with all vertices fixed.
TissueModel held_everywhere(const TissueModel& model, const TissueState& stretched) {
  TetMesh mesh = model.mesh;
  mesh.vertices = stretched.positions;
  mesh.point_data.clear();
  mesh.cell_data.clear();
  const Vec3 middle = mesh.vertices.front();
  return make_tissue_model(std::move(mesh), Material{}, {FixedConstraint{SphereRegion{middle, kBeyondTissueMm}}},
                           Vec3::Zero());
}

CutSettings without_drag(const Case& settings) {
  CutSettings cut = settings.cut;
  cut.power_exponent = 0.0;
  cut.bond_stiffness_kpa_mm2 = 0.0;
  cut.hold_per_mm2 = 0.0;
  cut.tear_energy_kpa.reset();
  cut.slip_mm.reset();
  const double way_mm = cut.rule == CutRule::Lattice ? kDoseShare * cut.dose_length_mm
                                                     : kContactShare * 2.0 * (radius_mm(settings.tool) + cut.reach_mm);
  // By the paper's rule, the tool advances by one layer of tets each time that their count is full.
  cut.dullness = cut.rule == CutRule::Paper ? 1.0 : way_mm / (cut.speed_mm_s * cut.reference_step_s);
  return cut;
}

double mean_distance_from_mean(const std::vector<double>& values) {
  double mean = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  double distance = 0.0;
  for (const double value : values) distance += std::abs(value - mean) / static_cast<double>(values.size());
  return distance;
}

/// Reports the progress of this cut as a separate stage, because it is not a cut along the planned path.
class OwnStage : public Monitor {
 public:
  explicit OwnStage(Monitor& outer) : outer_(outer) {}
  void message(Severity severity, std::string_view text) override { outer_.message(severity, text); }
  void progress(std::string_view, double fraction) override { outer_.progress("checking the mesh", fraction); }
  [[nodiscard]] bool is_cancelled() const override { return outer_.is_cancelled(); }

 private:
  Monitor& outer_;
};

}  // namespace

std::optional<double> mesh_floor_mm(const Case& settings, const TissueModel& model, const TissueState& stretched,
                                    const ToolPath& path, Workers& workers, Monitor& monitor) {
  const TissueModel held = held_everywhere(model, stretched);
  Case frozen = settings;
  frozen.cut = without_drag(settings);
  frozen.frames = 0;
  OwnStage stage(monitor);
  const SimulatedCut cut = cut_and_judge(frozen, held, rest_state(held), path, path, workers, stage);
  if (cut.outcome == Outcome::Cancelled) throw Cancelled("the cut for the mesh-resolution limit was interrupted");
  const bool is_centerline = settings.compensation.observable == ContourKind::Centerline;
  const Evaluation& seen = is_centerline ? cut.centerline : cut.inner_edge;
  if (!seen.abs_error_mm) return std::nullopt;
  return is_centerline ? seen.abs_error_mm->mean : mean_distance_from_mean(seen.errors.signed_error_mm);
}

}  // namespace incise
