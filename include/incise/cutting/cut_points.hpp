#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/ids.hpp>
#include <incise/geometry/types.hpp>

#include <cstdint>
#include <vector>

namespace incise {

/// State of the points of a cut by points (CutRule::Lattice), ordered by tet: first all points of the first tet in
/// `tets`, and so on. The whole mesh alone determines which points a tet has (PointLattice).
struct CutPoints {
  std::vector<TetId> tets;                ///< tets of the whole mesh near which the tool has come, in that order
  std::vector<TetId> tet_of;              ///< per point: the tet of the split mesh with which it moves
  std::vector<double> dose;               ///< per point, >= 0; the point is parted at 1, and its dose still grows
  std::vector<std::uint8_t> is_held;      ///< per point: 1 within the tool's reach
  std::vector<Vec3> offset_mm;            ///< per held point: from the tip to its holding place, mm
  std::vector<std::int32_t> parted_step;  ///< per point: the step in which it parted; -1: not parted
  std::vector<Vec3> parted_mm;            ///< per parted point: its current position at that step, mm
};
inline void describe(Visitor& v, CutPoints& p) {
  v("tets", p.tets, "That the tool came near, in that order.");
  v("tet_of", p.tet_of, "Of the split mesh, with which a point moves.");
  v("dose", p.dose, "Of each point: parted from 1 on.");
  v("is_held", p.is_held, "Whether a point is within the tool's reach.");
  v("offset_mm", p.offset_mm, "Of a held point from the tip when it came within reach, less its slip.");
  v("parted_step", p.parted_step, "In which a point parted; -1: it did not.");
  v("parted_mm", p.parted_mm, "Where it was then.");
}

}  // namespace incise
