#pragma once

#include <incise/mechanics/tissue.hpp>

namespace incise {

/// Fills the arrays of `model` that follow from its tets alone: vertex_tets, stars, pattern and tet_slots.
void add_topology(TissueModel& model);
/// As add_topology, for a model whose mesh is split_mesh of that of `whole`: rows of the matrix are taken from there
/// except about splits. O(M); where volumes are averaged, all rows are made anew.
void add_split_topology(TissueModel& model, const TissueModel& whole, const MeshSplits& splits);

}  // namespace incise
