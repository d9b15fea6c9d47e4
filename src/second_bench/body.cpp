#include "second_bench/body_state.hpp"

#include <incise/bench_kit/smooth_field.hpp>
#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/core/random.hpp>
#include <incise/core/units.hpp>
#include <incise/imaging/tumor_star.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

namespace incise::second_bench {
namespace {

constexpr double kClampMm = 14.0;
constexpr double kSutureMm = 8.0;
constexpr double kStretchMm = 20.0;
constexpr double kRoundRingMm = 4.0;     // beyond the planned ring and below it: where bricks are small
constexpr double kToSilhouetteMm = 5.0;  // from the ring of the tumour that lies farthest aside
constexpr double kReliefWaveMm = 25.0;
constexpr const char* kMakingStage = "making the virtual specimen";
constexpr int kLaplaceSweeps = 400;
constexpr int kMostIterations = 4000;
constexpr double kAtRest = 1e-3;  // residual over reactions
constexpr std::uint64_t kShapeStream = 0x9ddfea08ULL;
constexpr std::uint64_t kFieldStream = 0x2545f491ULL;

/// Planes at the marks, and evenly between them, about `sizes` apart.
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

/// How far the tumour's middle lies beside the mid-line: a share of the room that its ring leaves there.
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
    return Vec3(px, py, span ? span->high_mm : std::numeric_limits<double>::quiet_NaN());
  };
  tumor.middle = place(x, y);
  for (int n = 0; n < 120; ++n) {
    const double angle = 2.0 * units::kPi * n / 120;
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

/// Fibres run along the gradient of a potential that is harmonic between clamp and suture (Laplace fibres).
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
  grid.planes_mm[1] = planes(ordered({tip, tip + kSutureMm, low.y(), high.y(), root - kClampMm, root}),
                             {coarse, coarse, fine, coarse, coarse});
  grid.planes_mm[2] = planes(ordered({0.0, low.z(), box.max().z() + 0.1}), {coarse, fine});
  return grid;
}

/// Lets held tissue come to rest. @returns free forces over reactions; not a number where it burst.
double come_to_rest(BodyState& state, Monitor& monitor) {
  BrickTissue& tissue = state.tissue;
  Relaxer relaxer;
  Rest rest;
  for (int n = 0; n < kMostIterations; ++n) {
    if (n % 20 == 0) {
      throw_if_cancelled(monitor, kMakingStage);
      bound_masses(tissue, 0.0F);
      add_platform_masses(tissue, state.platform);
    }
    add_elastic_forces(tissue, 0.0F, static_cast<float>(kWeightMnMm3));
    add_platform(tissue, state.platform);
    rest = relaxer.iterate(tissue, 0.0);
    if (n > 50 && rest.residual_mn < kAtRest * rest.reaction_mn) break;
  }
  for (auto& velocity : tissue.velocity) velocity = {};
  return rest.residual_mn / rest.reaction_mn;
}

/// What the suture holds.
double pull_n(BodyState& state) {
  add_elastic_forces(state.tissue, 0.0F, static_cast<float>(kWeightMnMm3));
  add_platform(state.tissue, state.platform);
  Vec3 sum = Vec3::Zero();
  for (const std::int32_t node : state.suture_nodes) {
    const auto& f = state.tissue.force[static_cast<std::size_t>(node)];
    sum += Vec3(f[0], f[1], f[2]);
  }
  return 1e-3 * sum.norm();
}

}  // namespace

