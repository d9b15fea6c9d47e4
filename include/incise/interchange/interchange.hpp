#pragma once

#include <incise/geometry/types.hpp>
#include <incise/mechanics/tissue.hpp>

#include <string>

namespace incise {

/// A held specimen to export to another solver. Vertices and tets keep their order; units stay mm, kg, s (kPa, mN).
struct InterchangeCase {
  const TissueModel& model;           ///< must outlive this
  Vec3 gravity_mm_s2 = Vec3::Zero();  ///< the value with which the model was made
  std::string title;
  std::string provenance;  ///< writer and source, for a comment in the file
};

// An export refuses features that the format cannot express: @throws CaseError naming the field of the case. Only
// viscosity is left out, because the files describe equilibrium. Comments in the file state this, and what the other
// program does differently. docs/interchange.md

/// Returns a SOFA scene as XML (.scn, SOFA 24.12 or later): the same tets with the same polar rotation, moved by
/// implicit Euler towards rest. Refused: fibres, stiffening, holder surfaces, a stiffness that varies together with the
/// Neo-Hookean law.
[[nodiscard]] std::string sofa_scene_xml(const InterchangeCase& specimen);

/// Returns static FEBio input as XML (.feb, febio_spec 4.0). Vertices and tets are numbered from 1. A support, plane or
/// surface, is a rigid shell with sliding contact; its nodes and triangles follow those of the tissue. Refused: fibres,
/// stiffening.
[[nodiscard]] std::string febio_input_xml(const InterchangeCase& specimen);

}  // namespace incise
