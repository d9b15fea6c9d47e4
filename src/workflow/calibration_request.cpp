#include <incise/core/expect.hpp>
#include <incise/workflow/calibrate.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise {
std::vector<Problem> validate(const CalibrationRequest& r) {
  std::vector<Problem> violations = problems_of(r);
  const Expect expect(violations);
  for (const double drag : r.second_drag_lengths_mm) {
    const bool is_among =
        std::find(r.drag_lengths_mm.begin(), r.drag_lengths_mm.end(), drag) != r.drag_lengths_mm.end();
    expect(is_among, "second_drag_lengths_mm", drag, "one of drag_lengths_mm");
  }
  expect(r.second_stiffness != 1.0, "second_stiffness", r.second_stiffness, "a number other than 1");
  if (r.speeds_mm_s.empty() || r.dullnesses.empty())
    violations.push_back({"speeds_mm_s", "none", "at least one speed and one dullness"});
  if (r.drag_lengths_mm.size() < 2)
    violations.push_back({"drag_lengths_mm", fmt::format("{} values", r.drag_lengths_mm.size()), "at least 2"});
  return violations;
}

}  // namespace incise
