#include "mechanics/loads.hpp"
#include "mechanics/shape_gradients.hpp"
#include "mechanics/vector_text.hpp"

#include <incise/core/error.hpp>
#include <incise/mechanics/fibre_field.hpp>

#include <fmt/format.h>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cstdint>
#include <span>

namespace incise {
namespace {

constexpr const char* kField = "specimen.material.fibre_field";
/// Of the relative residual. Where the potential is flat, its gradient is then noise far below kLeastGradient.
constexpr double kTolerance = 1e-12;
/// Gradient, as a share of the body's mean gradient, below which the potential counts as flat.
constexpr double kLeastGradient = 1e-6;

void require_disjoint(const TetMesh& mesh, std::span<const VertexId> from, std::span<const VertexId> to) {
  const auto common = std::ranges::find_if(to, [&](VertexId v) { return std::ranges::binary_search(from, v); });
  if (common == to.end()) return;
  throw CaseError("case", fmt::format("{}.to", kField),
                  fmt::format("vertex {} at {} mm, which is also in `from`", common->value,
                              text_of(mesh.vertices[common->index()])),
                  "two regions apart from each other", "Make one of them smaller");
}

/// Laplace's equation for the potential at the vertices, which is given in both regions and unknown elsewhere.
class Potential {
 public:
  Potential(const TetMesh& mesh, std::span<const VertexId> from, std::span<const VertexId> to)
      : mesh_(mesh), values_(mesh.vertices.size(), 0.0), unknown_(mesh.vertices.size(), 0) {
    constexpr std::int32_t kHeld = -1;
    for (const VertexId v : from) unknown_[v.index()] = kHeld;
    for (const VertexId v : to) {
      unknown_[v.index()] = kHeld;
      values_[v.index()] = 1.0;
    }
    std::int32_t count = 0;
    for (std::int32_t& place : unknown_) {
      if (place != kHeld) place = count++;
    }
    load_ = Eigen::VectorXd::Zero(count);
  }

  void solve(int most_iterations, FibreDirections& result) {
    if (load_.size() == 0) return;
    const Eigen::SparseMatrix<double> matrix = assembled();
    Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower> solver;
    solver.setTolerance(kTolerance);
    solver.setMaxIterations(most_iterations);
    solver.compute(matrix);
    const Eigen::VectorXd found = solver.solve(load_);
    result.iterations = static_cast<int>(solver.iterations());
    result.residual = solver.error();
    // Written so that a NaN residual counts as not converged.
    if (!(result.residual <= kTolerance) || !found.allFinite()) result.outcome = Outcome::NotConverged;
    for (std::size_t v = 0; v < values_.size(); ++v) {
      if (unknown_[v] >= 0) values_[v] = found[unknown_[v]];
    }
  }

  /// Returns the gradient in a tet, 1/mm. Differences are taken first: a constant potential has exactly the gradient 0.
  [[nodiscard]] Vec3 gradient(std::size_t t, const ShapeGradients& shape) const {
    const Tet& tet = mesh_.tets[t];
    Vec3 sum = Vec3::Zero();
    for (std::size_t c = 1; c < 4; ++c) sum += (values_[tet[c].index()] - values_[tet[0].index()]) * shape.gradients[c];
    return sum;
  }

 private:
  /// Returns the lower triangle of the matrix of the unknown vertices; moves the known ones to the load.
  Eigen::SparseMatrix<double> assembled() {
    std::vector<Eigen::Triplet<double, std::int32_t>> entries;
    entries.reserve(10 * mesh_.tets.size());
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      const ShapeGradients shape = shape_gradients(mesh_, t);
      for (std::size_t a = 0; a < 4; ++a) {
        const std::size_t row_vertex = mesh_.tets[t][a].index();
        const std::int32_t row = unknown_[row_vertex];
        if (row < 0) continue;
        for (std::size_t b = 0; b < 4; ++b) {
          const std::size_t column_vertex = mesh_.tets[t][b].index();
          const std::int32_t column = unknown_[column_vertex];
          const double conductance = shape.volume_mm3 * shape.gradients[a].dot(shape.gradients[b]);
          if (column < 0) {
            load_[row] -= conductance * values_[column_vertex];
          } else if (column <= row) {
            entries.emplace_back(row, column, conductance);
          }
        }
      }
    }
    Eigen::SparseMatrix<double> matrix(load_.size(), load_.size());
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  }

  const TetMesh& mesh_;
  std::vector<double> values_;
  std::vector<std::int32_t> unknown_;  ///< per vertex: its index among the unknown ones; negative: given
  Eigen::VectorXd load_;
};

/// Gives flat tets the volume-weighted mean direction of those neighbours that have one, layer after layer. A fibre's
/// direction has no sign: each neighbour's is first turned towards the sum so far, so the mean is never zero.
void spread(const TetMesh& mesh, std::span<const double> volumes_mm3, std::vector<std::size_t> flat,
            std::vector<Vec3>& directions) {
  const std::vector<std::array<std::int32_t, 4>> neighbours = face_neighbours(mesh);
  std::vector<std::uint8_t> has_direction(mesh.tets.size(), 1);
  for (const std::size_t t : flat) has_direction[t] = 0;
  while (!flat.empty()) {
    std::vector<std::size_t> done;
    for (const std::size_t t : flat) {
      Vec3 sum = Vec3::Zero();
      for (const std::int32_t neighbour : neighbours[t]) {
        if (neighbour < 0 || has_direction[static_cast<std::size_t>(neighbour)] == 0) continue;
        const Vec3& own = directions[static_cast<std::size_t>(neighbour)];
        sum += (own.dot(sum) < 0.0 ? -1.0 : 1.0) * volumes_mm3[static_cast<std::size_t>(neighbour)] * own;
      }
      if (sum.isZero(0.0)) continue;
      directions[t] = sum.normalized();
      done.push_back(t);
    }
    INCISE_REQUIRE(!done.empty(), "expected tets that are joined by their faces");
    for (const std::size_t t : done) has_direction[t] = 1;
    std::erase_if(flat, [&](std::size_t t) { return has_direction[t] != 0; });
  }
}

}  // namespace

FibreDirections fibre_directions(const TetMesh& mesh, const FibreField& field, int most_iterations) {
  INCISE_REQUIRE(find_problems(mesh).empty(), "expected a sound mesh");
  const std::vector<VertexId> from = selected_vertices(mesh, field.from, fmt::format("{}.from", kField));
  const std::vector<VertexId> to = selected_vertices(mesh, field.to, fmt::format("{}.to", kField));
  require_disjoint(mesh, from, to);

  FibreDirections result;
  Potential potential(mesh, from, to);
  potential.solve(most_iterations, result);
  if (result.outcome != Outcome::Success) return result;

  std::vector<double> volumes_mm3(mesh.tets.size());
  result.directions.resize(mesh.tets.size());
  double sum = 0.0, volume_mm3 = 0.0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const ShapeGradients shape = shape_gradients(mesh, t);
    result.directions[t] = potential.gradient(t, shape);
    volumes_mm3[t] = shape.volume_mm3;
    volume_mm3 += shape.volume_mm3;
    sum += shape.volume_mm3 * result.directions[t].norm();
  }
  const double least = kLeastGradient * sum / volume_mm3;
  std::vector<std::size_t> flat;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (result.directions[t].norm() < least) {
      flat.push_back(t);
    } else {
      result.directions[t].normalize();
    }
  }
  result.flat_tets = flat.size();
  spread(mesh, volumes_mm3, std::move(flat), result.directions);
  return result;
}

}  // namespace incise
