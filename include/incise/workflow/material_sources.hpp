#pragma once

#include <incise/core/verdict.hpp>
#include <incise/geometry/tet_mesh.hpp>
#include <incise/geometry/volume.hpp>
#include <incise/workflow/case.hpp>
#include <incise/workflow/inputs.hpp>

#include <optional>
#include <string>

namespace incise {

/// Sources of a specimen's stiffness beside its settings and its mesh: lengths in mm, LPS, tissue at rest. Sources that
/// the case does not use are absent.
struct MaterialSources {
  std::optional<LabelVolume> labels;         ///< those in which the tissue was found
  std::optional<GrayVolume> elasticity_kpa;  ///< Young's modulus, long-time; 0 or less: unknown there
  std::optional<TriMesh> tumor;              ///< closed
};

/// Reads the sources that the case uses. @throws CaseError (fields specimen.material.…) if the case uses a source that
/// it does not name.
[[nodiscard]] MaterialSources read_material_sources(const Case& settings, Inputs& inputs, Monitor& monitor);

/// Returns a digest that changes with the values that `lay_on_mesh` would lay; empty without sources.
[[nodiscard]] std::string digest_of(const MaterialSources& sources);

/// How an elasticity map covers a specimen.
struct MapCoverage {
  double share = 0.0;  ///< fraction of the tets at which the map is known
  double least_kpa = 0.0;
  double greatest_kpa = 0.0;
};

/// Sets cell arrays of a mesh at rest from the sources, at the tets' centroids, for material_field:
/// - `label`, if the sources have labels and the mesh has no such array: the label of the nearest tissue voxel among
/// the 27 around the centroid, or 0 if none of these is tissue;
/// - kLaidModulusArray: the modulus by the elasticity map (trilinear between the voxels above 0; where there is none,
/// the mesh's own value or the case's), and inside the tumour's surface specimen.material.tumor_modulus_kpa. An array
/// of this name that the mesh already had is removed.
/// @returns the coverage of the map; nullopt without a map.
/// @throws CaseError for a map that is known at no tet or has a value that no tissue has, or for a surface that
/// contains no tet.
std::optional<MapCoverage> lay_on_mesh(const Case& settings, const MaterialSources& sources, TetMesh& mesh);

/// Returns the objection to an elasticity map that leaves out most of the specimen.
[[nodiscard]] Verdict verdict_of_map(const MapCoverage& coverage);

}  // namespace incise
