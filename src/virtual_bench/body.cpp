#include <incise/bench_kit/readings.hpp>
#include <incise/bench_kit/smooth_field.hpp>
#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/core/units.hpp>
#include <incise/mechanics/statics.hpp>
#include <incise/meshing/mesher.hpp>
#include <incise/virtual_bench/body.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

constexpr const char* kMakingStage = "making the virtual specimen";
constexpr double kRingMarginMm = 5.0;  // Paper II-A: expected distance of a path from the tumour
constexpr double kDepthMm = 5.0;
constexpr double kStretchTolerance = 1e-4;    // of the residual, relative to the reactions
constexpr std::size_t kSutureConstraint = 1;  // its index in constraints_of
constexpr double kStiffnessWaveMm = 15.0;
constexpr double kToughnessWaveMm = 12.0;
constexpr double kPartedLayerMm = 1.0;  // thickness of tissue that parts along one surface: the needle's
constexpr double kVoxelMm = 0.7;        // of the shape when it is meshed
constexpr int kColumns = 3;             // sub-columns of a voxel across
constexpr std::uint64_t kFieldStream = 0x5bd1e995ULL;

/// The exact shape as occupancy: the body does not depend on the CT.
GrayVolume occupancy_of_shape(const TongueShape& shape) {
  const Box3 box = bounds_mm(shape);
  GrayVolume volume;
  VolumeGrid& grid = volume.grid;
  grid.spacing_mm = Vec3::Constant(kVoxelMm);
  grid.origin_mm = box.min() - Vec3::Constant(3.0 * kVoxelMm);
  for (int axis = 0; axis < 3; ++axis) {
    grid.size[static_cast<std::size_t>(axis)] = static_cast<int>(std::ceil(box.sizes()[axis] / kVoxelMm)) + 7;
  }
  volume.voxels.assign(grid.voxel_count(), 0.0F);
  for (int j = 0; j < grid.size[1]; ++j) {
    for (int i = 0; i < grid.size[0]; ++i) {
      for (int s = 0; s < kColumns * kColumns; ++s) {
        const double x = grid.origin_mm.x() + kVoxelMm * (i + (s % kColumns + 0.5) / kColumns - 0.5);
        const double y = grid.origin_mm.y() + kVoxelMm * (j + (s / kColumns + 0.5) / kColumns - 0.5);
        const auto span = span_at(shape, x, y);
        if (!span) continue;
        for (int k = 0; k < grid.size[2]; ++k) {
          const double low = grid.origin_mm.z() + kVoxelMm * (k - 0.5);
          const double inside = std::min(span->high_mm, low + kVoxelMm) - std::max(span->low_mm, low);
          if (inside > 0.0) volume.at(i, j, k) += static_cast<float>(inside / (kVoxelMm * kColumns * kColumns));
        }
      }
    }
  }
  return volume;
}

/// The tumour's edge, moved outwards by the margin: the mesh must be fine there.
Contour expected_ring(const Phantom& phantom) {
  Contour ring = phantom.tumor_edge;
  for (Vec3& p : ring.points) {
    const Vec2 out = (p - phantom.tumor_center_mm).head<2>();
    const Vec2 moved = phantom.tumor_center_mm.head<2>() + out * (1.0 + kRingMarginMm / out.norm());
    const auto span = span_at(phantom.shape, moved.x(), moved.y());
    if (span) p = Vec3(moved.x(), moved.y(), span->high_mm);
  }
  return ring;
}

TetMesh mesh_of(const Phantom& phantom, const BenchResolution& resolution, Monitor& monitor) {
  PlannedCut cut;
  cut.path = expected_ring(phantom);
  cut.depth_mm = kDepthMm;
  SizingSettings sizes;
  sizes.fine_mm = resolution.fine_mm;
  sizes.coarse_mm = resolution.coarse_mm;
  sizes.growth = 0.45;
  sizes.band_inside_mm = 3.5;
  sizes.band_outside_mm = 2.0;
  sizes.band_below_mm = 1.0;
  MeshingSettings settings;
  settings.facet_distance_factor = 0.2;
  return mesh_labels(occupancy_of_shape(phantom.shape), SizingField::around_cut(cut, sizes), settings, monitor).mesh;
}

