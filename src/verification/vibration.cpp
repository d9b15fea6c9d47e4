// A bar, clamped at one end, swings along its axis in its first mode: a quarter of a wave fits into it.
#include "verification/bodies.hpp"
#include "verification/check.hpp"

#include <incise/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

const Vec3 kSize(100, 5, 5);               // mm
constexpr double kAmplitude = 0.1;         // mm
constexpr int kStepsPerPeriod = 1600;      // explicit steps: no longer than sound takes through a cell
constexpr double kShareTolerance = 0.005;  // of the period

TissueModel bar() {
  Material material;
  material.poissons_ratio = 0.0;
  return make_tissue_model(make_block(kSize, {40, 2, 2}), material, {FixedConstraint{plane_across(0, 0.0)}});
}

double period_s() {
  const Material material;
  const double wave_speed =
      std::sqrt(material.youngs_modulus_kpa / units::kg_mm3_from_kg_m3(material.density_kg_m3));  // mm/s
  return 4.0 * kSize[0] / wave_speed;
}

/// Tip displacement over time, from the mode's shape at rest: leapfrog steps with the library's forces and lumped
/// masses. It neither damps nor, at this step, changes the period by more than a millionth: what is judged is forces
/// and mass.
CheckCurve swing(const CheckContext& context, const TissueModel& model) {
  const double step = period_s() / kStepsPerPeriod;
  TissueState state = rest_state(model);
  for (Vec3& p : state.positions) p[0] += kAmplitude * std::sin(0.5 * units::kPi * p[0] / kSize[0]);
  Points velocities(state.positions.size(), Vec3::Zero());
  Points forces(state.positions.size());
  const Region tip = plane_across(0, kSize[0]);
  CheckCurve curve{"computed", {0.0}, {mean_displacement(model, state, tip)[0]}, false};
  for (int i = 1; i <= kStepsPerPeriod; ++i) {
    std::fill(forces.begin(), forces.end(), Vec3::Zero());
    add_elastic_response(model, state, forces, nullptr, context.workers);
    const double kick = i == 1 ? 0.5 * step : step;  // velocities live half a step behind
    for (std::size_t v = 0; v < forces.size(); ++v) {
      if (model.is_fixed[v][0]) continue;
      velocities[v] += kick / model.vertex_mass_kg[v] * forces[v];
      state.positions[v] += step * velocities[v];
    }
    curve.x.push_back(i * step);
    curve.y.push_back(mean_displacement(model, state, tip)[0]);
  }
  return curve;
}

/// Times at which the curve crosses zero, by linear interpolation.
std::vector<double> crossings(const CheckCurve& curve) {
  std::vector<double> times;
  for (std::size_t i = 1; i < curve.x.size(); ++i) {
    const double a = curve.y[i - 1];
    const double b = curve.y[i];
    if (a * b < 0.0) times.push_back(curve.x[i - 1] + (curve.x[i] - curve.x[i - 1]) * a / (a - b));
  }
  return times;
}

}  // namespace

VerificationCheck vibration_period(const CheckContext& context) {
  VerificationCheck check =
      described("Bar swinging along its axis, clamped at one end, ν = 0: period of the first mode",
                "4 L √(ρ/E): a quarter wave in a uniform bar (Rayleigh, Theory of Sound, § 150)", "s", period_s(),
                kShareTolerance * period_s());
  const TissueModel model = bar();
  const CheckCurve curve = swing(context, model);
  const std::vector<double> times = crossings(curve);
  if (times.size() < 2) throw NotSolved("the bar does not swing through its place of rest twice");
  check.found = 2.0 * (times[1] - times[0]);
  check.note = fmt::format("{} tets, 40 along the bar; after one period the tip is at {:.4f} of its amplitude",
                           model.mesh.tets.size(), curve.y.back() / kAmplitude);
  CheckCurve line{"undamped closed form", {}, {}, true};
  for (int i = 0; i <= 100; ++i) {
    line.x.push_back(period_s() * i / 100.0);
    line.y.push_back(kAmplitude * std::cos(2.0 * units::kPi * i / 100.0));
  }
  CheckCurve marks{"computed", {}, {}, false};
  for (std::size_t i = 0; i < curve.x.size(); i += 32) {
    marks.x.push_back(curve.x[i]);
    marks.y.push_back(curve.y[i]);
  }
  check.plot = {"Free vibration of a bar", "time, s", "tip displacement, mm", false, false, {line, marks}};
  return check;
}

}  // namespace incise
