#include <incise/core/error.hpp>
#include <incise/geometry/gaussian.hpp>
#include <incise/meshing/occupancy.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

namespace incise {
namespace {

constexpr std::size_t kMaxVoxels = 200'000'000;
constexpr int kShiftsTried = 8;

struct DirectedEdge {
  VertexId low, high;
  bool runs_up = false;  ///< from low to high
  std::size_t triangle = 0;
};

void refuse_bad_corner(const TriMesh& surface, std::size_t triangle, VertexId id) {
  if (!id.is_valid() || id.index() >= surface.vertices.size()) {
    throw InvalidArgument(fmt::format("surface: triangle {} names vertex {}, but there are {} vertices", triangle,
                                      id.value, surface.vertices.size()));
  }
  if (!surface.vertices[id.index()].allFinite()) {
    throw InvalidArgument(fmt::format("surface: vertex {} is not finite", id.value));
  }
}

std::vector<DirectedEdge> sorted_edges(const TriMesh& surface) {
  std::vector<DirectedEdge> edges;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle& corners = surface.triangles[t];
    for (std::size_t c = 0; c < 3; ++c) {
      const VertexId from = corners[c];
      const VertexId to = corners[(c + 1) % 3];
      refuse_bad_corner(surface, t, from);
      if (from == to) throw InvalidArgument(fmt::format("surface: triangle {} names vertex {} twice", t, from.value));
      edges.push_back({std::min(from, to), std::max(from, to), from < to, t});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const DirectedEdge& a, const DirectedEdge& b) {
    return std::tie(a.low, a.high, a.runs_up, a.triangle) < std::tie(b.low, b.high, b.runs_up, b.triangle);
  });
  return edges;
}

/// Refuses a surface unless each edge joins exactly two triangles that traverse it in opposite directions.
void require_closed(const TriMesh& surface) {
  if (surface.triangles.empty()) throw InvalidArgument("surface: found no triangles, expected a closed surface");
  const std::vector<DirectedEdge> edges = sorted_edges(surface);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
    const Vec3 at = 0.5 * (surface.vertices[edges[i].low.index()] + surface.vertices[edges[i].high.index()]);
    if (end - i != 2) {
      throw InvalidArgument(
          fmt::format("surface is not closed and manifold: the edge of triangle {} near ({:.2f}, {:.2f}, {:.2f}) mm "
                      "joins {} triangle{}, expected 2. Fill the holes of the surface first.",
                      edges[i].triangle, at.x(), at.y(), at.z(), end - i, end - i == 1 ? "" : "s"));
    }
    if (edges[i].runs_up == edges[i + 1].runs_up) {
      throw InvalidArgument(
          fmt::format("surface: triangles {} and {} near ({:.2f}, {:.2f}, {:.2f}) mm face opposite ways, "
                      "expected neighbours to agree on which side is outside",
                      edges[i].triangle, edges[i + 1].triangle, at.x(), at.y(), at.z()));
    }
    i = end;
  }
}

/// Returns twice the signed area of the triangle of a, b and (y, z) in the y-z plane. The computation is the same for
/// both triangles that share the edge, so no ray slips between them.
double side_of(const TriMesh& surface, VertexId a, VertexId b, double y, double z) {
  const bool swap = b < a;
  const Vec3& p = surface.vertices[(swap ? b : a).index()];
  const Vec3& q = surface.vertices[(swap ? a : b).index()];
  const double area = (q.y() - p.y()) * (z - p.z()) - (q.z() - p.z()) * (y - p.y());
  return swap ? -area : area;
}

struct Crossing {
  std::size_t ray = 0;
  double x_mm = 0.0;
  int turn = 0;  ///< +1 where the ray along +x enters the body, -1 where it leaves
};

/// Returns a number in [0, 1) for each n; consecutive ones fill the interval evenly (golden ratio).
double even_fraction(int n) {
  constexpr double kGolden = 0.6180339887498949;
  return n * kGolden - std::floor(n * kGolden);
}

