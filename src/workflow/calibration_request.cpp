#include <incise/workflow/calibrate.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

void expect_positive(std::vector<std::string>& violations, const char* field, const std::vector<double>& values) {
  for (const double value : values) {
    if (value > 0.0 && std::isfinite(value)) continue;
    violations.push_back(fmt::format("{}: found {}, expected numbers above 0", field, value));
  }
}

}  // namespace

std::vector<std::string> validate(const CalibrationRequest& r) {
  std::vector<std::string> violations = validate(r.fit);
  expect_positive(violations, "speeds_mm_s", r.speeds_mm_s);
  expect_positive(violations, "dullnesses", r.dullnesses);
  expect_positive(violations, "drag_lengths_mm", r.drag_lengths_mm);
  for (const double drag : r.second_drag_lengths_mm) {
    if (std::find(r.drag_lengths_mm.begin(), r.drag_lengths_mm.end(), drag) != r.drag_lengths_mm.end()) continue;
    violations.push_back(fmt::format("second_drag_lengths_mm: found {}, expected some of drag_lengths_mm", drag));
  }
  expect_positive(violations, "second_stiffness", {r.second_stiffness, std::abs(r.second_stiffness - 1.0)});
  expect_positive(violations, "fit_speed_mm_s", {r.fit_speed_mm_s});
  expect_positive(violations, "force_sd", {r.force_sd});
  expect_positive(violations, "stiffness_sd_with_force", {r.stiffness_sd_with_force});
  if (r.speeds_mm_s.empty() || r.dullnesses.empty())
    violations.push_back("speeds_mm_s: found none, expected at least one speed and one dullness");
  if (r.drag_lengths_mm.size() < 2)
    violations.push_back(fmt::format("drag_lengths_mm: found {}, expected at least 2", r.drag_lengths_mm.size()));
  return violations;
}

}  // namespace incise