bool is_in_tumor(const Phantom& phantom, double depth_mm, const Vec3& p) {
  if (!contains_in_view(phantom.tumor_edge, p, -Vec3::UnitZ())) return false;
  const auto span = span_at(phantom.shape, p.x(), p.y());
  if (!span) return false;
  // The bowl of the tumour's closed surface: depth_mm sqrt(1 - share²) below the back.
  const Vec2 out = (p - phantom.tumor_center_mm).head<2>();
  double edge = 1e-9;
  const Vec2 heading = out.norm() > 1e-9 ? Vec2(out.normalized()) : Vec2(Vec2::UnitX());
  for (const Vec3& e : phantom.tumor_edge.points) {
    const Vec2 d = (e - phantom.tumor_center_mm).head<2>();
    if (d.normalized().dot(heading) > 0.998) edge = std::max(edge, d.norm());
  }
  const double share = std::min(1.0, out.norm() / edge);
  return span->high_mm - p.z() <= depth_mm * std::sqrt(1.0 - share * share);
}

struct Fields {
  MaterialField tissue;
  std::vector<double> toughness_kpa;
};

Fields fields_of(const TetMesh& mesh, const Phantom& phantom, const Specimen& specimen) {
  Random random(specimen.seed ^ kFieldStream);
  const SmoothField stiffness(kStiffnessWaveMm, random);
  const SmoothField toughness(kToughnessWaveMm, random);
  Fields fields;
  for (const Tet& tet : mesh.tets) {
    Vec3 middle = Vec3::Zero();
    for (const VertexId v : tet) middle += 0.25 * mesh.vertices[v.index()];
    double e = specimen.youngs_modulus_kpa * std::exp(specimen.stiffness_spread * stiffness.at(middle));
    if (is_in_tumor(phantom, specimen.tumor_depth_mm, middle)) e *= specimen.inclusion_ratio;
    fields.tissue.youngs_modulus_kpa.push_back(e);
    fields.tissue.poissons_ratio.push_back(specimen.poissons_ratio);
    fields.toughness_kpa.push_back(specimen.toughness_j_m2 / kPartedLayerMm *
                                   std::exp(specimen.toughness_spread * toughness.at(middle)));
  }
  return fields;
}

std::vector<Constraint> constraints_of(const Specimen& specimen) {
  const double angle = units::rad_from_deg(specimen.stretch_angle_deg);
  const double way = kDrawnMm + specimen.stretch_error_mm;
  const Vec3 pull = way * Vec3(std::sin(angle), -std::cos(angle), 0.0);
  return {DisplacedConstraint{EndRegion{Vec3::UnitY(), kClampedMm}, Vec3(0.0, -specimen.clamp_slip_mm, 0.0)},
          DisplacedConstraint{EndRegion{-Vec3::UnitY(), kSuturedMm}, pull},
          SupportConstraint{Vec3::Zero(), Vec3::UnitZ()}};
}

Material material_of(const Specimen& specimen) {
  Material material;
  material.model = MaterialModel::StableNeoHookean;
  material.youngs_modulus_kpa = specimen.youngs_modulus_kpa;
  material.poissons_ratio = specimen.poissons_ratio;
  material.fibre_modulus_kpa = specimen.fibre_ratio * specimen.youngs_modulus_kpa;
  const double angle = units::rad_from_deg(specimen.fibre_angle_deg);
  material.fibre_direction = Vec3(std::sin(angle), std::cos(angle), 0.0);
  if (specimen.relaxing_ratio > 0.0) material.prony = {{specimen.relaxing_ratio, specimen.relaxation_time_s}};
  return material;
}

