// A block sheared at once and held: with one Prony term its stress falls exponentially to the long-time value.
#include "verification/bodies.hpp"
#include "verification/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr double kShear = 1e-4;                // small, because the closed form is linear viscoelasticity
constexpr double kStep = 0.05;                 // s
constexpr int kSteps = 40;                     // four relaxation times
constexpr double kRelaxationTolerance = 1e-6;  // the step rule is exact; the error is of the order of the strain
constexpr PronyTerm kTerm{1.5, 0.5};

/// Returns the mean shear stress of the body at the end of a step, kPa, from the elastic and viscous forces.
double shear_stress_kpa(const CheckContext& context, const TissueModel& model, TissueState& state) {
  Points forces(state.positions.size(), Vec3::Zero());
  add_elastic_response(model, state, forces, nullptr, context.workers);
  add_viscous_response(model, state, kStep, forces, nullptr, context.workers);
  double sum = 0.0;
  for (std::size_t v = 0; v < forces.size(); ++v) sum -= forces[v][0] * model.mesh.vertices[v][1];
  return sum / volume_mm3(model.mesh);
}

}  // namespace

VerificationCheck relaxation_of_one_prony_term(const CheckContext& context) {
  const Material material{.prony = {kTerm}};
  VerificationCheck check = described(
      "Shear held constant, one Prony term: largest difference of the stress from its relaxation curve over four "
      "relaxation times",
      "linear viscoelasticity: μ γ (1 + g e^{−t/τ}), g = 1.5, τ = 0.5 s", "of μ γ", 0.0, kRelaxationTolerance);
  const TissueModel model = make_tissue_model(irregular_block(Vec3(20, 20, 20), {3, 3, 3}, 0.2, 9), material,
                                              {FixedConstraint{plane_across(1, 0.0)}});
  TissueState state = rest_state(model);
  for (Vec3& p : state.positions) p[0] += kShear * p[1];

  const double scale = lame_parameters(material.youngs_modulus_kpa, material.poissons_ratio).mu_kpa * kShear;
  const auto closed_form = [](double t) { return 1.0 + kTerm.shear_share * std::exp(-t / kTerm.time_s); };
  LineSeries marks{"computed", {}, {}, false};
  for (int step = 0; step < kSteps; ++step) {
    // The step rule places a change of strain within a step at the middle of the step.
    marks.add((step + 0.5) * kStep, shear_stress_kpa(context, model, state) / scale);
    end_viscous_step(model, state, kStep, context.workers);
    check.found = std::max(check.found, std::abs(marks.y.back() - closed_form(marks.x.back())));
  }
  LineSeries line{"closed form", {}, {}, true};
  for (int i = 0; i <= 100; ++i) {
    const double time_s = kStep * kSteps * i / 100.0;
    line.add(time_s, closed_form(time_s));
  }
  check.note = fmt::format("{} steps of {} s", kSteps, kStep);
  check.plot = {"Relaxation with one Prony term", "time, s", "shear stress / (μ γ)", false, false, {line, marks}};
  return check;
}

}  // namespace incise
