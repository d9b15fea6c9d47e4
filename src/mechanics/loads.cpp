#include "mechanics/loads.hpp"

#include "mechanics/holder_contact.hpp"
#include "mechanics/support.hpp"
#include "mechanics/vector_text.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr const char* kWhere = "case";
/// Largest displacement of vertices, in diagonals of the body's box. No tissue stretches a hundredfold, and beyond that
/// the rounding of positions hides the strain.
constexpr double kMostDiagonals = 100.0;
/// Largest depth of a vertex inside a holder at rest: mesh and scan of the same contact differ. From deeper inside, the
/// nearest way out may lead through the wrong side.
constexpr double kDeepestStartMm = 2.0;
/// Eigenvalue, as a share of the largest, above which a rigid motion counts as stopped.
constexpr double kLeastStoppedShare = 1e-10;
constexpr const char* kAxisNames = "xyz";

CaseError nothing_selected(const TetMesh& mesh, const std::string& field, const char* what) {
  const Box3 box = bounding_box(mesh.vertices);
  return CaseError(kWhere, field, fmt::format("a region without any {} of the mesh", what),
                   fmt::format("one with at least one {}", what),
                   fmt::format("The mesh fills the box {} to {} mm", text_of(box.min()), text_of(box.max())));
}

class ConstraintApplier {
 public:
  ConstraintApplier(TissueModel& model, std::vector<BoundaryFace> skin) : model_(model), skin_(std::move(skin)) {}

  void apply(std::size_t index) {
    index_ = index;
    std::visit([this](const auto& constraint) { apply_one(constraint); }, model_.constraints[index]);
  }

 private:
  [[nodiscard]] std::string field(const char* key) const {
    return fmt::format("specimen.constraints[{}].{}", index_, key);
  }

  void require_finite(const char* key, const Vec3& value) const {
    if (!value.allFinite()) throw CaseError(kWhere, field(key), text_of(value), "three finite numbers");
  }

  [[nodiscard]] std::vector<VertexId> selected(const Region& region) const {
    return selected_vertices(model_.mesh, region, field("where"));
  }