/// Rays along +x, one through each square of a lattice in the y-z plane, with their crossings of the surface. The place
/// within the square varies, so a face parallel to an axis does not gain or lose a whole row of rays.
class RayLattice {
 public:
  RayLattice(const TriMesh& surface, double y0, double z0, double step, int ny, int nz)
      : surface_(surface), y0_(y0), z0_(z0), step_(step), ny_(ny), nz_(nz) {
    for (const Triangle& triangle : surface.triangles) cross(triangle);
    std::sort(crossings_.begin(), crossings_.end(), [](const Crossing& a, const Crossing& b) {
      return std::tie(a.ray, a.x_mm, a.turn) < std::tie(b.ray, b.x_mm, b.turn);
    });
  }

  /// Calls visit(j, k, from_mm, to_mm) for every stretch of a ray inside the body, in order of rays, then x.
  /// @returns false, and stops, if a ray does not leave the body as often as it enters, because it met an edge exactly.
  template <class Visit>
  [[nodiscard]] bool for_each_inside(const Visit& visit) const {
    const auto rays_along_y = static_cast<std::size_t>(ny_);
    int depth = 0;
    for (std::size_t c = 0; c < crossings_.size(); ++c) {
      const Crossing& here = crossings_[c];
      depth += here.turn;
      const bool is_last = c + 1 == crossings_.size() || crossings_[c + 1].ray != here.ray;
      if (is_last && depth != 0) return false;
      if (depth == 0) continue;
      visit(static_cast<int>(here.ray % rays_along_y), static_cast<int>(here.ray / rays_along_y), here.x_mm,
            crossings_[c + 1].x_mm);
    }
    return true;
  }

 private:
  void cross(const Triangle& t) {
    const auto [a, b, c] = corners_of(surface_.vertices, t);
    const auto square = [this](double at, double from) { return static_cast<int>(std::floor((at - from) / step_)); };
    const int j0 = std::max(square(std::min({a.y(), b.y(), c.y()}), y0_), 0);
    const int j1 = std::min(square(std::max({a.y(), b.y(), c.y()}), y0_), ny_ - 1);
    const int k0 = std::max(square(std::min({a.z(), b.z(), c.z()}), z0_), 0);
    const int k1 = std::min(square(std::max({a.z(), b.z(), c.z()}), z0_), nz_ - 1);
    for (int k = k0; k <= k1; ++k) {
      for (int j = j0; j <= j1; ++j) cross(t, Vec3(a.x(), b.x(), c.x()), j, k);
    }
  }
  void cross(const Triangle& t, const Vec3& corner_x_mm, int j, int k) {
    const double y = y0_ + step_ * (j + even_fraction(k));
    const double z = z0_ + step_ * (k + even_fraction(j));
    const Vec3 weights(side_of(surface_, t[1], t[2], y, z), side_of(surface_, t[2], t[0], y, z),
                       side_of(surface_, t[0], t[1], y, z));
    const bool all_left = weights.minCoeff() > 0.0;
    const bool all_right = weights.maxCoeff() < 0.0;
    if (!all_left && !all_right) return;
    const std::size_t ray = static_cast<std::size_t>(j) + static_cast<std::size_t>(ny_) * static_cast<std::size_t>(k);
    // Counter-clockwise in the y-z plane: the normal points along +x, so the ray leaves.
    crossings_.push_back({ray, weights.dot(corner_x_mm) / weights.sum(), all_left ? -1 : 1});
  }

  const TriMesh& surface_;
  double y0_, z0_, step_;
  int ny_, nz_;
  std::vector<Crossing> crossings_;
};

