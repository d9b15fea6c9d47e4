#include "random_programs.hpp"

#include <incise/core/units.hpp>

#include <cmath>

namespace incise::testing {
namespace {

Vec3 direction_within(Random& random, const Vec3& middle, double most_rad) {
  const Vec3 side =
      Eigen::AngleAxisd(random.uniform(0.0, 2.0 * units::kPi), middle).toRotationMatrix() * middle.unitOrthogonal();
  const double angle = random.uniform(0.0, most_rad);
  return std::cos(angle) * middle + std::sin(angle) * side;
}

/// A short open cut: near the base as often as in front of it.
ToolPath random_path(Random& random) {
  const double reach_mm = random.below(2) == 0 ? random.uniform(0.0, 400.0) : random.uniform(300.0, 1100.0);
  const double turn = random.uniform(-units::kPi, units::kPi);
  const Vec3 middle(reach_mm * std::cos(turn), reach_mm * std::sin(turn), random.uniform(20.0, 800.0));
  const Vec3 axis = direction_within(random, -Vec3::UnitZ(), 1.4);
  const Vec3 along =
      Eigen::AngleAxisd(random.uniform(0.0, 2.0 * units::kPi), axis).toRotationMatrix() * axis.unitOrthogonal();
  ToolPath path{.frame = PathFrame::Robot, .is_closed = false};
  for (int i = 0; i < 4; ++i)
    path.waypoints.push_back({middle + (3.0 + random.uniform()) * i * along, axis, 5.0, 20.0});
  return path;
}

ArmSetup random_setup(Random& random) {
  ArmSetup setup;
  setup.T_flange_tool(2, 3) = random.uniform(60.0, 260.0);
  if (random.below(3) == 0) {  // a bent tool
    setup.T_flange_tool(0, 3) = random.uniform(-120.0, 120.0);
    setup.T_flange_tool.topLeftCorner<3, 3>() =
        Eigen::AngleAxisd(random.uniform(-1.5, 1.5), Vec3::UnitY()).toRotationMatrix();
  }
  if (random.below(3) == 0) setup.table_z_mm = random.uniform(-600.0, 0.0);
  return setup;
}

/// A rectangle of triangles about a place, with bumps.
void add_patch(TriMesh& mesh, Random& random, const Vec3& middle, const Vec3& normal, double half_mm, double bump_mm) {
  constexpr int kSteps = 7;
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j)
      mesh.vertices.push_back(middle + half_mm * (2.0 * i / kSteps - 1.0) * u + half_mm * (2.0 * j / kSteps - 1.0) * v +
                              random.uniform(-bump_mm, bump_mm) * normal);
  }
  const auto id = [first](int i, int j) { return VertexId(first + static_cast<std::uint32_t>((kSteps + 1) * i + j)); };
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      mesh.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      mesh.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  }
}

/// The tissue below the cut, and a wall somewhere beside the instrument or the arm.
TriMesh random_surface(Random& random, const ToolPath& path) {
  TriMesh mesh;
  const Waypoint& first = path.waypoints.front();
  add_patch(mesh, random, first.position_mm, direction_within(random, -first.axis, 0.3), random.uniform(20.0, 90.0),
            0.5);
  const Vec3 aside = direction_within(random, first.axis.unitOrthogonal(), 1.5);
  const Vec3 wall = first.position_mm - random.uniform(20.0, 400.0) * first.axis + random.uniform(10.0, 250.0) * aside;
  add_patch(mesh, random, wall, direction_within(random, aside, 0.8), random.uniform(10.0, 120.0), 4.0);
  return mesh;
}

}  // namespace

std::optional<RandomProgram> random_program(Random& random) {
  const ToolPath path = random_path(random);
  const ArmSetup setup = random_setup(random);
  const TriMesh surface = random_surface(random, path);
  const double spin_deg = random.uniform(0.0, 360.0);
  RobotProgram program = make_program(path, {.spin_deg = spin_deg}, setup);
  if (program.motion.outcome != MotionOutcome::Found) return std::nullopt;
  return RandomProgram{path, std::move(program), surface};
}

}  // namespace incise::testing
