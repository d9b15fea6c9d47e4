#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/ids.hpp>
#include <incise/geometry/types.hpp>

#include <cstdint>
#include <vector>

namespace incise {

/// What a cut by points (CutRule::Lattice) has done to the points of its lattice, tet by tet: first all points of the
/// tet that the tool came near first. Which points a tet has follows from the whole mesh alone (PointLattice).
struct CutPoints {
  std::vector<TetId> tets;                ///< of the whole mesh, that the tool came near, in that order
  std::vector<TetId> tet_of;              ///< per point: that of the split mesh with which it moves
  std::vector<double> dose;               ///< per point: parted from 1 on; goes on growing
  std::vector<std::uint8_t> is_held;      ///< per point: within the tool's reach
  std::vector<Vec3> offset_mm;            ///< of a held point from the tip when it came within reach, less its slip
  std::vector<std::int32_t> parted_step;  ///< in which a point parted; -1: it did not
  std::vector<Vec3> parted_mm;            ///< where it was then
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