/// Adds `weight` times the fraction of each voxel that [from, to], in voxels, covers to a row.
void add_interval(float* row, int count, double from, double to, double weight) {
  const int first = std::max(static_cast<int>(std::floor(from)), 0);
  const int last = std::min(static_cast<int>(std::floor(to)), count - 1);
  for (int i = first; i <= last; ++i) {
    row[i] += static_cast<float>(weight * (std::min<double>(to, i + 1) - std::max<double>(from, i)));
  }
}

/// Returns the number of rays per voxel along y, and along z: 3 to 8, fewer for a large grid.
int rays_per_voxel(const VolumeGrid& grid) {
  constexpr double kMostRays = 4.0e6;
  const double rows = static_cast<double>(grid.size[1]) * static_cast<double>(grid.size[2]);
  return std::clamp(static_cast<int>(std::sqrt(kMostRays / rows)), 3, 8);
}

VolumeGrid grid_around(const Box3& box, double voxel_mm, int margin) {
  VolumeGrid grid;
  double voxels = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = std::ceil(box.sizes()[axis] / voxel_mm) + 2.0 * margin;
    voxels *= cells;
    if (voxels > static_cast<double>(kMaxVoxels)) {
      throw InvalidArgument(
          fmt::format("voxel_mm: {} mm divides the surface's box into more than {} voxels; use larger voxels", voxel_mm,
                      kMaxVoxels));
    }
    grid.size[static_cast<std::size_t>(axis)] = static_cast<int>(cells);
  }
  grid.spacing_mm = Vec3::Constant(voxel_mm);
  grid.origin_mm = box.min() + Vec3::Constant((0.5 - margin) * voxel_mm);
  return grid;
}

}  // namespace

GrayVolume occupancy_of(const TriMesh& closed_surface, double voxel_mm, double sigma_voxels) {
  INCISE_REQUIRE(voxel_mm > 0.0 && std::isfinite(voxel_mm),
                 fmt::format("voxel_mm: found {}, expected a finite number > 0", voxel_mm));
  INCISE_REQUIRE(sigma_voxels >= 0.0 && sigma_voxels <= 10.0,
                 fmt::format("sigma_voxels: found {}, expected 0 to 10", sigma_voxels));
  require_closed(closed_surface);
  Box3 box;
  for (const Triangle& triangle : closed_surface.triangles) {
    for (const VertexId id : triangle) box.extend(vertex(closed_surface.vertices, id));
  }
  GrayVolume result;
  result.grid = grid_around(box, voxel_mm, gaussian_reach(sigma_voxels) + 1);
  const int voxels_along_x = result.grid.size[0];
  const int rays = rays_per_voxel(result.grid);
  const double step = voxel_mm / rays;
  const double weight = 1.0 / (rays * rays);
  const Vec3 low = result.grid.origin_mm - Vec3::Constant(0.5 * voxel_mm);
  for (int attempt = 0; attempt < kShiftsTried; ++attempt) {
    // Each attempt shifts the rays slightly: a ray that met an edge exactly now misses it.
    const double shift = 1.0e-4 * (attempt + 0.37) * step;
    const RayLattice lattice(closed_surface, low.y() + shift, low.z() + shift * (1.0 + 1.0e-5), step,
                             rays * result.grid.size[1], rays * result.grid.size[2]);
    result.voxels.assign(result.grid.voxel_count(), 0.0F);
    const bool is_consistent = lattice.for_each_inside([&](int j, int k, double from_mm, double to_mm) {
      add_interval(&result.at(0, j / rays, k / rays), voxels_along_x, (from_mm - low.x()) / voxel_mm,
                   (to_mm - low.x()) / voxel_mm, weight);
    });
    if (!is_consistent) continue;
    for (float& value : result.voxels) value = std::clamp(value, 0.0F, 1.0F);  // removes rounding errors of the sums
    blur(result, sigma_voxels);
    return result;
  }
  throw InvalidArgument(
      fmt::format("surface: none of {} sets of rays crosses it consistently; it has flat or folded triangles that "
                  "need repair",
                  kShiftsTried));
}

}  // namespace incise
