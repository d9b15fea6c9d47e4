#include "second_bench/body_state.hpp"

#include <incise/bench_kit/readings.hpp>
#include <incise/bench_kit/smooth_field.hpp>
#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/core/random.hpp>
#include <incise/core/units.hpp>
#include <incise/imaging/tumor_star.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace incise::second_bench {
namespace {

constexpr double kRoundRingMm = 4.0;     // width of the zone of small bricks beyond the planned ring and below it
constexpr double kToSilhouetteMm = 5.0;  // least distance of the ring from the silhouette
constexpr double kStiffnessWaveMm = 15.0;
constexpr double kAblationWaveMm = 12.0;
constexpr double kReliefWaveMm = 25.0;
constexpr int kEdgePoints = 120;
constexpr int kLaplaceSweeps = 400;
constexpr int kMostIterations = 4000;
constexpr double kAtRest = 1e-3;  // residual over reactions
constexpr std::uint64_t kShapeStream = 0x9ddfea08ULL;
constexpr std::uint64_t kFieldStream = 0x2545f491ULL;

/// Places planes at the marks, and evenly spaced planes between them, about `sizes` apart.
std::vector<double> planes(const std::vector<double>& marks, const std::vector<double>& sizes) {
  std::vector<double> result{marks.front()};
  for (std::size_t n = 1; n < marks.size(); ++n) {
    const double way = marks[n] - marks[n - 1];
    const int count = std::max(1, static_cast<int>(std::lround(way / sizes[n - 1])));
    for (int i = 1; i <= count; ++i) result.push_back(marks[n - 1] + way * i / count);
  }
  return result;
}

struct Tumor {
  Contour edge;
  Vec3 middle = Vec3::Zero();
  TumorStar star;
  double depth_mm = 4.0;
};

/// Signed distance of the tumour's middle from the mid-line: a share of the room that its ring leaves there.
double aside_mm(const Specimen& specimen, const TongueShape& shape, double y) {
  const double middle = midline_x_mm(shape, y);
  const double heading = specimen.tumor_aside < 0.0 ? -1.0 : 1.0;
  double half = 0.0;
  while (span_at(shape, middle + heading * (half + 0.25), y)) half += 0.25;
  const double ring = 0.5 * specimen.tumor_diameter_mm * (1.0 + specimen.tumor_irregularity) + specimen.margin_mm;
  return specimen.tumor_aside * std::max(0.0, half - ring - kToSilhouetteMm);
}

Tumor draw_tumor(const Specimen& specimen, const TongueShape& shape, Random& random) {
  Tumor tumor;
  tumor.star = draw_tumor_star(specimen.tumor_diameter_mm, specimen.tumor_irregularity, random);
  tumor.depth_mm = specimen.tumor_depth_mm;
  const double y = (specimen.tumor_along - 0.5) * shape.length_mm;
  const double x = midline_x_mm(shape, y) + aside_mm(specimen, shape, y);
  const auto place = [&](double px, double py) {
    const auto span = span_at(shape, px, py);
    if (!span)
      throw CaseError("specimen", "tumor_diameter_mm", fmt::format("{}, beyond the tissue", specimen.tumor_diameter_mm),
                      "a tumour whose edge lies on the back of the tongue");
    return Vec3(px, py, span->high_mm);
  };
  tumor.middle = place(x, y);
  for (int n = 0; n < kEdgePoints; ++n) {
    const double angle = 2.0 * units::kPi * n / kEdgePoints;
    const double r = tumor.star.radius_at_mm(angle);
    tumor.edge.points.push_back(place(x + r * std::cos(angle), y + r * std::sin(angle)));
  }
  return tumor;
}

bool is_in(const Tumor& tumor, const TongueShape& shape, const Vec3& p) {
  const Vec2 out = (p - tumor.middle).head<2>();
  const double share = out.norm() / tumor.star.radius_at_mm(std::atan2(out.y(), out.x()));
  if (share >= 1.0) return false;
  const auto span = span_at(shape, p.x(), p.y());
  return span && span->high_mm - p.z() <= tumor.depth_mm * std::sqrt(1.0 - share * share);
}

/// Fibres follow the gradient of a potential that is harmonic between clamp and suture (Laplace fibres); in the held
/// tissue they follow y.
std::vector<Vec3> fibres_of(const BrickGrid& grid, const std::vector<Voxels>& voxels, double low_y, double high_y) {
  const std::size_t count = grid.brick_count();
  std::vector<float> potential(count, 0.5F);
  std::vector<std::uint8_t> kind(count, 0);  // 0: no tissue, 1: free, 2: given
  const std::array<std::size_t, 3> stride{1, static_cast<std::size_t>(grid.bricks_along(0)),
                                          static_cast<std::size_t>(grid.bricks_along(0) * grid.bricks_along(1))};
  for (std::size_t b = 0; b < count; ++b) {
    if (voxels[b] == 0) continue;
    const Vec3 p = grid.low_mm(grid.place_of(b)) + 0.5 * grid.size_mm(grid.place_of(b));
    kind[b] = p.y() <= low_y || p.y() >= high_y ? 2 : 1;
    potential[b] = static_cast<float>(std::clamp((p.y() - low_y) / (high_y - low_y), 0.0, 1.0));
  }
  const auto each_neighbour = [&](std::size_t b, const auto& visit) {
    const auto place = grid.place_of(b);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int at = place[axis];
      if (at > 0 && kind[b - stride[axis]] != 0) visit(axis, b - stride[axis]);
      if (at + 1 < grid.bricks_along(static_cast<int>(axis)) && kind[b + stride[axis]] != 0)
        visit(axis, b + stride[axis]);
    }
  };
  for (int sweep = 0; sweep < kLaplaceSweeps; ++sweep)
    for (std::size_t b = 0; b < count; ++b) {
      if (kind[b] != 1) continue;
      const Vec3 size = grid.size_mm(grid.place_of(b));
      double sum = 0.0, weights = 0.0;
      each_neighbour(b, [&](std::size_t axis, std::size_t n) {
        const double between = 0.5 * (size[static_cast<Eigen::Index>(axis)] +
                                      grid.size_mm(grid.place_of(n))[static_cast<Eigen::Index>(axis)]);
        const double weight = 1.0 / (between * size[static_cast<Eigen::Index>(axis)]);
        sum += weight * static_cast<double>(potential[n]);
        weights += weight;
      });
      if (weights > 0.0) potential[b] = static_cast<float>(sum / weights);
    }
  std::vector<Vec3> fibres(count, Vec3::UnitY());
  for (std::size_t b = 0; b < count; ++b) {
    if (kind[b] != 1) continue;
    Vec3 gradient = Vec3::Zero();
    Vec3 taken = Vec3::Zero();
    const Vec3 here = grid.low_mm(grid.place_of(b)) + 0.5 * grid.size_mm(grid.place_of(b));
    each_neighbour(b, [&](std::size_t axis, std::size_t n) {
      const auto a = static_cast<Eigen::Index>(axis);
      const double between = (grid.low_mm(grid.place_of(n)) + 0.5 * grid.size_mm(grid.place_of(n)) - here)[a];
      gradient[a] += static_cast<double>(potential[n] - potential[b]) / between;
      taken[a] += 1.0;
    });
    for (int a = 0; a < 3; ++a)
      if (taken[a] > 0.0) gradient[a] /= taken[a];
    if (gradient.norm() > 1e-9) fibres[b] = gradient.normalized();
  }
  return fibres;
}

