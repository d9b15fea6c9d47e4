#pragma once

#include <incise/geometry/types.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace incise::second_bench {

/// Eight single-precision numbers side by side: one for each piece of an octet.
using Lanes = float __attribute__((vector_size(32)));
inline constexpr int kLanes = 8;

/// 4 x 4 x 4 voxels of a brick, one bit each: bit = a + 4 b + 16 c for voxel (a, b, c).
using Voxels = std::uint64_t;
inline constexpr int kVoxelsAcross = 4;
inline constexpr int kVoxels = 64;

/// The part of `voxels` that hangs together, by faces, with their lowest one.
[[nodiscard]] Voxels first_connected(Voxels voxels);
/// Whether two sets of voxels touch across the face between bricks that are neighbours along an axis; `low` lies before
/// `high` on it.
[[nodiscard]] bool touch(Voxels low, Voxels high, int axis);

/// Planes of a graded rectangular grid, mm, ascending. Between them lie the bricks; where they cross lie the corners.
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
  /// The brick along an axis that holds a coordinate; the first or the last for one outside.
  [[nodiscard]] int along(int axis, double x_mm) const;
};

/// What the tissue of a brick is made of.
struct BrickMaterial {
  float c1_kpa = 1.0F;  ///< of the energy c1 (I1 - 3) + c2 (I1 - 3)²
  float c2_kpa = 0.5F;
  float lambda_kpa = 10.0F;  ///< of the volume: lambda / 2 (J - 1)² - 2 c1 (J - 1)
  float fibre_kpa = 0.0F;    ///< k in k (I4 - 1)² / 2 of stretched fibres
  Vec3 fibre = Vec3::UnitY();
};

/// A point of tissue: it moves with the piece that holds it.
struct Rider {
  int piece = -1;
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
  std::array<Lanes, 6> past;  ///< viscous stress; within a step what counts beside gain times sudden stress. Second
                              ///< Piola-Kirchhoff: xx yy zz xy yz zx, kPa
};

/// Tissue as bricks with one integration point each. A cut parts it exactly along faces of voxels: a brick that falls
/// apart becomes as many pieces, each with corners of its own, as the parts that hang together (a composite element of
/// [Dick2011]). mm, mN, kPa, single precision.
struct BrickTissue {
  BrickGrid grid;
  std::vector<std::vector<int>> pieces_of;  ///< per brick

  std::vector<std::uint32_t> brick_of;  ///< per piece
  std::vector<Voxels> voxels_of;        ///< per piece; 0: gone
  std::vector<Octet> octets;            ///< piece p is lane p % 8 of octet p / 8

  // Per node. Node 0 belongs to lanes without a piece.
  std::vector<std::array<float, 4>> position;  ///< mm; the fourth is not used
  std::vector<std::array<float, 4>> velocity;  ///< mm per iteration
  std::vector<std::array<float, 4>> force;     ///< mN
  std::vector<float> mass;                     ///< mN per mm: fictitious, see bound_masses()
  std::vector<std::uint8_t> is_held;

  [[nodiscard]] bool is_there(int piece) const { return voxels_of[static_cast<std::size_t>(piece)] != 0; }
  [[nodiscard]] std::size_t piece_count() const { return voxels_of.size(); }
  [[nodiscard]] std::int32_t node(int piece, int corner) const {
    return octets[static_cast<std::size_t>(piece) / kLanes]
        .node[static_cast<std::size_t>(corner)][static_cast<std::size_t>(piece) % kLanes];
  }
  [[nodiscard]] Vec3 position_of(const Rider& rider) const;
  /// A rider at a place of the body at rest: of the piece that holds the nearest voxel of the nearest brick with
  /// tissue.
  [[nodiscard]] Rider rider_at(const Vec3& rest_mm) const;
  /// A rider on a given piece, at a place of the body at rest in or near its brick.
  [[nodiscard]] Rider rider_on(int piece, const Vec3& rest_mm) const;
  /// The piece with a voxel; -1: gone.
  [[nodiscard]] int piece_with(std::size_t brick, int bit) const;
};

/// Tissue at rest. @param materials, voxels  per brick of the grid.
[[nodiscard]] BrickTissue make_tissue(BrickGrid grid, const std::vector<BrickMaterial>& materials,
                                      const std::vector<Voxels>& voxels);

/// Takes voxels out of pieces, and parts what no longer hangs together. O(pieces changed).
/// @param gone  (piece, voxels): pieces in ascending order, each once.
void remove_voxels(BrickTissue& tissue, const std::vector<std::pair<int, Voxels>>& gone);

/// Shrinks a piece: its size at rest becomes `share` of what it was made with, along each axis.
void shrink(BrickTissue& tissue, int piece, float share);

/// Takes out every piece that hangs on no held node. Returns how many voxels that were.
std::size_t remove_loose(BrickTissue& tissue);

/// Sets `force` to what deformed tissue exerts on its corners, and its weight.
/// @param viscous_gain  of begin_step(); 0: nothing is viscous but what `past` holds.
void set_tissue_forces(BrickTissue& tissue, float viscous_gain, float weight_mn_mm3);

/// Of a bound on a stiffness, as fictitious mass: above a quarter, at which an undamped step of 1 is just stable.
inline constexpr float kMassShare = 0.35F;

/// Sets each node's fictitious mass so that an iteration of Relaxer is stable: kMassShare of the sum of bounds on the
/// largest eigenvalues of its pieces' tangents.
void bound_masses(BrickTissue& tissue, float viscous_gain);

/// Viscosity, one branch: Q' = -Q / time + ratio S', S = 2 c1 (C - I) and what stiffens, the sudden stress. Between
/// steps `past` holds Q. Makes ready for a step of `step_s`.
/// @return the gain by which sudden stress counts within the step; end_step() takes it.
float begin_step(BrickTissue& tissue, float ratio, float time_s, float step_s);

/// Ends the step that begin_step() began: `past` holds Q again.
void end_step(BrickTissue& tissue, float gain);

/// The viscous stress that is left `elapsed_s` after a sudden deformation to the present state.
void set_viscous_since(BrickTissue& tissue, float ratio, float time_s, float elapsed_s);

}  // namespace incise::second_bench
