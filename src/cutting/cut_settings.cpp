#include <incise/cutting/cut_settings.hpp>
#include <incise/cutting/tool.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace {

void expect(bool is_valid, std::vector<std::string>& violations, const char* field, double found, const char* expected) {
  if (!is_valid || !std::isfinite(found)) {
    violations.push_back(fmt::format("{}: found {}, expected {}", field, found, expected));
  }
}

}  // namespace

std::vector<std::string> validate(const CutSettings& s, double needle_diameter_mm) {
  std::vector<std::string> violations;
  expect(s.speed_mm_s > 0.0, violations, "speed_mm_s", s.speed_mm_s, "a speed above 0 mm/s");
  expect(s.dullness > 0.0, violations, "dullness", s.dullness, "a number of reference steps above 0");
  expect(s.reference_step_s > 0.0, violations, "reference_step_s", s.reference_step_s, "a time above 0 s");
  expect(s.advance_per_step_mm > 0.0 && s.advance_per_step_mm <= needle_diameter_mm, violations, "advance_per_step_mm",
         s.advance_per_step_mm, "a step above 0 mm and at most the needle's diameter");
  expect(s.reach_mm >= 0.0, violations, "reach_mm", s.reach_mm, "0 mm or more");
  expect(s.bond_stiffness_kpa_mm2 >= 0.0, violations, "bond_stiffness_kpa_mm2", s.bond_stiffness_kpa_mm2, "0 kPa/mm² or more");
  expect(s.overlap_mm >= 0.0, violations, "overlap_mm", s.overlap_mm, "0 mm or more");
  expect(s.residual_tolerance > 0.0 && s.residual_tolerance < 1.0, violations, "residual_tolerance", s.residual_tolerance,
         "a fraction between 0 and 1");
  expect(s.max_step_mm > 0.0, violations, "max_step_mm", s.max_step_mm, "a distance above 0 mm");
  return violations;
}

std::vector<std::string> validate(const Needle& needle) {
  std::vector<std::string> violations;
  expect(needle.diameter_mm > 0.0, violations, "diameter_mm", needle.diameter_mm, "a diameter above 0 mm");
  expect(needle.length_mm > 0.0, violations, "length_mm", needle.length_mm, "a length above 0 mm");
  return violations;
}

}  // namespace incise
