#include <incise/core/expect.hpp>
#include <incise/planning/plan_path.hpp>

#include <fmt/format.h>

namespace incise {
namespace {

bool is_direction(const Vec3& v) {
  return v.allFinite() && v.norm() > 0.0;
}

}  // namespace

std::vector<Problem> validate(const PlanSettings& s) {
  std::vector<Problem> violations = problems_of(s);
  const int least = s.kind == PlanKind::Ring ? 8 : 2;
  Expect{violations}(s.waypoints >= least, "waypoints", s.waypoints,
                     fmt::format("at least {} for a {}", least, to_string(s.kind)));
  if (is_direction(s.approach) && is_direction(s.start_direction) &&
      s.approach.normalized().cross(s.start_direction.normalized()).norm() < 1e-3) {
    violations.push_back({"start_direction", "the direction of the approach", "a direction across the approach"});
  }
  return violations;
}

}  // namespace incise
