#pragma once

#include <incise/mechanics/tissue.hpp>

namespace incise {

/// Fills the arrays of `model` that follow from its tets alone: vertex_tets, stars, pattern and tet_slots.
void add_topology(TissueModel& model);

}  // namespace incise
