#pragma once

#include <incise/geometry/types.hpp>
#include <incise/mechanics/tissue.hpp>

#include <filesystem>
#include <string>

namespace incise {

/// A held specimen, for another solver. Vertices and tets keep their order; units stay mm, kg, s (kPa, mN).
struct InterchangeCase {
  const TissueModel& model;           ///< must outlive this
  Vec3 gravity_mm_s2 = Vec3::Zero();  ///< as the model was made with
  std::string title;
  std::string provenance;  ///< who wrote it and from what, for a comment
};

// What an export cannot say is refused, never left out: @throws CaseError naming the field of the case. What the other
// program does differently is said in comments of the file: docs/interchange.md.

/// SOFA scene as XML (.scn, SOFA 24.12 or later): the same tets with the same polar rotation, run by implicit Euler
/// until at rest. Refused: fibres, holder surfaces, a stiffness that varies together with the Neo-Hookean law.
[[nodiscard]] std::string sofa_scene_xml(const InterchangeCase& specimen);

/// FEBio input (.feb, febio_spec 4.0), static. Vertices and tets are numbered from 1. A support, plane or surface, is a
/// rigid shell with sliding contact; its nodes and triangles follow those of the tissue. Refused: fibres.
[[nodiscard]] std::string febio_input_xml(const InterchangeCase& specimen);

/// Writes the text of either, all or nothing. @throws as above; DataError if the file cannot be written.
void write_sofa_scene(const std::filesystem::path& path, const InterchangeCase& specimen);
void write_febio_input(const std::filesystem::path& path, const InterchangeCase& specimen);

}  // namespace incise
