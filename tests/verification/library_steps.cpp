#include "verification/library_steps.hpp"

#include <incise/mechanics/solvers.hpp>

#include <stdexcept>

namespace incise::testing {

Points library_steps(const TissueModel& model, const SofaStepping& stepping) {
  const double h = stepping.step_s;
  const double a = stepping.damping_mass;
  const double b = stepping.damping_stiffness;
  Workers workers(1);
  TissueState state = rest_state(model);
  const std::size_t count = state.positions.size();
  Points velocity(count, Vec3::Zero());
  Points product(count);
  Points change(count);
  SparseCholesky cholesky(model.pattern);
  for (int step = 0; step < stepping.steps; ++step) {
    BlockMatrix matrix(model.pattern);
    Points right = model.dead_load_mn;
    add_elastic_response(model, state, right, &matrix, workers);
    multiply(matrix, velocity, product, workers);
    for (std::size_t v = 0; v < count; ++v) {
      right[v] = h * (right[v] - (h + b) * product[v] - a * model.vertex_mass_kg[v] * velocity[v]);
    }
    for (double& value : matrix.values) value *= h * h + h * b;
    for (std::size_t v = 0; v < count; ++v) {
      for (const int i : {0, 4, 8})
        matrix.block(model.pattern->diagonal[v])[i] += (1.0 + h * a) * model.vertex_mass_kg[v];
    }
    hold_constrained(model, matrix, right);
    if (!cholesky.factor(matrix)) throw std::runtime_error("the matrix of a step is not positive definite");
    cholesky.solve(right, change);
    for (std::size_t v = 0; v < count; ++v) {
      velocity[v] += change[v];
      state.positions[v] += h * velocity[v];
    }
  }
  return state.positions;
}

}  // namespace incise::testing
