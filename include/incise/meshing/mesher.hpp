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

inline constexpr int kFewestTets = 100;  ///< that may be aimed for

/// How tetrahedra are made. Lengths in mm, angles in degrees; h is the local edge length that the sizing field asks
/// for.
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

/// Everything that is wrong with the settings, a sentence each; empty: usable.
[[nodiscard]] std::vector<Problem> validate(const MeshingSettings& settings);

struct MeshingPhase {
  std::string name;  ///< body, sizing, refine, perturb, exude, finish
  double wall_s = 0.0;
};
inline void describe(Visitor& v, MeshingPhase& p) {
  v("name", p.name, "Of the phase.");
  v("wall_s", p.wall_s, "Time that it took.");
}

/// A mesh and what is needed to trust it.
struct [[nodiscard]] MeshingResult {
  TetMesh mesh;  ///< mm, LPS; positively oriented, one face-connected component, every vertex used, vertices in Morton
                 ///< order
  MeshQuality quality;
  bool meets_quality = false;  ///< smallest dihedral angle >= min_dihedral_deg
  bool meets_volume = false;   ///< volume within volume_tolerance of the label's
  bool meets_target = true;    ///< count within target_tolerance of target_tets, if there is one

  double label_volume_mm3 = 0.0;       ///< of the body that was meshed, see each function
  double relative_volume_error = 0.0;  ///< (mesh - label) / label
  double iso = 0.5;                    ///< occupancy on the mesh's surface, chosen so that the volume matches
  double fine_mm = 0.0;                ///< edge lengths asked for, after scaling towards target_tets
  double coarse_mm = 0.0;
  double predicted_tets = 0.0;  ///< before the first refinement
  int refinements = 0;
  int improvements = 0;

  std::size_t dropped_bodies = 0;    ///< components of the occupancy other than the largest, left out
  double dropped_volume_mm3 = 0.0;   ///< their volume, with that of specks too faint to count as bodies
  std::size_t dropped_tets = 0;      ///< tets not face-connected with the rest, left out
  std::vector<MeshingPhase> phases;  ///< time by phase, repeated phases added up
  double wall_s = 0.0;
};
inline void describe(Visitor& v, MeshingResult& m) {
  v.bulk("mesh", m.mesh, "One component, positively oriented.");
  describe(v, m.quality);
  v("meets_quality", m.meets_quality, "Whether the smallest dihedral angle is large enough.");
  v("meets_volume", m.meets_volume, "Whether the volume is near the label's.");
  v("meets_target", m.meets_target, "Whether the count is near the one aimed for.");
  v("label_volume_mm3", m.label_volume_mm3, "Of the body that was meshed.");
  v("relative_volume_error", m.relative_volume_error, "Mesh less label, over label.");
  v("iso", m.iso, "Occupancy on the mesh's surface.");
  v("fine_mm", m.fine_mm, "Edge length requested near the cut.");
  v("coarse_mm", m.coarse_mm, "Edge length requested far from it.");
  v("predicted_tets", m.predicted_tets, "Before the first refinement.");
  v("refinements", m.refinements, "Tried to meet count and volume.");
  v("improvements", m.improvements, "Tried to meet the angle.");
  v("dropped_bodies", m.dropped_bodies, "Smaller components of the occupancy, left out.");
  v("dropped_volume_mm3", m.dropped_volume_mm3, "Their volume.");
  v("dropped_tets", m.dropped_tets, "Tets without a face in common with the rest, left out.");
  v("phases", m.phases, "Time by phase.");
  v("wall_s", m.wall_s, "Time that meshing took.");
}

/// Longest side, along the grid's axes, of the box round all tissue (occupancy of at least 0.5, any label but 0), mm; 0 without tissue.
[[nodiscard]] double longest_side_mm(const GrayVolume& occupancy);
[[nodiscard]] double longest_side_mm(const LabelVolume& labels);

/// Tetrahedra that fill the tissue of an occupancy volume (values in [0, 1], the fraction of each voxel that is tissue;
/// see occupancy.hpp), with edge lengths from the sizing field: the CT becomes a body that can be simulated. Delaunay
/// refinement of the trilinearly interpolated occupancy, then perturbation and exudation of slivers (CGAL Mesh_3,
/// sequential). Only the largest component (voxels of at least 0.5 that share faces) is meshed; what touches the border
/// of the volume is closed half a voxel beyond it. The label's volume is what the surface of occupancy 0.5 encloses;
/// the mesh is refined on the neighbouring iso surface that makes the volumes agree. Same input, same mesh, bit for
/// bit.
/// @throws InvalidArgument for broken volumes and settings (all violations at once), occupancy that never reaches 0.5,
///   a body too small for the edge length, or a predicted count above max_tets (with the prediction).
/// @throws Cancelled between phases and during refinement.
/// @note About 3 s for 100 000 tets on one thread.  Source: [CGAL-Mesh3].
MeshingResult mesh_labels(const GrayVolume& occupancy, const SizingField& sizing, const MeshingSettings& settings,
                          Monitor& monitor);

/// As above from labels: every label but 0 is tissue, blurred as `occupancy_of` does by default. The label's volume is
/// that of its voxels. @throws InvalidArgument also for a body thinner than its voxels can carry once blurred.
MeshingResult mesh_labels(const LabelVolume& labels, const SizingField& sizing, const MeshingSettings& settings,
                          Monitor& monitor);

/// As above from a closed surface, through voxels of half the fine edge length, or as given, > 0. The label's volume is
/// what the surface encloses. @throws InvalidArgument also for what `occupancy_of` refuses.
MeshingResult mesh_surface(const TriMesh& closed_surface, const SizingField& sizing, const MeshingSettings& settings,
                           Monitor& monitor, std::optional<double> voxel_mm = std::nullopt);

}  // namespace incise
