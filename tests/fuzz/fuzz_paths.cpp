#include "fuzz/fuzz_paths.hpp"

#include <incise/core/random.hpp>
#include <incise/core/units.hpp>

#include <array>
#include <cmath>

namespace incise::testing {
namespace {

using units::kPi;

const Vec3 kTop(15.0, 10.0, 10.0);  // middle of the block's upper face

void add(ToolPath& path, const Vec3& position, double depth, const Vec3& axis = -Vec3::UnitZ()) {
  Waypoint waypoint{.position_mm = position, .axis = axis.normalized(), .depth_mm = depth};
  path.waypoints.push_back(waypoint);
}

void add_ring(ToolPath& path, Random& random, double depth) {
  const double radius = random.uniform(2.0, 7.0);
  for (int i = 0; i < 16; ++i) {
    const double angle = 2.0 * kPi * i / 16.0;
    add(path, kTop + radius * Vec3(std::cos(angle), std::sin(angle), 0.0), depth);
  }
}

void add_eight(ToolPath& path, Random& random, double depth) {
  const double size = random.uniform(3.0, 8.0);
  for (int i = 0; i < 24; ++i) {
    const double angle = 2.0 * kPi * i / 24.0;
    add(path, kTop + size * Vec3(std::sin(angle), 0.8 * std::sin(2.0 * angle), 0.0), depth);
  }
}

void add_line(ToolPath& path, const Vec3& from, const Vec3& to, double depth) {
  for (int i = 0; i <= 10; ++i) add(path, from + 0.1 * i * (to - from), depth);
}

void add_walk(ToolPath& path, Random& random, double depth) {
  Vec3 at = kTop;
  for (int i = 0; i < 12; ++i) {
    add(path, at, std::max(0.1, depth + random.uniform(-2.0, 2.0)));
    at += Vec3(random.uniform(-4.0, 4.0), random.uniform(-4.0, 4.0), 0.0);
  }
}

/// A ring whose axis turns from waypoint to waypoint.
void add_leaning_ring(ToolPath& path, Random& random, double depth) {
  for (int i = 0; i < 12; ++i) {
    const double angle = 2.0 * kPi * i / 12.0;
    add(path, kTop + 5.0 * Vec3(std::cos(angle), std::sin(angle), 0.0), depth,
        Vec3(random.uniform(-0.8, 0.8), random.uniform(-0.8, 0.8), -1.0));
  }
}

/// Waypoints on top of each other and a hair apart.
void add_doubled(ToolPath& path, Random& random, double depth) {
  for (int i = 0; i < 6; ++i) {
    const Vec3 at = kTop + Vec3(2.0 * i - 6.0, random.uniform(-1.0, 1.0), 0.0);
    for (const double off : {0.0, 0.0, 1e-9, 1e-4}) add(path, at + off * Vec3::UnitX(), depth);
  }
}

}  // namespace

FuzzCut random_cut(std::uint64_t seed) {
  Random random(seed);
  FuzzCut cut;
  const double depth = random.uniform(0.5, 6.0);
  cut.path.is_closed = random.below(2) == 0;
  switch (random.below(8)) {
    case 0: cut.kind = "ring"; add_ring(cut.path, random, depth); break;
    case 1: cut.kind = "crossing"; add_eight(cut.path, random, depth); break;
    case 2: cut.kind = "leaving"; add_line(cut.path, kTop, kTop + Vec3(random.uniform(-5, 5), random.uniform(15, 25), 0), depth); break;
    case 3: cut.kind = "wandering"; add_walk(cut.path, random, depth); break;
    case 4: cut.kind = "along the clamp"; add_line(cut.path, {0.5, 2, 10}, {0.5, 18, 10}, depth); break;
    case 5: cut.kind = "through the platform"; add_ring(cut.path, random, random.uniform(9.0, 16.0)); break;
    case 6: cut.kind = "leaning"; add_leaning_ring(cut.path, random, depth); break;
    default: cut.kind = "doubled"; add_doubled(cut.path, random, depth); break;
  }
  for (int i = 0; i < 24 && cut.path.is_closed; ++i) {
    const double angle = 2.0 * kPi * i / 24.0;
    cut.path.tumor_edge.points.push_back(kTop + 1.5 * Vec3(std::cos(angle), std::sin(angle), 0.0));
  }
  CutSettings& c = cut.settings.cut;
  const auto one_of = [&random](const auto& values) { return values[random.below(values.size())]; };
  const double width = random.uniform(0.8, 3.0);
  const double length = random.uniform(3.0, 25.0);
  cut.settings.tool = one_of(std::array<Tool, 3>{Needle{width, length}, Blade{0.5 * width, 2.0 * width, length}, Ball{width}});
  c.speed_mm_s = one_of(std::array{0.5, 7.0, 13.0, 60.0, 100.0});
  c.dullness = one_of(std::array{0.01, 1.0, 9.0, 17.0, 200.0});
  c.advance_per_step_mm = 2.0 * radius_mm(cut.settings.tool) * random.uniform(0.4, 1.0);
  c.reach_mm = random.uniform(0.0, 1.0);
  c.bond_stiffness_kpa_mm2 = one_of(std::array{0.0, 100.0, 400.0, 3000.0});
  c.overlap_mm = random.uniform(0.0, 10.0);
  if (random.below(3) == 0) c.slip_mm = random.uniform(0.05, 2.0);
  if (random.below(3) == 0) c.tear_energy_kpa = random.uniform(0.5, 100.0);
  if (random.below(3) == 0) {
    cut.kind += ", by points";
    c.rule = CutRule::Lattice;
    c.tear_energy_kpa.reset();
    c.kernel_radius_mm = random.uniform(0.5, 3.0);
    c.dose_length_mm = random.uniform(0.5, 5.0);
    c.hold_per_mm2 = one_of(std::array{0.0, 4.0, 25.0, 1000.0});
  } else if (random.below(3) == 0) {
    cut.kind += ", by the paper's rule";
    c.rule = CutRule::Paper;
    c.contact_count = one_of(std::array{ContactCount::Keep, ContactCount::Reset});
    c.tear_energy_kpa.reset();
    c.reference_step_s = std::min(c.reference_step_s, 2.0 * radius_mm(cut.settings.tool) / c.speed_mm_s);
  }
  return cut;
}

}  // namespace incise::testing
