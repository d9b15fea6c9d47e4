#pragma once

#include <cstddef>
#include <cstdint>

// Interface of the vectorised kernels: plain arrays only. Each kernel source is compiled once per instruction set; if
// it contained a template or inline function of Eigen or std, the linker might choose that copy for code that must run
// on any machine.

namespace incise {

inline constexpr int kBatchTets = 8;  ///< tets stored side by side; a multiple of every kernel's number of lanes

/// Eight tets as a structure of arrays. Corners are sorted by vertex number, so block (a, b) with a < b lies above the
/// diagonal.
struct alignas(64) TetBatch {
  double gradients[3][3][kBatchTets];  ///< of the shape functions of corners 1 to 3, per axis, 1/mm; corner 0 is minus
                                       ///< their sum
  double lambda[kBatchTets];           ///< volume times λ, µJ; 0 in places without a tet
  double mu[kBatchTets];               ///< volume times μ, µJ
  std::int32_t vertices[4][kBatchTets];
  std::int32_t slots[10][kBatchTets];  ///< of the blocks 00 01 02 03 11 12 13 22 23 33
  std::int32_t tets[kBatchTets];       ///< -1: no tet here
};

enum class SweepTangent { None, FrozenRotations, Exact, Projected };

/// The tets whose tangent of frozen rotations is in the matrix.
struct AssembledTets {
  const TetBatch* first_batch;
  double* rotations;    ///< 9 x 8 numbers per batch, rotations by columns: those of the tets' blocks in the matrix
  double* fill;  ///< eight per batch: the fill of the tet's blocks in the matrix; 0: they are not in it
  std::uint8_t* is_changed;  ///< per vertex: set to 1 for the corners of tets whose blocks change
  double turn_limit;         ///< |R - R before|² (Frobenius) above which a tet's blocks are reassembled
};

/// One pass over some batches: rotations and energy, and forces and tangent if requested.
struct TetSweep {
  const TetBatch* batches;
  std::size_t count;
  const double* positions;      ///< 3 per vertex, mm
  const std::uint8_t* is_live;  ///< per tet
  const double* fill;           ///< per tet: the remaining share of its stiffness; null: 1
  const double* rotations;      ///< 9 per tet, by columns: where Newton's method starts
  double* new_rotations;        ///< the same array; null: rotations are not stored
  double* forces;               ///< 3 per vertex, mN: adds to them; null: not requested
  double* values;  ///< 9 per block, by rows, mN/mm: adds to blocks on and above the diagonal; null: not requested
  SweepTangent tangent;
  /// Null: adds the tangent of every live tet. Otherwise (frozen rotations only): adds the difference from `assembled`,
  /// for tets that turned, changed their fill, or became or ceased to be live, and updates `assembled`.
  const AssembledTets* assembled;
  /// Computes the rotation of one tet (f and r by rows, r holds the guess) if Newton's method is not certain to find
  /// the maximum.
  void (*robust_rotation)(const double* f, double* r);
};

/// Rows of a matrix of 3 x 3 blocks.
template <class Real>
struct BlockRows {
  const std::int32_t* row_start;
  const std::int32_t* column;
  const Real* values;
};

/// Unit of a matrix of 16-bit integers: block (i, j) is s_i s_j / kWholeOne times the stored integers; the summed
/// rounding errors of its row are added to each diagonal block.
inline constexpr float kWholeOne = 32000.0F;     // below the largest 16-bit integer
inline constexpr std::size_t kBeyondBlocks = 8;  ///< numbers that a load may read beyond the last block

/// The vectors of conjugate gradients in single precision, four numbers per vertex, the last one 0.
struct PcgVectors {
  float* x;
  float* r;
  float* z;
  float* p;
  float* q;
  const float* inverse_diagonal;  ///< 12 per vertex: three columns of four
  const float* arm;               ///< offset from the aggregate's centre, divided by its radius
  const float* is_free;           ///< 1 along free axes, 0 along held ones
  float* scaled_p;                ///< s p
  const float* scale;             ///< s, one per vertex
  const float* left;              ///< 9 per vertex, by rows: summed rounding errors of its row, in s_i s_i / kWholeOne
};

/// One entry per kernel. Those with `begin` and `end` write rows [begin, end) only.
struct KernelTable {
  double (*sweep_tets)(const TetSweep&);  ///< returns the elastic energy, µJ
  void (*multiply_double)(const BlockRows<double>&, const double* x, double* y, std::size_t begin, std::size_t end);
  /// y_i = sum over j of column_j[i] c_j, for a dense n x n matrix stored by columns.
  void (*multiply_dense)(const double* matrix, std::size_t n, const double* c, double* y, std::size_t begin,
                         std::size_t end);
  /// q = A p for a matrix of 16-bit integers, from s p and s; returns p · q.
  double (*multiply_whole)(const BlockRows<std::int16_t>&, const PcgVectors&, std::size_t begin, std::size_t end);
  /// Rounds each number of a block times `factor` to the nearest integer; adds the rounding errors, times `weight`, to
  /// the nine numbers of `left`. @returns whether no magnitude exceeds kWholeOne; if one does, the integers are
  /// invalid.
  bool (*round_block)(const double* block, float factor, float weight, std::int16_t* whole, float* left);
  /// x += alpha p, r -= alpha q, z = D⁻¹ r over one aggregate; writes its six numbers of Pᵀ r; adds to |r|² and r · z.
  void (*move_four)(const PcgVectors&, float alpha, std::size_t begin, std::size_t end, float* restricted, double* rr,
                    double* rz);
  /// p = z + (t + ω x arm) on free axes + beta p over one aggregate, with its six numbers (t, ω); and s p.
  void (*turn_four)(const PcgVectors&, float beta, const float* motion, std::size_t begin, std::size_t end);
  /// y = C c for a dense n x n matrix stored by rows.
  void (*multiply_dense_rows)(const float* matrix, std::size_t n, const float* c, float* y, std::size_t begin,
                              std::size_t end);
  /// Sum of 6 x 6 blocks (six columns of eight numbers) times six of the eight numbers of x at each block's column;
  /// eight numbers, the last two 0.
  void (*sum_blocks_double)(const double* blocks, const std::int32_t* column, std::size_t count, const double* x,
                            double* sum);
  void (*sum_blocks_single)(const float* blocks, const std::int32_t* column, std::size_t count, const float* x,
                            float* sum);
};

/// Returns the kernels of active_isa().
[[nodiscard]] const KernelTable& kernels();

extern const KernelTable kPortableKernels;
#if defined(INCISE_X86_KERNELS)
extern const KernelTable kAvx2Kernels;
extern const KernelTable kAvx512Kernels;
#endif

}  // namespace incise