BrickGrid grid_of(const Specimen& specimen, const Resolution& resolution, const TongueShape& shape,
                  const Tumor& tumor) {
  const Box3 box = bounds_mm(shape);
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& p : tumor.edge.points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double round = specimen.margin_mm + kRoundRingMm;
  low -= Vec3(round, round, specimen.depth_mm + kRoundRingMm);
  high += Vec3(round, round, 0.0);
  const double fine = resolution.brick_mm, coarse = resolution.coarse_mm;
  const double tip = box.min().y(), root = box.max().y();
  const auto ordered = [](std::vector<double> marks) {
    for (std::size_t n = 1; n < marks.size(); ++n) marks[n] = std::max(marks[n], marks[n - 1] + 0.5);
    return marks;
  };
  BrickGrid grid;
  grid.planes_mm[0] = planes(ordered({std::min(box.min().x(), low.x() - 0.5), std::max(low.x(), box.min().x()),
                                      std::min(high.x(), box.max().x()), std::max(box.max().x(), high.x()) + 0.5}),
                             {coarse, fine, coarse});
  grid.planes_mm[1] = planes(ordered({tip, tip + kSuturedMm, low.y(), high.y(), root - kClampedMm, root}),
                             {coarse, coarse, fine, coarse, coarse});
  grid.planes_mm[2] = planes(ordered({0.0, low.z(), box.max().z() + 0.1}), {coarse, fine});
  return grid;
}

/// The suture's pull, N.
double pull_n(BodyState& state) {
  set_tissue_forces(state.tissue, 0.0F, static_cast<float>(kWeightMnMm3));
  add_platform(state.tissue, state.platform);
  Vec3 sum = Vec3::Zero();
  for (const std::int32_t node : state.suture_nodes) {
    const auto& f = state.tissue.force[static_cast<std::size_t>(node)];
    sum += Vec3(f[0], f[1], f[2]);
  }
  return 1e-3 * sum.norm();
}

