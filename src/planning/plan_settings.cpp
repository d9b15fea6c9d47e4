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
  std::vector<Problem> violations;
  const Expect expect(violations);
  expect(s.lateral_margin_mm > 0.0, "lateral_margin_mm", s.lateral_margin_mm, "a distance above 0 mm");
  expect(s.depth_mm > 0.0, "depth_mm", s.depth_mm, "a depth above 0 mm");
  expect(s.speed_mm_s > 0.0, "speed_mm_s", s.speed_mm_s, "a speed above 0 mm/s");
  expect(s.power_w > 0.0, "power_w", s.power_w, "a power above 0 W");
  expect(s.rim_clearance_mm >= 0.0, "rim_clearance_mm", s.rim_clearance_mm, "0 mm or more");
  const int least = s.kind == PlanKind::Ring ? 8 : 2;
  if (s.waypoints < least) {
    violations.push_back(
        {"waypoints", std::to_string(s.waypoints), fmt::format("at least {} for a {}", least, to_string(s.kind))});
  }
  const auto expect_direction = [&](const char* field, const Vec3& v) {
    if (is_direction(v)) return;
    violations.push_back({field, fmt::format("({}, {}, {})", v.x(), v.y(), v.z()), "a finite vector that is not zero"});
  };
  expect_direction("approach", s.approach);
  expect_direction("start_direction", s.start_direction);
  if (is_direction(s.approach) && is_direction(s.start_direction) &&
      s.approach.normalized().cross(s.start_direction.normalized()).norm() < 1e-3) {
    violations.push_back({"start_direction", "the approach's own direction", "one across it"});
  }
  return violations;
}

}  // namespace incise