  void hold(const std::vector<VertexId>& vertices, const std::array<bool, 3>& axes, const Vec3& displacement) {
    for (const VertexId v : vertices) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (!axes[i]) continue;
        const auto axis = static_cast<int>(i);
        double& prescribed = model_.prescribed_displacement_mm[v.index()][axis];
        if (!model_.is_fixed[v.index()][i]) {
          model_.is_fixed[v.index()][i] = true;
          model_.holder[v.index()][i] = static_cast<std::int32_t>(index_);
          prescribed = displacement[axis];
        } else if (prescribed != displacement[axis]) {
          throw CaseError(
              kWhere, field("where"),
              fmt::format("vertex {} at {} mm to be moved by {:g} mm along {}", v.value,
                          text_of(model_.mesh.vertices[v.index()]), displacement[axis], kAxisNames[i]),
              fmt::format("{:g} mm, which specimen.constraints[{}] requires", prescribed, model_.holder[v.index()][i]),
              "Two constraints that overlap must agree; make one region smaller");
        }
      }
    }
  }

  void apply_one(const FixedConstraint& fixed) {
    if (!fixed.axes[0] && !fixed.axes[1] && !fixed.axes[2]) {
      throw CaseError(kWhere, field("axes"), "no axis", "at least one of x, y, z");
    }
    hold(selected(fixed.where), fixed.axes, Vec3::Zero());
  }

  void apply_one(const DisplacedConstraint& displaced) {
    require_finite("displacement_mm", displaced.displacement_mm);
    const double most_mm = kMostDiagonals * bounding_box(model_.mesh.vertices).diagonal().norm();
    if (!(displaced.displacement_mm.stableNorm() <= most_mm)) {
      throw CaseError(kWhere, field("displacement_mm"), text_of(displaced.displacement_mm),
                      fmt::format("at most {:g} mm", most_mm),
                      fmt::format("The limit is {:g} times the diagonal of the body's box: no tissue stretches that "
                                  "far, and rounding would hide its strain. Lengths are in mm",
                                  kMostDiagonals));
    }
    hold(selected(displaced.where), {true, true, true}, displaced.displacement_mm);
  }

  void apply_one(const SupportConstraint& support) {
    SupportPlane plane = support.holder ? holder_of(*support.holder) : plane_of(support);
    plane.constraint = index_;
    std::vector<double> stiffness(model_.mesh.vertices.size(), 0.0);
    for (const BoundaryFace& face : skin_) {
      const double share = youngs_modulus(face.tet) / kPenetrationAtModulusMm * area_vector(face).norm() / 3.0;
      for (const VertexId v : face.corners) stiffness[v.index()] += share;
    }
    for (std::size_t v = 0; v < stiffness.size(); ++v) {
      // A holder's normal may point anywhere, a plane's only one way.
      const Vec3 push = plane.holder ? Vec3::Ones().eval() : plane.normal;
      if (stiffness[v] == 0.0 || !can_move_along(push, v)) continue;
      if (plane.holder) require_outside(*plane.holder, v);
      plane.vertices.emplace_back(v);
      plane.stiffness.push_back(stiffness[v]);
    }
    model_.supports.push_back(std::move(plane));
  }

  [[nodiscard]] SupportPlane plane_of(const SupportConstraint& support) const {
    require_finite("plane.point_mm", support.point_mm);
    const double length = support.normal.norm();
    if (!std::isfinite(length) || length < 1e-12) {
      throw CaseError(kWhere, field("plane.normal"), text_of(support.normal), "a direction");
    }
    SupportPlane plane;
    plane.point_mm = support.point_mm;
    plane.normal = support.normal / length;
    return plane;
  }

  [[nodiscard]] SupportPlane holder_of(const HolderSurface& holder) const {
    SupportPlane plane;
    try {
      plane.holder = std::make_shared<HolderContact>(holder.surface);
    } catch (const InvalidArgument& problem) {
      throw CaseError(kWhere, field("surface"), fmt::format("an unusable surface, '{}'", holder.name),
                      "triangles, oriented alike, with normals towards the tissue", problem.as_hint());
    }
    return plane;
  }

  void require_outside(const HolderContact& holder, std::size_t v) const {
    const SupportGap start = holder.gap(model_.mesh.vertices[v]);
    if (start.gap_mm >= -kDeepestStartMm) return;
    throw CaseError(kWhere, field("surface"),
                    fmt::format("vertex {} at {} mm, {:.3g} mm inside the holder before anything moves", v,
                                text_of(model_.mesh.vertices[v]), -start.gap_mm),
                    fmt::format("at most {:g} mm", kDeepestStartMm),
                    "The holder must lie in the specimen's frame (mm, LPS), with normals towards the tissue");
  }

  [[nodiscard]] double youngs_modulus(TetId tet) const {
    const LameParameters& lame = model_.lame[tet.index()];
    return lame.mu_kpa * (3.0 * lame.lambda_kpa + 2.0 * lame.mu_kpa) / (lame.lambda_kpa + lame.mu_kpa);
  }

  [[nodiscard]] bool can_move_along(const Vec3& direction, std::size_t v) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!model_.is_fixed[v][i] && direction[static_cast<int>(i)] != 0.0) return true;
    }
    return false;
  }

  void apply_one(const TractionConstraint& traction) {
    require_finite("traction_kpa", traction.traction_kpa);
    static_cast<void>(selected(traction.where));  // throws if the region is wrong
    const std::vector<VertexLoad> loads = vertex_loads(model_.mesh, skin_, traction);
    if (loads.empty()) throw nothing_selected(model_.mesh, field("where"), "boundary face");
    for (const VertexLoad& load : loads) {
      model_.dead_load_mn[load.vertex.index()] += load.force_mn;
      model_.applied_load_mn[index_] += load.force_mn;
      if (model_.dead_load_mn[load.vertex.index()].allFinite() && model_.applied_load_mn[index_].allFinite()) continue;
      throw CaseError(kWhere, field("traction_kpa"), text_of(traction.traction_kpa),
                      "a traction whose force on the loaded area is a finite number of mN");
    }
  }

  [[nodiscard]] Vec3 area_vector(const BoundaryFace& face) const {
    const Vec3& a = vertex(model_.mesh.vertices, face.corners[0]);
    const Vec3& b = vertex(model_.mesh.vertices, face.corners[1]);
    const Vec3& c = vertex(model_.mesh.vertices, face.corners[2]);
    return 0.5 * (b - a).cross(c - a);
  }

  TissueModel& model_;
  std::vector<BoundaryFace> skin_;
  std::size_t index_ = 0;
};

}  // namespace

