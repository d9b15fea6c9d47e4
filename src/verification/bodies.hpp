#pragma once

#include <incise/mechanics/tissue.hpp>

#include <cstdint>

namespace incise {

/// The vertices of a body in a plane across an axis (0: x, 1: y, 2: z), as a region.
[[nodiscard]] Region plane_across(int axis, double at_mm);
/// Held along one axis in that plane: a plane of symmetry.
[[nodiscard]] Constraint symmetry_across(int axis, double at_mm = 0.0);

/// A block whose inner vertices are moved at random by up to `share` of a cell: no two tets alike, boundary and volume
/// kept.
[[nodiscard]] TetMesh irregular_block(const Vec3& size_mm, std::array<int, 3> cells, double share, std::uint64_t seed);

/// Moves the whole boundary of a model by x = F X, and holds it there.
void prescribe_boundary(TissueModel& model, const Mat3& f);

/// The eighth x, y, z >= 0 of a hollow sphere of radii a and 2a: the cells of a block [0, 2n]³ that lie outside [0,
/// n]³, pushed out along rays so that max(x, y, z) becomes the radius. 42 n³ tets.
[[nodiscard]] TetMesh eighth_of_a_sphere(double inner_radius_mm, int n);

/// Adds the pressure (kPa) on the boundary faces whose corners all lie within 1e-6 mm of radius `at_mm`, as dead loads
/// outwards.
void add_pressure_outwards(TissueModel& model, double at_mm, double pressure_kpa);

/// Cook's panel, corners (0, 0), (48, 44), (48, 60), (0, 44) mm, as a slice of one layer of n x n cells.
[[nodiscard]] TetMesh cooks_panel(int n);

/// Mean displacement of the selected vertices, mm.
[[nodiscard]] Vec3 mean_displacement(const TissueModel& model, const TissueState& state, const Region& where);

}  // namespace incise
