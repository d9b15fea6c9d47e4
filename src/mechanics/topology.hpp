#pragma once

#include <incise/mechanics/tissue.hpp>

namespace incise {

/// Fills the arrays of `model` that follow from its tets alone: vertex_tets, stars, pattern and tet_slots.
void add_topology(TissueModel& model);
/// As add_topology, for a model on the split mesh of `whole`: copies the rows of the matrix from there, except around
/// splits. O(M). With averaged volume all rows are built again.
void add_split_topology(TissueModel& model, const TissueModel& whole, const MeshSplits& splits);

}  // namespace incise