/// Returns, per brick, the voxels whose middles lie in the shape, and fills `columns`.
std::vector<Voxels> fill(const BrickGrid& grid, const TongueShape& shape,
                         std::vector<std::optional<TissueSpan>>& columns) {
  std::vector<Voxels> voxels(grid.brick_count(), 0);
  for (int j = 0; j < kVoxelsAcross * grid.bricks_along(1); ++j)
    for (int i = 0; i < kVoxelsAcross * grid.bricks_along(0); ++i) {
      const int flat = i % kVoxelsAcross + kVoxelsAcross * (j % kVoxelsAcross);
      std::array<int, 3> place{i / kVoxelsAcross, j / kVoxelsAcross, 0};
      const Vec3 middle = grid.voxel_mm(place, flat);
      const auto& span = columns.emplace_back(span_at(shape, middle.x(), middle.y()));
      if (!span) continue;
      for (place[2] = 0; place[2] < grid.bricks_along(2); ++place[2])
        for (int bit = flat; bit < kVoxels; bit += kVoxelsAcross * kVoxelsAcross) {
          const double z = grid.voxel_mm(place, bit).z();
          if (z >= span->low_mm && z <= span->high_mm)
            voxels[grid.brick(place[0], place[1], place[2])] |= Voxels{1} << bit;
        }
    }
  return voxels;
}

/// Share of a brick's voxels that lie in the tumour.
double share_in(const Tumor& tumor, const TongueShape& shape, const BrickGrid& grid, std::size_t brick, Voxels voxels) {
  if (voxels == 0) return 0.0;
  int inside = 0;
  for (Voxels left = voxels; left != 0; left &= left - 1)
    if (is_in(tumor, shape, grid.voxel_mm(grid.place_of(brick), std::countr_zero(left)))) ++inside;
  return static_cast<double>(inside) / std::popcount(voxels);
}

BrickMaterial material_of(const Specimen& specimen, double stiffness, double tumor_share, const Vec3& fibre) {
  const double e = specimen.youngs_modulus_kpa * std::exp(stiffness) * std::pow(specimen.tumor_ratio, tumor_share);
  const double mu = e / (2.0 * (1.0 + specimen.poissons_ratio));
  BrickMaterial material;
  material.c1_kpa = static_cast<float>(0.5 * mu);
  material.c2_kpa = static_cast<float>(0.5 * mu * specimen.stiffening);
  material.lambda_kpa = static_cast<float>(mu / (1.0 - 2.0 * specimen.poissons_ratio));  // Lame's first constant + mu
  material.fibre_kpa = static_cast<float>(0.25 * (specimen.fibre_ratio - 1.0) * e * (1.0 - tumor_share));
  material.fibre = fibre;
  return material;
}

/// The platform: points of the sole under the middle of each column of bricks, and the relief under them.
Platform platform_of(const BrickTissue& tissue, const TongueShape& shape, const Specimen& specimen,
                     const SmoothField& relief) {
  Platform platform;
  platform.friction = specimen.friction;
  const BrickGrid& grid = tissue.grid;
  for (int j = 0; j < grid.bricks_along(1); ++j)
    for (int i = 0; i < grid.bricks_along(0); ++i) {
      const Vec3 size = grid.size_mm({i, j, 0}), middle = grid.low_mm({i, j, 0}) + 0.5 * size;
      const auto span = span_at(shape, middle.x(), middle.y());
      if (!span) continue;
      const Vec3 rest(middle.x(), middle.y(), span->low_mm);
      const Rider rider = tissue.rider_at(rest);
      if (rider.piece < 0) continue;  // thinner than a voxel
      platform.sole.push_back(rider);
      platform.area_mm2.push_back(static_cast<float>(size.x() * size.y()));
      platform.height_mm.push_back(specimen.sole_relief_mm * relief.at(rest));
      platform.anchor_mm.push_back(rest.head<2>());
      platform.is_down.push_back(0);
    }
  return platform;
}

