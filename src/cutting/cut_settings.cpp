#include <incise/core/expect.hpp>
#include <incise/cutting/cut_settings.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace {

constexpr double kMaxContactS = 600.0;      // until tissue is cut: beyond it no cut ends in any time worth waiting for
constexpr double kLeastAdvanceMm = 1e-4;    // a step: below it a cut takes a million steps
constexpr double kLeastResidualTolerance = 1e-6;  // a hundredth of what a converged cut is solved to
constexpr double kMostResidualTolerance = 0.3;    // beyond it a step leaves more than the next takes up: another cut

}  // namespace

double CutSettings::dwell_rate_per_s() const { return std::pow(power_w / reference_power_w, power_exponent) / dwell_s(); }

std::vector<Problem> validate(const CutSettings& s, double tool_diameter_mm) {
  std::vector<Problem> violations;
  const Expect expect(violations);
  expect(s.speed_mm_s > 0.0, "speed_mm_s", s.speed_mm_s, "a speed above 0 mm/s");
  expect(s.dullness > 0.0, "dullness", s.dullness, "a number of reference steps above 0");
  expect(s.reference_step_s > 0.0, "reference_step_s", s.reference_step_s, "a time above 0 s");
  expect(s.power_w > 0.0, "power_w", s.power_w, "a power above 0 W");
  expect(s.reference_power_w > 0.0, "reference_power_w", s.reference_power_w, "a power above 0 W");
  expect(s.power_exponent >= 0.0 && s.power_exponent <= 10.0, "power_exponent", s.power_exponent,
         "a number in [0, 10]");
  if (s.dullness > 0.0 && s.reference_step_s > 0.0 && s.power_w > 0.0 && s.reference_power_w > 0.0) {
    const double contact_s = 1.0 / s.dwell_rate_per_s();
    if (!(contact_s <= kMaxContactS)) {
      violations.push_back({"power_w",
                            fmt::format("{} with power_exponent {}, dullness {} and reference_step_s {}: {:.3g} s of "
                                        "contact until tissue is cut",
                                        s.power_w, s.power_exponent, s.dullness, s.reference_step_s, contact_s),
                            fmt::format("at most {} s", kMaxContactS)});
    }
  }
  if (s.tear_energy_kpa)
    expect(*s.tear_energy_kpa > 0.0, "tear_energy_kpa", *s.tear_energy_kpa, "an energy above 0 kPa");
  if (s.slip_mm) expect(*s.slip_mm > 0.0, "slip_mm", *s.slip_mm, "a distance above 0 mm");
  expect(s.advance_per_step_mm >= kLeastAdvanceMm && s.advance_per_step_mm <= tool_diameter_mm, "advance_per_step_mm",
         s.advance_per_step_mm, "a step of 0.0001 mm or more and at most the tool's diameter or thickness");
  expect(s.reach_mm >= 0.0, "reach_mm", s.reach_mm, "0 mm or more");
  expect(s.bond_stiffness_kpa_mm2 >= 0.0, "bond_stiffness_kpa_mm2", s.bond_stiffness_kpa_mm2, "0 kPa/mm² or more");
  expect(s.overlap_mm >= 0.0, "overlap_mm", s.overlap_mm, "0 mm or more");
  expect(s.residual_tolerance >= kLeastResidualTolerance && s.residual_tolerance <= kMostResidualTolerance,
         "residual_tolerance", s.residual_tolerance, "a fraction in [1e-06, 0.3]");
  expect(s.max_step_mm > 0.0, "max_step_mm", s.max_step_mm, "a distance above 0 mm");
  return violations;
}

}  // namespace incise
