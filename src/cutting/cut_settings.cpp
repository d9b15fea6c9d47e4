#include <incise/core/expect.hpp>
#include <incise/cutting/cut_settings.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace {

constexpr double kMaxContactS = 600.0;  // until tissue is cut: beyond it no cut ends in a reasonable time

}  // namespace

double CutSettings::relative_energy() const {
  const double area_rate = real_speed_mm_s.value_or(reference_real_speed_mm_s) * depth_mm.value_or(reference_depth_mm);
  return power_w / reference_power_w * (reference_real_speed_mm_s * reference_depth_mm / area_rate);
}

double CutSettings::dwell_rate_per_s() const {
  return std::pow(relative_energy(), power_exponent) / dwell_s();
}

std::vector<Problem> validate(const CutSettings& s, double tool_diameter_mm) {
  std::vector<Problem> violations = problems_of(s);
  if (s.dullness > 0.0 && s.reference_step_s > 0.0 && s.relative_energy() > 0.0) {
    const double contact_s = 1.0 / s.dwell_rate_per_s();
    if (!(contact_s <= kMaxContactS)) {
      violations.push_back({"power_w",
                            fmt::format("{} at {} mm/s and a depth of {} mm with power_exponent {}, dullness {} and "
                                        "reference_step_s {}: {:.3g} s of contact until tissue is cut",
                                        s.power_w, s.real_speed_mm_s.value_or(s.reference_real_speed_mm_s),
                                        s.depth_mm.value_or(s.reference_depth_mm), s.power_exponent, s.dullness,
                                        s.reference_step_s, contact_s),
                            fmt::format("at most {} s", kMaxContactS)});
    }
  }
  if (s.rule != CutRule::Tets && s.tear_energy_kpa) {
    violations.push_back({"tear_energy_kpa", fmt::format("{}", *s.tear_energy_kpa),
                          fmt::format("none with rule {}", to_string(s.rule))});
  }
  if (s.rule == CutRule::Paper && !(s.advance_mm() <= tool_diameter_mm)) {
    violations.push_back(
        {"reference_step_s",
         fmt::format("{} at {} mm/s: {:.3g} mm a step", s.reference_step_s, s.speed_mm_s, s.advance_mm()),
         "at most the tool's diameter or thickness"});
  }
  Expect{violations}(s.advance_per_step_mm <= tool_diameter_mm, "advance_per_step_mm", s.advance_per_step_mm,
                     "at most the tool's diameter or thickness");
  return violations;
}

}  // namespace incise