/// Clamps the root, pulls the tip by the suture, and moves the tissue between by linear interpolation.
void hold(BodyState& state, const Specimen& specimen, double suture_y, double clamp_y) {
  constexpr double kOnPlaneMm = 1e-4;
  const double angle = units::rad_from_deg(specimen.stretch_angle_deg);
  const Vec3 pull = (kDrawnMm + specimen.stretch_error_mm) * Vec3(std::sin(angle), -std::cos(angle), 0.0);
  const Vec3 slip(0.0, -specimen.clamp_slip_mm, 0.0);
  BrickTissue& tissue = state.tissue;
  for (std::size_t n = 1; n < tissue.position.size(); ++n) {
    auto& p = tissue.position[n];
    const double y = static_cast<double>(p[1]);
    const bool is_sutured = y <= suture_y + kOnPlaneMm;
    tissue.is_held[n] = is_sutured || y >= clamp_y - kOnPlaneMm ? 1 : 0;
    if (is_sutured) state.suture_nodes.push_back(static_cast<std::int32_t>(n));
    const double share = std::clamp((clamp_y - y) / (clamp_y - suture_y), 0.0, 1.0);
    const Vec3 moved = (1.0 - share) * slip + share * pull;
    for (std::size_t a = 0; a < 3; ++a) p[a] += static_cast<float>(moved[static_cast<Eigen::Index>(a)]);
  }
}

/// Lets the stretched body come to rest, reads the gauge, and relaxes the tissue until the cut.
void stretch(Body& body, BodyState& state, Monitor& monitor) {
  const Specimen& specimen = body.specimen;
  const auto rests = [&] {
    int iterations = 0;
    body.residual = come_to_rest(state.tissue, state.platform, 0.0F, kAtRest, kMostIterations, iterations, monitor);
    return body.residual < kAtRest;
  };
  const auto waited = [&](double elapsed_s) {
    set_viscous_since(state.tissue, state.viscous_ratio, state.viscous_time_s, static_cast<float>(elapsed_s));
    return rests();
  };
  state.viscous_ratio = static_cast<float>(specimen.relaxing_ratio);
  state.viscous_time_s = static_cast<float>(specimen.relaxation_time_s);
  if (!rests() || !waited(specimen.gauge_s)) return;
  body.gauge_force_n = pull_n(state) * (1.0 + specimen.force_bias);
  if (!waited(specimen.wait_s)) return;
  body.stretch_force_n = pull_n(state);
  body.outcome = Outcome::Success;
}

}  // namespace

Body make_body(const Specimen& specimen, const Resolution& resolution, Monitor& monitor) {
  if (const auto problems = problems_of(specimen); !problems.empty()) throw CaseError("specimen", problems.front());
  INCISE_REQUIRE(resolution.brick_mm > 0.0 && resolution.coarse_mm >= resolution.brick_mm && resolution.way_mm > 0.0 &&
                     resolution.relaxations > 0,
                 "expected sizes and counts above 0, and coarse bricks that are no smaller than the others");
  auto state = std::make_shared<BodyState>();
  Random random(specimen.seed ^ kShapeStream);
  state->shape = draw_tongue_shape({}, random);
  const TongueShape& shape = state->shape;
  const Tumor tumor = draw_tumor(specimen, shape, random);
  state->tumor_edge_rest = tumor.edge.points;
  BrickGrid grid = grid_of(specimen, resolution, shape, tumor);
  const Box3 box = bounds_mm(shape);
  const double clamp_y = box.max().y() - kClampedMm, suture_y = box.min().y() + kSuturedMm;
  const std::vector<Voxels> voxels = fill(grid, shape, state->columns);

  Random fields(specimen.seed ^ kFieldStream);
  const SmoothField stiffness(kStiffnessWaveMm, fields), ablation(kAblationWaveMm, fields);
  const SmoothField relief(kReliefWaveMm, fields);
  const std::vector<Vec3> fibres = fibres_of(grid, voxels, suture_y, clamp_y);
  std::vector<BrickMaterial> materials;
  for (std::size_t b = 0; b < grid.brick_count(); ++b) {
    const Vec3 size = grid.size_mm(grid.place_of(b)), middle = grid.low_mm(grid.place_of(b)) + 0.5 * size;
    materials.push_back(material_of(specimen, specimen.stiffness_spread * stiffness.at(middle),
                                    share_in(tumor, shape, grid, b, voxels[b]), fibres[b]));
    state->energy_j.push_back(static_cast<float>(specimen.ablation_j_mm3 * size.prod() / kVoxels *
                                                 std::exp(specimen.ablation_spread * ablation.at(middle))));
  }
  state->tissue = make_tissue(std::move(grid), materials, voxels);
  state->platform = platform_of(state->tissue, shape, specimen, relief);
  hold(*state, specimen, suture_y, clamp_y);

  Body body;
  body.specimen = specimen;
  body.resolution = resolution;
  stretch(body, *state, monitor);
  body.state = std::move(state);
  return body;
}

}  // namespace incise::second_bench
