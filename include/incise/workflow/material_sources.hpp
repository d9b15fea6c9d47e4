#pragma once

#include <incise/core/verdict.hpp>
#include <incise/geometry/tet_mesh.hpp>
#include <incise/geometry/volume.hpp>
#include <incise/workflow/case.hpp>
#include <incise/workflow/inputs.hpp>

#include <optional>
#include <string>

namespace incise {

/// Where a specimen's stiffness comes from beside its settings and its mesh: lengths mm, LPS, tissue at rest. What the
/// case does not use is absent.
struct MaterialSources {
  std::optional<LabelVolume> labels;         ///< in which the tissue was found
  std::optional<GrayVolume> elasticity_kpa;  ///< Young's modulus, long-time; 0 or less: not known there
  std::optional<TriMesh> tumor;              ///< closed
};

/// Reads what the case asks for. @throws CaseError (fields specimen.material.…) where it asks for what it does not
/// name.
[[nodiscard]] MaterialSources read_material_sources(const Case& settings, Inputs& inputs, Monitor& monitor);

/// Changes with what `lay_on_mesh` would lay. Empty: nothing.
[[nodiscard]] std::string digest_of(const MaterialSources& sources);

/// What an elasticity map says of a specimen.
struct MapCoverage {
  double share = 0.0;  ///< of the tets, where it is above 0
  double least_kpa = 0.0;
  double greatest_kpa = 0.0;
};

/// Gives the cell arrays of a mesh at rest the values that the sources have at the tets' centroids, so that
/// material_field finds them there:
/// - `label`, of the nearest of the 27 voxels round it that are tissue, where the case lists labels and the mesh has
///   none of its own; 0: none is;
/// - kLaidModulusArray: of the elasticity map (trilinear between the voxels that are above 0; where none is, the mesh's
///   own value or the case's), and in the tumour's surface that of specimen.material.tumor_modulus_kpa. A mesh that
///   came with this array loses it.
/// @returns what the map covers; nothing: there is none.
/// @throws CaseError for a map that is known at no tet, or has a value that no tissue has, or a surface that holds no
/// tet.
std::optional<MapCoverage> lay_on_mesh(const Case& settings, const MaterialSources& sources, TetMesh& mesh);

/// What argues against an elasticity map: that it leaves most of the specimen out.
[[nodiscard]] Verdict verdict_of_map(const MapCoverage& coverage);

}  // namespace incise
