// A bar, clamped at one end, vibrates along its axis in its first mode: its length is a quarter of the wave.
#include "verification/bodies.hpp"
#include "verification/check.hpp"

#include <incise/core/units.hpp>
#include <incise/mechanics/motion.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace {

const Vec3 kRodSize(100, 5, 5);             // mm
constexpr double kAmplitude = 0.1;          // mm
constexpr int kStepsPerPeriod = 200;        // implicit Euler then lengthens the period by (2π/200)²/3 = 0.03 %
constexpr double kPeriodTolerance = 0.005;  // of the period

TissueModel bar() {
  const Material material{.poissons_ratio = 0.0};
  return make_tissue_model(make_block(kRodSize, {40, 2, 2}), material, {FixedConstraint{plane_across(0, 0.0)}});
}

double period_s() {
  const Material material;
  const double wave_speed =
      std::sqrt(material.youngs_modulus_kpa / units::kg_mm3_from_kg_m3(material.density_kg_m3));  // mm/s
  return 4.0 * kRodSize[0] / wave_speed;
}

/// Returns the tip displacement over one period, after release without velocity in the shape of the mode.
LineSeries swing(const CheckContext& context, const TissueModel& model) {
  MotionSettings settings;
  settings.step_s = period_s() / kStepsPerPeriod;
  settings.max_newton_iterations = 5;
  settings.relative_tolerance = 1e-8;
  TissueState state = rest_state(model);
  for (Vec3& p : state.positions) p[0] += kAmplitude * std::sin(0.5 * units::kPi * p[0] / kRodSize[0]);
  Motion motion = motion_at_rest(model, state);
  MotionWorkspace workspace(model, settings);
  const Region tip = plane_across(0, kRodSize[0]);
  LineSeries curve{"computed", {0.0}, {mean_displacement(model, motion.tissue, tip)[0]}, false};
  for (int step = 1; step <= kStepsPerPeriod; ++step) {
    throw_if_cancelled(context.monitor, "verifying");
    const StepReport report = advance_motion(model, motion, settings, workspace, context.workers);
    if (report.outcome != Outcome::Success)
      throw NotSolved(fmt::format("step {}: {}", step, to_string(report.outcome)));
    curve.add(motion.time_s, mean_displacement(model, motion.tissue, tip)[0]);
  }
  return curve;
}

/// Returns the times at which the curve crosses zero, by linear interpolation.
std::vector<double> crossings(const LineSeries& curve) {
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
                kPeriodTolerance * period_s());
  const LineSeries curve = swing(context, bar());
  const std::vector<double> times = crossings(curve);
  if (times.size() < 2) throw NotSolved("the bar does not swing twice through its position at rest");
  check.found = 2.0 * (times[1] - times[0]);
  check.note = fmt::format("{} steps per period; amplitude after one period {:.3f} of the first (implicit Euler damps)",
                           kStepsPerPeriod, curve.y.back() / kAmplitude);
  LineSeries line{"undamped closed form", {}, {}, true};
  for (int i = 0; i <= 100; ++i) {
    line.add(period_s() * i / 100.0, kAmplitude * std::cos(2.0 * units::kPi * i / 100.0));
  }
  LineSeries marks{"computed", {}, {}, false};
  for (std::size_t i = 0; i < curve.x.size(); i += 4) marks.add(curve.x[i], curve.y[i]);
  check.plot = {"Free vibration of a bar", "time, s", "tip displacement, mm", false, false, {line, marks}};
  return check;
}

}  // namespace incise
