#include "verification/check.hpp"

#include <fmt/format.h>

#include <cmath>

namespace incise {

namespace {
constexpr int kMaxNewtonIterations = 200;  // large rotations take many load steps
}

StaticResult solved(const CheckContext& context, const TissueModel& model, const TissueState* start,
                    double relative_tolerance) {
  const StaticSettings settings{.relative_tolerance = relative_tolerance,
                                .max_newton_iterations = kMaxNewtonIterations};
  StaticResult result = solve_static(model, settings, context.workers, context.monitor, start);
  if (result.outcome == Outcome::Cancelled) throw Cancelled("verifying: stopped on request");
  if (result.outcome != Outcome::Success) {
    throw NotSolved(fmt::format("static equilibrium of {} tets ({}): {} after {} Newton iterations, residual {:.2g}",
                                model.mesh.tets.size(), law_text(model.material), to_string(result.outcome),
                                result.iterations, result.relative_residual));
  }
  return result;
}

void require_small_error(double relative_error, double bound) {
  if (std::abs(relative_error) <= bound) return;
  throw NotSolved(fmt::format("the finest mesh is {:.2f} % off before extrapolation, at most {:g} % is allowed",
                              100.0 * relative_error, 100.0 * bound));
}

Mat3 mean_stress_kpa(const CheckContext& context, const TissueModel& model, const TissueState& state) {
  TissueState copy = state;
  Points forces(model.mesh.vertices.size(), Vec3::Zero());
  add_elastic_response(model, copy, forces, nullptr, context.workers);
  Mat3 sum = Mat3::Zero();
  for (std::size_t v = 0; v < forces.size(); ++v) sum -= forces[v] * model.mesh.vertices[v].transpose();
  return sum / volume_mm3(model.mesh);
}

std::string law_text(const Material& material) {
  std::string text = material.model == MaterialModel::Corotational ? "corotational" : "stable Neo-Hookean";
  if (material.volume == VolumeTreatment::Averaged) text += ", averaged volume";
  if (material.fibre_modulus_kpa > 0.0) text += ", fibres";
  return text;
}

VerificationCheck described(std::string what, std::string source, std::string unit, double expected, double tolerance) {
  return {.what = std::move(what),
          .source = std::move(source),
          .unit = std::move(unit),
          .expected = expected,
          .tolerance = tolerance};
}

LineSeries line_of_order(const LineSeries& errors, double order, std::string name) {
  LineSeries line{std::move(name), {}, {}, true};
  for (const double n : errors.x) line.add(n, errors.y[0] * std::pow(errors.x[0] / n, order));
  return line;
}

std::string errors_text(const LineSeries& errors, const char* cells) {
  std::string text;
  for (std::size_t i = 0; i < errors.x.size(); ++i) {
    text += fmt::format("{}{:.0f} {}: {:.2f} % off", i > 0 ? ", " : "", errors.x[i], cells, 100.0 * errors.y[i]);
  }
  return text;
}

}  // namespace incise
