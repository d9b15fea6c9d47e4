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
  v("tets", p.tets, "Tets near which the tool has come, in that order.");
  v("tet_of", p.tet_of, "For each point: the tet of the split mesh with which it moves.");
  v("dose", p.dose, "Dose of each point; from 1 on it is parted.");
  v("is_held", p.is_held, "For each point: whether it is within the tool's reach.");
  v("offset_mm", p.offset_mm, "Vector from the tip to each held point when it came within reach, less its slip.");
  v("parted_step", p.parted_step, "Step in which each point parted; -1: it did not.");
  v("parted_mm", p.parted_mm, "Position of each parted point at that step.");
}

}  // namespace incise