/// Clamps and stretches the body, and relaxes it completely.
void stretch(BenchBody& body, Workers& workers, Monitor& monitor) {
  const TissueModel& model = *body.tissue;
  StaticSettings settings;
  settings.relative_tolerance = kStretchTolerance;
  StaticResult result = solve_static(model, settings, workers, monitor);
  if (result.outcome == Outcome::Cancelled) throw_if_cancelled(monitor, kMakingStage);
  body.outcome = result.outcome;
  body.stretched = std::move(result.state);
  body.equilibrium_residual = result.relative_residual;
  body.inverted_tets = result.inverted_tets;
  end_viscous_step(model, body.stretched, std::numeric_limits<double>::infinity(), workers);
  body.stretch_force_n = result.reactions_mn[kSutureConstraint].norm() / 1000.0;
}

}  // namespace

PhantomSettings phantom_settings(const Specimen& specimen) {
  PhantomSettings settings;
  settings.seed = specimen.seed;
  settings.noise_hu = specimen.ct_noise_hu;
  settings.tumor_diameter_mm = specimen.tumor_diameter_mm;
  settings.tumor_irregularity = specimen.tumor_irregularity;
  settings.tumor_depth_mm = specimen.tumor_depth_mm;
  settings.tumor_position = specimen.tumor_position;
  return settings;
}

BenchBody make_body(const Specimen& specimen, const BenchResolution& resolution, Workers& workers, Monitor& monitor) {
  if (const auto problems = problems_of(specimen); !problems.empty()) throw CaseError("specimen", problems.front());
  PhantomSettings shown = phantom_settings(specimen);
  shown.spacing_mm = Vec3::Constant(3.0);  // the CT is not used, and shape and tumour do not depend on its spacing
  const Phantom phantom = make_phantom(shown, monitor);

  BenchBody body;
  body.specimen = specimen;
  body.resolution = resolution;
  TetMesh mesh = mesh_of(phantom, resolution, monitor);
  const Fields fields = fields_of(mesh, phantom, specimen);
  body.toughness_kpa = fields.toughness_kpa;
  const Vec3 gravity(0.0, 0.0, -units::kStandardGravityMmS2);
  body.tissue = std::make_shared<const TissueModel>(
      make_tissue_model(std::move(mesh), material_of(specimen), constraints_of(specimen), gravity, fields.tissue));
  body.skin = boundary_faces(body.tissue->mesh);
  body.tumor_edge_rest = counter_clockwise(phantom.tumor_edge, body.approach);
  const TetLocator locator(body.tissue->mesh, body.tissue->mesh.vertices);
  for (const Vec3& p : body.tumor_edge_rest.points) {
    const auto point = locator.locate(p, 1.0);
    if (!point) throw Error("the tumour's edge lies off the virtual specimen's surface");
    body.tumor_edge.push_back(*point);
  }
  stretch(body, workers, monitor);
  return body;
}

Contour tumor_edge_at(const BenchBody& body, std::span<const Vec3> positions) {
  Contour edge;
  for (const EmbeddedPoint& point : body.tumor_edge)
    edge.points.push_back(position_of(point, body.tissue->mesh, positions));
  return edge;
}

TriMesh skin_at(const BenchBody& body, std::span<const Vec3> positions) {
  TriMesh skin;
  skin.vertices.assign(positions.begin(), positions.end());
  for (const BoundaryFace& face : body.skin) skin.triangles.push_back(face.corners);
  return skin;
}

void add_faces(const BenchBody& body, std::span<const std::uint8_t> is_live, std::vector<Triangle>& triangles,
               std::vector<std::uint8_t>& is_skin) {
  const auto sorted = [](Triangle corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
  };
  std::vector<Triangle> skin;
  for (const BoundaryFace& face : body.skin) skin.push_back(sorted(face.corners));
  std::sort(skin.begin(), skin.end());
  for (const BoundaryFace& face : boundary_faces(body.tissue->mesh, is_live)) {
    triangles.push_back(face.corners);
    is_skin.push_back(std::binary_search(skin.begin(), skin.end(), sorted(face.corners)) ? 1 : 0);
  }
}

}  // namespace incise
