#pragma once

#include "mechanics/aggregates.hpp"

#include <incise/mechanics/block_matrix.hpp>

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace incise {

using Vec6 = Eigen::Matrix<double, 6, 1>;

/// Rigid motions of groups of vertices: u_v = t + ω × arm_v for each vertex of an aggregate, without the axes that are
/// held. The second level of the preconditioner: C = T (Tᵀ Pᵀ A P T)⁻¹ Tᵀ, dense, where T drops the motions that an
/// aggregate cannot make.
class CoarseSpace {
 public:
  CoarseSpace(std::span<const Vec3> positions, std::size_t per_aggregate);

  /// Says which axes are held: bit i of held[v] for axis i of vertex v.
  void set_held(std::span<const std::uint8_t> held);
  /// Recomputes C. Throws InvalidArgument when the matrix is not positive definite on the coarse motions.
  void refresh(const BlockMatrix& matrix, Workers& workers);

  [[nodiscard]] const Aggregates& aggregates() const { return aggregates_; }
  [[nodiscard]] std::size_t size() const { return 6 * aggregates_.count(); }

  [[nodiscard]] const Vec3& arm(std::size_t v) const { return arm_[v]; }
  [[nodiscard]] const Vec3& is_free(std::size_t v) const { return free_[v]; }
  /// C, size() x size(), after the last refresh.
  [[nodiscard]] std::span<const double> inverse() const { return dense_; }

  /// Share of vertex v in Pᵀ r.
  void add_restricted(std::size_t v, const Vec3& r, Vec6& sum) const {
    const Vec3 f = r.cwiseProduct(free_[v]);
    sum.head<3>() += f;
    sum.tail<3>() += arm_[v].cross(f);
  }
  /// (P y)_v, given the six numbers of v's aggregate.
  [[nodiscard]] Vec3 prolonged(std::size_t v, const double* y) const {
    const Vec3 turn(y[3], y[4], y[5]);
    return (Vec3(y[0], y[1], y[2]) + turn.cross(arm_[v])).cwiseProduct(free_[v]);
  }
  /// y = C c.
  void apply(std::span<const double> c, std::span<double> y, Workers& workers) const;

 private:
  using Mat6 = Eigen::Matrix<double, 6, 6>;
  using Modes = Eigen::Matrix<double, 3, 6>;

  [[nodiscard]] Modes modes(std::size_t v) const;
  void project_rows(const BlockMatrix& matrix, std::size_t aggregate);
  [[nodiscard]] Mat6 independent_motions(std::size_t aggregate) const;
  void change_basis(const std::vector<Mat6>& basis, Workers& workers);
  void invert();
  void mirror();

  Aggregates aggregates_;
  std::vector<Vec3> arm_;      ///< per vertex: from the aggregate's centre, over its radius
  std::vector<Vec3> free_;     ///< per vertex: 1 along free axes, 0 along held ones
  std::vector<double> dense_;  ///< size() x size(), symmetric
};

}  // namespace incise
