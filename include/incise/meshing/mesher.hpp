#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/monitor.hpp>
#include <incise/core/problem.hpp>
#include <incise/geometry/volume.hpp>
#include <incise/meshing/quality.hpp>
#include <incise/meshing/sizing_field.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise {

inline constexpr int kFewestTets = 100;  ///< smallest allowed target_tets

/// Settings of the mesher; `describe` gives the meaning of each. Lengths in mm, angles in degrees. Factors are relative
/// to the edge length of the sizing field.
struct MeshingSettings {
  std::optional<int> target_tets;
  double target_tolerance = 0.10;
  double facet_angle_deg = 25.0;
  double facet_size_factor = 0.9;
  double facet_distance_factor = 0.25;
  double facet_distance_floor_mm = 0.1;
  double radius_edge_ratio = 2.0;
  double cell_size_factor = 0.75;
  double sliver_bound_deg = 12.0;
  double min_dihedral_deg = 10.0;
  double volume_tolerance = 0.01;
  int max_refinements = 4;
  int max_improvements = 3;
  std::size_t max_tets = 5'000'000;
};
void describe(Visitor& v, MeshingSettings& s);

/// Returns every violation; empty if the settings are valid.
[[nodiscard]] std::vector<Problem> validate(const MeshingSettings& settings);

struct MeshingPhase {
  std::string name;  ///< body, sizing, refine, perturb, exude, finish
  double wall_s = 0.0;
};
inline void describe(Visitor& v, MeshingPhase& p) {
  v("name", p.name, "Name of the phase.");
  v("wall_s", p.wall_s, "Time that the phase took.");
}

/// A mesh, its quality and how it was made.
struct [[nodiscard]] MeshingResult {
  TetMesh mesh;  ///< mm, LPS; positively oriented, one face-connected component, every vertex used, vertices in Morton
                 ///< order
  MeshQuality quality;
  bool meets_quality = false;  ///< smallest dihedral angle >= min_dihedral_deg
  bool meets_volume = false;   ///< volume within volume_tolerance of label_volume_mm3
  bool meets_target = true;    ///< count within target_tolerance of target_tets, if there is one

  double label_volume_mm3 = 0.0;       ///< volume of the meshed body in the input; see each function
  double relative_volume_error = 0.0;  ///< (mesh volume - label_volume_mm3) / label_volume_mm3
  double iso = 0.5;                    ///< occupancy on the mesh's surface, chosen so that the volume matches
  double fine_mm = 0.0;                ///< edge length requested in the band, after scaling towards target_tets
  double coarse_mm = 0.0;              ///< longest edge length requested, after the same scaling
  double predicted_tets = 0.0;         ///< count predicted before the first refinement
  int refinements = 0;                 ///< tried to meet count and volume
  int improvements = 0;                ///< tried to meet the angle

  std::size_t dropped_bodies = 0;    ///< components of the occupancy other than the largest, left out
  double dropped_volume_mm3 = 0.0;   ///< volume left out: these components, and specks too faint to count as bodies
  std::size_t dropped_tets = 0;      ///< tets not face-connected with the rest, left out
  std::vector<MeshingPhase> phases;  ///< time by phase, with repetitions added up
  double wall_s = 0.0;               ///< total time
};
inline void describe(Visitor& v, MeshingResult& m) {
  v.bulk("mesh", m.mesh, "The mesh: one component, positively oriented.");
  describe(v, m.quality);
  v("meets_quality", m.meets_quality, "Whether the smallest dihedral angle is large enough.");
  v("meets_volume", m.meets_volume, "Whether the volume is near the label's.");
  v("meets_target", m.meets_target, "Whether the number of tets is near the target.");
  v("label_volume_mm3", m.label_volume_mm3, "Volume of the body that was meshed.");
  v("relative_volume_error", m.relative_volume_error,
    "Volume of the mesh minus that of the label, over that of the label.");
  v("iso", m.iso, "Occupancy on the mesh's surface.");
  v("fine_mm", m.fine_mm, "Edge length requested near the cut.");
  v("coarse_mm", m.coarse_mm, "Edge length requested far from it.");
  v("predicted_tets", m.predicted_tets, "Number of tets predicted before the first refinement.");
  v("refinements", m.refinements, "Number of refinements tried to meet count and volume.");
  v("improvements", m.improvements, "Number of improvements tried to meet the angle.");
  v("dropped_bodies", m.dropped_bodies, "Number of smaller components of the occupancy that were left out.");
  v("dropped_volume_mm3", m.dropped_volume_mm3,
    "Volume of the occupancy that was left out: these components and faint specks.");
  v("dropped_tets", m.dropped_tets, "Number of tets left out because no face joins them to the rest.");
  v("phases", m.phases, "Time by phase.");
  v("wall_s", m.wall_s, "Time that meshing took.");
}

/// Returns the longest side, mm, along the grid's axes, of the box round all tissue (occupancy of at least 0.5, or any
/// label but 0); 0 without tissue. @throws InvalidArgument unless there is one value per voxel.
[[nodiscard]] double longest_side_mm(const GrayVolume& occupancy);
[[nodiscard]] double longest_side_mm(const LabelVolume& labels);

/// Fills the tissue of an occupancy volume with tetrahedra whose edge lengths follow the sizing field. Delaunay
/// refinement of the trilinearly interpolated occupancy, then perturbation and exudation of slivers (CGAL Mesh_3,
/// sequential). Meshes only the largest component (voxels of at least 0.5 that share faces). Tissue at the border of
/// the volume is closed half a voxel beyond the outermost voxel centres. `label_volume_mm3` is the volume inside the
/// surface of occupancy 0.5; to match it, the mesher refines on a neighbouring iso surface. The same input gives the
/// same mesh, bit for bit.
/// @param occupancy  fraction of each voxel that is tissue, [0, 1]; see occupancy.hpp.
/// @throws InvalidArgument for broken volumes or settings (all violations at once), occupancy that never reaches 0.5, a
/// body too small for the edge length, or too many tets (a prediction above max_tets, or refinement that runs away).
/// @throws Cancelled between phases and during refinement.
/// @note About 3 s for 100 000 tets on one thread.  Source: [CGAL-Mesh3].
MeshingResult mesh_labels(const GrayVolume& occupancy, const SizingField& sizing, const MeshingSettings& settings,
                          Monitor& monitor);

/// As above, from labels: every label but 0 is tissue, blurred as by `occupancy_of` with its default.
/// `label_volume_mm3` is the volume of the labelled voxels. @throws InvalidArgument also for a body so thin that the
/// blur leaves no surface of that volume.
MeshingResult mesh_labels(const LabelVolume& labels, const SizingField& sizing, const MeshingSettings& settings,
                          Monitor& monitor);

/// As above, from a closed surface, which is first sampled in voxels. `label_volume_mm3` is the volume that the surface
/// encloses. @param voxel_mm  edge of a voxel, > 0; absent: half the fine edge length.
/// @throws InvalidArgument also for surfaces that `occupancy_of` refuses.
MeshingResult mesh_surface(const TriMesh& closed_surface, const SizingField& sizing, const MeshingSettings& settings,
                           Monitor& monitor, std::optional<double> voxel_mm = std::nullopt);

}  // namespace incise
