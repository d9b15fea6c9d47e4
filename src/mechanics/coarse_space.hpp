#pragma once

#include "mechanics/aggregates.hpp"
#include "mechanics/coarse_cycle.hpp"

#include <incise/mechanics/block_matrix.hpp>

#include <Eigen/Core>
#include <span>
#include <vector>

namespace incise {

using Vec6 = Eigen::Matrix<double, 6, 1>;

/// Rows of the dense coarse inverse that one thread takes at a time.
inline constexpr std::size_t kCoarseRowsPerChunk = 256;

/// Second level of the preconditioner: the rigid motions of aggregates. P maps them to vertices: u_v = t + ω × arm_v on
/// free axes, 0 on held ones. C = T (Tᵀ Pᵀ A P T)⁻¹ Tᵀ, where T drops the motions that an aggregate cannot make. With
/// few aggregates C is dense; with more, one CoarseCycle replaces it.
class CoarseSpace {
 public:
  CoarseSpace(std::span<const Vec3> positions, std::size_t per_aggregate);

  /// Sets the held axes: bit i of held[v] for axis i of vertex v.
  void set_held(std::span<const std::uint8_t> held);
  /// Recomputes C. @throws InvalidArgument if the matrix is not positive definite on the coarse motions.
  void refresh(const BlockMatrix& matrix, Workers& workers);

  [[nodiscard]] const Aggregates& aggregates() const { return aggregates_; }
  [[nodiscard]] std::size_t size() const { return 6 * aggregates_.count(); }

  [[nodiscard]] const Vec3& arm(std::size_t v) const { return arm_[v]; }
  [[nodiscard]] const Vec3& is_free(std::size_t v) const { return free_[v]; }
  [[nodiscard]] bool is_dense() const { return groups_.count() == 0; }
  /// C of the last refresh, size() x size(), if it is dense.
  [[nodiscard]] std::span<const double> inverse() const { return dense_; }
  /// The cycle of the last refresh, which replaces C if it is not dense.
  [[nodiscard]] const CoarseCycle<double>& cycle() const { return cycle_; }

  /// Adds the contribution of vertex v to Pᵀ r.
  void add_restricted(std::size_t v, const Vec3& r, Vec6& sum) const {
    const Vec3 f = r.cwiseProduct(free_[v]);
    sum.head<3>() += f;
    sum.tail<3>() += arm_[v].cross(f);
  }
  /// Returns (P y)_v, given the six numbers of v's aggregate.
  [[nodiscard]] Vec3 prolonged(std::size_t v, const double* y) const {
    const Vec3 turn(y[3], y[4], y[5]);
    return (Vec3(y[0], y[1], y[2]) + turn.cross(arm_[v])).cwiseProduct(free_[v]);
  }
  /// Computes y = C c.
  void apply(std::span<const double> c, std::span<double> y, Workers& workers);

 private:
  using Mat6 = Eigen::Matrix<double, 6, 6>;
  using Modes = Eigen::Matrix<double, 3, 6>;

  [[nodiscard]] Modes modes(std::size_t v) const;
  template <class Target>
  void project_rows(const BlockMatrix& matrix, std::size_t aggregate, const Target& target) const;
  [[nodiscard]] Mat6 motions_of(std::size_t aggregate) const;
  void change_basis(const std::vector<Mat6>& basis, Workers& workers);
  void refresh_dense(const BlockMatrix& matrix, Workers& workers);

  void connect_aggregates(const BlockPattern& pattern);
  void project_blocks(const BlockMatrix& matrix, std::size_t aggregate);
  void find_basis(std::size_t aggregate);
  void change_block_basis(std::size_t aggregate);
  [[nodiscard]] Mat6 rigid_lift(std::size_t aggregate) const;
  void find_lifts();
  void project_groups();
  void refresh_cycle(const BlockMatrix& matrix, Workers& workers);

  Aggregates aggregates_;
  std::vector<Vec3> center_;    ///< per aggregate: centroid of its vertices, mm
  std::vector<double> radius_;  ///< per aggregate: root mean square distance from its centre, mm
  std::vector<Vec3> arm_;       ///< per vertex: offset from the aggregate's centre, divided by its radius
  std::vector<Vec3> free_;      ///< per vertex: 1 along free axes, 0 along held ones
  std::vector<double> dense_;   ///< size() x size(), symmetric
  Aggregates groups_;           ///< groups of aggregates; none if C is dense
  CoarseCycle<double> cycle_;
  std::vector<Mat6> blocks_;                     ///< blocks of the cycle, in its order, during a refresh
  std::vector<Mat6> basis_, into_basis_, lift_;  ///< per aggregate: T, its left inverse, the cycle's lift
};

}  // namespace incise
