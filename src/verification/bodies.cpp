#include "verification/bodies.hpp"

#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/core/units.hpp>

#include <algorithm>
#include <cmath>

namespace incise {

namespace {
constexpr double kPlaneHalfWidth = 1e-6;  // mm
constexpr double kFar = 1e4;              // mm
}  // namespace

Region plane_across(int axis, double at_mm) {
  Box3 box(Vec3::Constant(-kFar), Vec3::Constant(kFar));
  box.min()[axis] = at_mm - kPlaneHalfWidth;
  box.max()[axis] = at_mm + kPlaneHalfWidth;
  return BoxRegion{box};
}

Constraint symmetry_across(int axis, double at_mm) {
  FixedConstraint held{plane_across(axis, at_mm), {false, false, false}};
  held.axes[static_cast<std::size_t>(axis)] = true;
  return held;
}

TetMesh irregular_block(const Vec3& size_mm, std::array<int, 3> cells, double share, std::uint64_t seed) {
  TetMesh mesh = make_block(size_mm, cells);
  Random random(seed);
  const double edge = std::min({size_mm[0] / cells[0], size_mm[1] / cells[1], size_mm[2] / cells[2]});
  for (Vec3& p : mesh.vertices) {
    const bool is_inner = (p.array() > 1e-9).all() && ((size_mm - p).array() > 1e-9).all();
    const double x = random.uniform(-1.0, 1.0);
    const double y = random.uniform(-1.0, 1.0);
    const double z = random.uniform(-1.0, 1.0);
    if (is_inner) p += share * edge * Vec3(x, y, z);
  }
  return mesh;
}

void prescribe_boundary(TissueModel& model, const Mat3& f) {
  for (const BoundaryFace& face : boundary_faces(model.mesh)) {
    for (const VertexId v : face.corners) {
      model.is_fixed[v.index()] = {true, true, true};
      model.prescribed_displacement_mm[v.index()] = f * vertex(model.mesh.vertices, v) - vertex(model.mesh.vertices, v);
    }
  }
}

TetMesh eighth_of_a_sphere(double inner_radius_mm, int n) {
  const TetMesh block = make_block(Vec3::Constant(2.0 * n), {2 * n, 2 * n, 2 * n});
  const auto largest = [&](VertexId v) { return vertex(block.vertices, v).maxCoeff(); };
  TetMesh mesh;
  std::vector<std::int32_t> renamed(block.vertices.size(), -1);
  for (const Tet& tet : block.tets) {
    Vec3 center = Vec3::Zero();
    for (const VertexId v : tet) center += 0.25 * vertex(block.vertices, v);
    if (center.maxCoeff() < n) continue;
    Tet kept;
    for (std::size_t c = 0; c < 4; ++c) {
      std::int32_t& name = renamed[tet[c].index()];
      if (name < 0) {
        name = static_cast<std::int32_t>(mesh.vertices.size());
        const Vec3& p = vertex(block.vertices, tet[c]);
        // Equal steps of angle give more even cells than equal steps of the tangent.
        const double layer = largest(tet[c]);
        const Vec3 direction = (p / layer * (0.25 * units::kPi)).array().tan().matrix().normalized();
        mesh.vertices.push_back(inner_radius_mm * layer / n * direction);
      }
      kept[c] = VertexId{static_cast<std::size_t>(name)};
    }
    mesh.tets.push_back(kept);
  }
  return mesh;
}

void add_pressure_outwards(TissueModel& model, double at_mm, double pressure_kpa) {
  for (const BoundaryFace& face : boundary_faces(model.mesh)) {
    const std::array<Vec3, 3> p = corners_of(model.mesh.vertices, face.corners);
    const bool is_there =
        std::all_of(p.begin(), p.end(), [&](const Vec3& x) { return std::abs(x.norm() - at_mm) < kPlaneHalfWidth; });
    if (!is_there) continue;
    // The face's normal points out of the tissue into the cavity; pressure acts against it.
    const Vec3 area = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]);
    for (const VertexId v : face.corners) model.dead_load_mn[v.index()] -= pressure_kpa / 3.0 * area;
  }
}

TetMesh cooks_panel(int n) {
  constexpr double kThickness = 1.0;  // mm; does not matter in plane strain
  TetMesh mesh = make_block(Vec3(1.0, 1.0, kThickness), {n, n, 1});
  for (Vec3& p : mesh.vertices) {
    const double x = p[0];
    const double y = p[1];
    p = Vec3(48.0 * x, 44.0 * x * (1.0 - y) + (44.0 + 16.0 * x) * y, p[2]);
  }
  return mesh;
}

Vec3 mean_displacement(const TissueModel& model, const TissueState& state, const Region& where) {
  Vec3 sum = Vec3::Zero();
  const std::vector<VertexId> chosen = select(model.mesh, where);
  INCISE_REQUIRE(!chosen.empty(), "expected a region with vertices in it");
  for (const VertexId v : chosen) sum += state.positions[v.index()] - model.mesh.vertices[v.index()];
  return sum / static_cast<double>(chosen.size());
}

}  // namespace incise