std::vector<VertexId> selected_vertices(const TetMesh& mesh, const Region& region, const std::string& field) {
  std::vector<VertexId> vertices;
  try {
    vertices = select(mesh, region);
  } catch (const InvalidArgument& problem) {
    throw CaseError(kWhere, field, "an unusable region", "one that can be applied to this mesh", problem.as_hint());
  }
  if (vertices.empty()) throw nothing_selected(mesh, field, "vertex");
  return vertices;
}

void apply_constraints(TissueModel& model, const Vec3& gravity_mm_s2) {
  if (!gravity_mm_s2.allFinite()) {
    throw CaseError(kWhere, "specimen.gravity_mm_s2", text_of(gravity_mm_s2), "three finite numbers");
  }
  const std::size_t count = model.mesh.vertices.size();
  model.is_fixed.assign(count, {false, false, false});
  model.holder.assign(count, {-1, -1, -1});
  model.prescribed_displacement_mm.assign(count, Vec3::Zero());
  model.dead_load_mn.resize(count);
  for (std::size_t v = 0; v < count; ++v) {
    model.dead_load_mn[v] = model.vertex_mass_kg[v] * gravity_mm_s2;
    if (model.dead_load_mn[v].allFinite()) continue;
    throw CaseError(kWhere, "specimen.gravity_mm_s2", text_of(gravity_mm_s2),
                    "an acceleration that gives finite "
                    "weights in mN");
  }
  model.applied_load_mn.assign(model.constraints.size(), Vec3::Zero());

  ConstraintApplier applier(model, boundary_faces(model.mesh));
  // Supports come last: a vertex that a clamp holds against the plane belongs to the clamp.
  for (const bool is_support_turn : {false, true}) {
    for (std::size_t i = 0; i < model.constraints.size(); ++i) {
      if (std::holds_alternative<SupportConstraint>(model.constraints[i]) == is_support_turn) applier.apply(i);
    }
  }
}

void require_no_rigid_motion(const TissueModel& model) {
  using Mat6 = Eigen::Matrix<double, 6, 6>;
  const Box3 box = bounding_box(model.mesh.vertices);
  const double scale = std::max(box.diagonal().norm(), 1e-300);
  Mat6 stopped = Mat6::Zero();  // sum over held axes of (row of the rigid modes)ᵀ (row)
  for (std::size_t v = 0; v < model.is_fixed.size(); ++v) {
    const Vec3 arm = (model.mesh.vertices[v] - box.center()) / scale;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!model.is_fixed[v][i]) continue;
      const Vec3 axis = Vec3::Unit(static_cast<int>(i));
      Eigen::Matrix<double, 6, 1> row;
      row << axis, arm.cross(axis);
      stopped += row * row.transpose();
    }
  }
  const Eigen::SelfAdjointEigenSolver<Mat6> solver(stopped);
  const double largest = solver.eigenvalues()[5];
  int free_motions = 0;
  for (int i = 0; i < 6; ++i) {
    if (!(solver.eigenvalues()[i] > kLeastStoppedShare * largest)) ++free_motions;
  }
  if (free_motions == 0) return;
  throw CaseError(kWhere, "specimen.constraints",
                  fmt::format("{} of the 6 rigid motions of the body left free", free_motions),
                  "fixed or displaced constraints that stop all six",
                  model.supports.empty() ? "Fix a region that is not a single line of vertices along all three axes"
                                         : "A support does not count: it only pushes, and tissue may lift off");
}

}  // namespace incise
