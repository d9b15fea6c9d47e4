#pragma once

#include <incise/geometry/types.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace incise::second_bench {

/// Eight single-precision numbers side by side: one for each piece of an octet.
using Lanes = float __attribute__((vector_size(32)));
inline constexpr int kLanes = 8;

/// A set of the 4 x 4 x 4 voxels of a brick, one bit each: bit = a + 4 b + 16 c for voxel (a, b, c).
using Voxels = std::uint64_t;
inline constexpr int kVoxelsAcross = 4;
inline constexpr int kVoxels = 64;

/// Returns the voxels that are connected through faces with the one of the lowest bit.
[[nodiscard]] Voxels first_connected(Voxels voxels);
/// Returns whether two sets of voxels touch across the face between neighbouring bricks.
/// @param low, high  of the bricks before and after that face along the axis.
[[nodiscard]] bool touch(Voxels low, Voxels high, int axis);

/// Planes of a graded rectangular grid, mm, ascending. Bricks lie between the planes; corners lie where three planes
/// cross.
struct BrickGrid {
  std::array<std::vector<double>, 3> planes_mm;

  [[nodiscard]] int bricks_along(int axis) const {
    return static_cast<int>(planes_mm[static_cast<std::size_t>(axis)].size()) - 1;
  }
  [[nodiscard]] std::size_t brick_count() const;
  [[nodiscard]] std::size_t brick(int i, int j, int k) const;
  [[nodiscard]] std::size_t corner(int i, int j, int k) const;
  [[nodiscard]] std::array<int, 3> place_of(std::size_t brick) const;
  [[nodiscard]] Vec3 low_mm(const std::array<int, 3>& place) const;
  [[nodiscard]] Vec3 size_mm(const std::array<int, 3>& place) const;
  [[nodiscard]] Vec3 voxel_mm(const std::array<int, 3>& place, int bit) const;
  /// Returns the index along an axis of the brick that contains a coordinate; outside the grid, the nearest index.
  [[nodiscard]] int along(int axis, double x_mm) const;
};

/// Material of a brick.
struct BrickMaterial {
  float c1_kpa = 1.0F;  ///< of the energy c1 (I1 - 3) + c2 (I1 - 3)²
  float c2_kpa = 0.5F;
  float lambda_kpa = 10.0F;    ///< of the volumetric energy lambda / 2 (J - 1)² - 2 c1 (J - 1)
  float fibre_kpa = 0.0F;      ///< k in the energy k (I4 - 1)² / 2 of stretched fibres
  Vec3 fibre = Vec3::UnitY();  ///< unit; direction of the fibres at rest
};

/// A point of tissue that moves with a piece.
struct Rider {
  int piece = -1;                  ///< -1: none
  std::array<float, 8> weights{};  ///< of the piece's corners, sum 1; trilinear
};

/// The eight corners and the state of eight pieces.
struct Octet {
  std::array<std::array<std::int32_t, kLanes>, 8> node;
  std::array<Lanes, 3> inverse_size;  ///< 1 / mm
  Lanes volume;                       ///< of tissue, mm³; 0: no piece
  Lanes hourglass;                    ///< stiffness of bending modes over 2 dW/dI1
  Lanes c1, c2, lambda, fibre;
  std::array<Lanes, 3> fibre_axis;
  std::array<Lanes, 6> past;  ///< viscous stress; within a step, the part of it besides gain · sudden stress. Second
                              ///< Piola-Kirchhoff: xx yy zz xy yz zx, kPa
};

/// Tissue as bricks with one integration point each. A cut parts it exactly along faces of voxels: a brick that comes
/// apart becomes one piece for each connected part, with its own corners (a composite element of [Dick2011]). mm, mN,
/// kPa, single precision.
struct BrickTissue {
  BrickGrid grid;
  std::vector<std::vector<int>> pieces_of;  ///< per brick