Body make_body(const Specimen& specimen, const Resolution& resolution, Monitor& monitor) {
  const auto start = std::chrono::steady_clock::now();
  if (const auto problems = problems_of(specimen); !problems.empty()) throw CaseError("specimen", problems.front());
  auto state = std::make_shared<BodyState>();
  Random random(specimen.seed ^ kShapeStream);
  state->shape = draw_tongue_shape({}, random);
  const Tumor tumor = draw_tumor(specimen, state->shape, random);
  BrickGrid grid = grid_of(specimen, resolution, state->shape, tumor);
  const TongueShape& shape = state->shape;
  const Box3 box = bounds_mm(shape);
  const double clamp_y = box.max().y() - kClampMm, suture_y = box.min().y() + kSutureMm;

  // Voxels whose middles lie in the shape.
  std::vector<Voxels> voxels(grid.brick_count(), 0);
  const int nx = kVoxelsAcross * grid.bricks_along(0), ny = kVoxelsAcross * grid.bricks_along(1);
  state->columns.resize(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny));
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const std::array<int, 3> place{i / kVoxelsAcross, j / kVoxelsAcross, 0};
      const Vec3 middle = grid.voxel_mm(place, i % kVoxelsAcross + 4 * (j % kVoxelsAcross));
      const auto span = span_at(shape, middle.x(), middle.y());
      state->columns[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i)] = span;
      if (!span) continue;
      for (int k = 0; k < grid.bricks_along(2); ++k)
        for (int c = 0; c < kVoxelsAcross; ++c) {
          const int bit = i % kVoxelsAcross + 4 * (j % kVoxelsAcross) + 16 * c;
          const double z = grid.voxel_mm({place[0], place[1], k}, bit).z();
          if (z >= span->low_mm && z <= span->high_mm) voxels[grid.brick(place[0], place[1], k)] |= Voxels{1} << bit;
        }
    }

  Random fields(specimen.seed ^ kFieldStream);
  const SmoothField stiffness(15.0, fields), ablation(12.0, fields);
  const std::vector<Vec3> fibres = fibres_of(grid, voxels, suture_y, clamp_y);
  std::vector<BrickMaterial> materials(grid.brick_count());
  state->energy_j.resize(grid.brick_count());
  for (std::size_t b = 0; b < grid.brick_count(); ++b) {
    const auto place = grid.place_of(b);
    const Vec3 size = grid.size_mm(place), middle = grid.low_mm(place) + 0.5 * size;
    int inside = 0, all = 0;
    for (int bit = 0; bit < kVoxels; ++bit) {
      if ((voxels[b] >> bit & 1) == 0) continue;
      ++all;
      if (is_in(tumor, shape, grid.voxel_mm(place, bit))) ++inside;
    }
    const double share = all > 0 ? static_cast<double>(inside) / all : 0.0;
    const double e = specimen.youngs_modulus_kpa * std::exp(specimen.stiffness_spread * stiffness.at(middle)) *
                     std::pow(specimen.tumor_ratio, share);
    const double mu = e / (2.0 * (1.0 + specimen.poissons_ratio));
    BrickMaterial& m = materials[b];
    m.c1_kpa = static_cast<float>(0.5 * mu);
    m.c2_kpa = static_cast<float>(0.5 * mu * specimen.stiffening);
    m.lambda_kpa = static_cast<float>(mu / (1.0 - 2.0 * specimen.poissons_ratio));  // Lame's first constant + mu
    m.fibre_kpa = static_cast<float>(0.25 * (specimen.fibre_ratio - 1.0) * e * (1.0 - share));
    m.fibre = fibres[b];
    state->energy_j[b] = static_cast<float>(specimen.ablation_j_mm3 * size.prod() / kVoxels *
                                            std::exp(specimen.ablation_spread * ablation.at(middle)));
  }
  state->tissue = make_tissue(std::move(grid), std::move(materials), voxels);
  BrickTissue& tissue = state->tissue;
  const BrickGrid& g = tissue.grid;

  // The sole: one point under the middle of each column of bricks.
  for (int j = 0; j < g.bricks_along(1); ++j)
    for (int i = 0; i < g.bricks_along(0); ++i) {
      const Vec3 low = g.low_mm({i, j, 0}), size = g.size_mm({i, j, 0});
      const Vec3 middle = low + 0.5 * size;
      const auto span = span_at(shape, middle.x(), middle.y());
      if (!span) continue;
      const Rider rider = tissue.rider_at(Vec3(middle.x(), middle.y(), span->low_mm));
      if (rider.piece < 0) continue;
      state->platform.sole.push_back(rider);
      state->platform.area_mm2.push_back(static_cast<float>(size.x() * size.y()));
    }
  const SmoothField relief(kReliefWaveMm, fields);
  for (const Rider& rider : state->platform.sole)
    state->platform.height_mm.push_back(specimen.sole_relief_mm * relief.at(tissue.position_of(rider)));
  state->platform.anchor_mm.resize(state->platform.sole.size(), Vec2::Zero());
  state->platform.is_down.resize(state->platform.sole.size(), 0);
  state->platform.friction = specimen.friction;

  // Clamp and suture; between them a first guess.
  const double angle = units::rad_from_deg(specimen.stretch_angle_deg);
  const double way = kStretchMm + specimen.stretch_error_mm;
  const Vec3 pull = way * Vec3(std::sin(angle), -std::cos(angle), 0.0);
  const Vec3 slip(0.0, -specimen.clamp_slip_mm, 0.0);
  for (std::size_t n = 1; n < tissue.position.size(); ++n) {
    auto& p = tissue.position[n];
    const double y = static_cast<double>(p[1]);
    const double share = std::clamp((clamp_y - y) / (clamp_y - suture_y), 0.0, 1.0);
    if (y >= clamp_y - 1e-4 || y <= suture_y + 1e-4) tissue.is_held[n] = 1;
    if (y <= suture_y + 1e-4) state->suture_nodes.push_back(static_cast<std::int32_t>(n));
    const Vec3 moved = (1.0 - share) * slip + share * pull;
    for (std::size_t a = 0; a < 3; ++a) p[a] += static_cast<float>(moved[static_cast<Eigen::Index>(a)]);
  }

  Body body;
  body.specimen = specimen;
  body.resolution = resolution;
  body.tumor_edge_rest = tumor.edge;
  state->tumor_edge_rest = tumor.edge.points;
  double residual = come_to_rest(*state, monitor);
  if (residual <= kAtRest) {
    state->viscous_ratio = static_cast<float>(specimen.relaxing_ratio);
    state->viscous_time_s = static_cast<float>(specimen.relaxation_time_s);
    set_viscous_since(tissue, state->viscous_ratio, state->viscous_time_s, static_cast<float>(specimen.gauge_s));
    residual = come_to_rest(*state, monitor);
    body.gauge_force_n = pull_n(*state) * (1.0 + specimen.force_bias);
    set_viscous_since(tissue, state->viscous_ratio, state->viscous_time_s, static_cast<float>(specimen.wait_s));
    residual = std::max(residual, come_to_rest(*state, monitor));
    body.stretch_force_n = pull_n(*state);
  }
  body.residual = residual;
  body.outcome = residual <= kAtRest ? Outcome::Success : Outcome::NotConverged;
  body.state = std::move(state);
  body.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return body;
}

}  // namespace incise::second_bench
