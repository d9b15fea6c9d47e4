#pragma once

#include <incise/mechanics/tissue.hpp>

#include <cstdint>

namespace incise {

/// Returns the region of all vertices in the plane across an axis (0: x, 1: y, 2: z) at `at_mm`.
[[nodiscard]] Region plane_across(int axis, double at_mm);
/// Returns a constraint that holds this plane along its axis: a plane of symmetry.
[[nodiscard]] Constraint symmetry_across(int axis, double at_mm = 0.0);

/// Makes a block whose inner vertices are moved at random, along each axis by up to `share` of the shortest side of a
/// cell: no two tets are alike; boundary and volume do not change.
[[nodiscard]] TetMesh irregular_block(const Vec3& size_mm, std::array<int, 3> cells, double share, std::uint64_t seed);

/// Prescribes x = F X for the whole boundary of a model.
void prescribe_boundary(TissueModel& model, const Mat3& f);

/// Makes the eighth x, y, z >= 0 of a hollow sphere, outer radius twice the inner: the cells of a block [0, 2n]³
/// outside [0, n]³, mapped so that max(x, y, z) becomes the radius. 42 n³ tets.
[[nodiscard]] TetMesh eighth_of_a_sphere(double inner_radius_mm, int n);

/// Adds a pressure (kPa) as outward dead loads on the boundary faces whose corners all lie within 1e-6 mm of radius
/// `at_mm`.
void add_pressure_outwards(TissueModel& model, double at_mm, double pressure_kpa);

/// Makes Cook's panel, corners (0, 0), (48, 44), (48, 60), (0, 44) mm, as one layer, 1 mm thick, of n x n cells.
[[nodiscard]] TetMesh cooks_panel(int n);

/// Returns the mean displacement, mm, of the vertices in a region. @throws InvalidArgument if there are none.
[[nodiscard]] Vec3 mean_displacement(const TissueModel& model, const TissueState& state, const Region& where);

}  // namespace incise