  std::vector<std::uint32_t> brick_of;  ///< per piece
  std::vector<Voxels> voxels_of;        ///< per piece; 0: gone
  std::vector<Octet> octets;            ///< piece p is lane p % 8 of octet p / 8

  // Per node. Lanes without a piece use node 0.
  std::vector<std::array<float, 4>> position;  ///< mm; the fourth is not used
  std::vector<std::array<float, 4>> velocity;  ///< mm per iteration
  std::vector<std::array<float, 4>> force;     ///< mN
  std::vector<float> mass;                     ///< mN per mm; fictitious, see bound_masses()
  std::vector<std::uint8_t> is_held;

  [[nodiscard]] bool is_there(int piece) const { return voxels_of[static_cast<std::size_t>(piece)] != 0; }
  [[nodiscard]] std::size_t piece_count() const { return voxels_of.size(); }
  [[nodiscard]] std::int32_t node(int piece, int corner) const {
    return octets[static_cast<std::size_t>(piece) / kLanes]
        .node[static_cast<std::size_t>(corner)][static_cast<std::size_t>(piece) % kLanes];
  }
  [[nodiscard]] Vec3 position_of(const Rider& rider) const;
  /// Returns a rider at a place at rest: on the piece with the nearest voxel, searched in the brick at that place and,
  /// as long as there is no tissue, in up to three layers of bricks round it. Without tissue there: piece -1.
  [[nodiscard]] Rider rider_at(const Vec3& rest_mm) const;
  /// Returns a rider on a given piece, at a place at rest in or near its brick.
  [[nodiscard]] Rider rider_on(int piece, const Vec3& rest_mm) const;
  /// Returns the piece that contains a voxel; -1: the voxel was removed.
  [[nodiscard]] int piece_with(std::size_t brick, int bit) const;
};

/// Makes tissue at rest.
/// @param materials, voxels  per brick of the grid.
[[nodiscard]] BrickTissue make_tissue(BrickGrid grid, const std::vector<BrickMaterial>& materials,
                                      const std::vector<Voxels>& voxels);

/// Removes voxels from pieces, and splits pieces whose remaining voxels are not connected. O(pieces changed).
/// @param gone  (piece, voxels): pieces in ascending order, each once.
void remove_voxels(BrickTissue& tissue, const std::vector<std::pair<int, Voxels>>& gone);

/// Shrinks a piece: sets its size at rest to `share` of its original size, along each axis.
void shrink(BrickTissue& tissue, int piece, float share);

/// Removes every piece that is not connected with a held node.
/// @returns the number of voxels removed.
std::size_t remove_loose(BrickTissue& tissue);

/// Sets `force` to the forces of the deformed tissue on its corners, weight included.
/// @param viscous_gain   from begin_step(); 0: the viscous stress is that in `past`.
/// @param weight_mn_mm3  weight per volume.
void set_tissue_forces(BrickTissue& tissue, float viscous_gain, float weight_mn_mm3);

/// Ratio of fictitious mass to a bound on stiffness: above 1/4, at which an undamped step of 1 is just stable.
inline constexpr float kMassShare = 0.35F;

/// Sets each node's fictitious mass such that an iteration of Relaxer is stable: kMassShare times the sum of bounds on
/// the largest eigenvalues of its pieces' tangents.
void bound_masses(BrickTissue& tissue, float viscous_gain);

/// Begins a step of `step_s` with viscosity, one branch: Q' = -Q / time + ratio S'. S is the sudden stress,
/// 2 c1 (C - I) and the terms of stiffening and fibres. Between steps `past` holds Q.
/// @returns the gain, the factor of the sudden stress within the step; pass it to end_step().
float begin_step(BrickTissue& tissue, float ratio, float time_s, float step_s);

/// Ends the step that begin_step() began: `past` holds Q again.
void end_step(BrickTissue& tissue, float gain);

/// Sets `past` to the viscous stress that remains `elapsed_s` after a sudden deformation to the present state.
void set_viscous_since(BrickTissue& tissue, float ratio, float time_s, float elapsed_s);

}  // namespace incise::second_bench
