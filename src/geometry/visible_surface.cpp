#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/geometry/surface_query.hpp>
#include <incise/geometry/visible_surface.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace incise {
namespace {

constexpr double kSamplesPerSpacing2 =
    10.0;  // candidates per spacing²: the thinned set then has no gaps wider than twice the spacing
constexpr double kClearance = 1e-5;  // share of the surface's size: height above a point at which its ray starts
constexpr double kCrease =
    0.82;  // cosine, 35 degrees: a triangle that is tilted farther from a vertex's normal has a crease there

/// Returns the unit normal at each vertex: the mean of its triangles' normals, weighted by their angles there, which
/// does not depend on how a flat part is triangulated.
Points vertex_normals(const TriMesh& surface) {
  Points normals(surface.vertices.size(), Vec3::Zero());
  for (const Triangle& triangle : surface.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3& p = vertex(surface.vertices, triangle[c]);
      const Vec3 u = vertex(surface.vertices, triangle[(c + 1) % 3]) - p;
      const Vec3 v = vertex(surface.vertices, triangle[(c + 2) % 3]) - p;
      const Vec3 cross = u.cross(v);
      normals[triangle[c].index()] += std::atan2(cross.norm(), u.dot(v)) * cross.stableNormalized();
    }
  }
  for (Vec3& n : normals) n = n.stableNormalized();
  return normals;
}

struct Sample {
  Vec3 on_triangle;
  Vec3 position;  // on the curved surface through the triangle's vertices
  Vec3 normal;
  double area_mm2;
  bool is_visible = false;
};

/// A triangle as a piece of a curved surface: its corners, and the surface's normals there. At a crease, the normal is
/// the triangle's own, so the piece stays flat.
struct CurvedTriangle {
  std::array<Vec3, 3> corners;
  std::array<Vec3, 3> normals;

  /// Returns the point of the curved surface for these barycentric weights: the point of the triangle, moved half of
  /// the way towards the tangent planes at the corners ([Boubekeur2008]). Half is exact for every quadratic surface,
  /// from which a flat triangle deviates by half the planes' mean height: for example, from a sphere of radius 5 mm by
  /// 0.1 mm for edges of 2 mm.
  [[nodiscard]] Sample at(const Vec3& weights) const {
    Sample sample{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), 0.0};
    for (std::size_t c = 0; c < 3; ++c) {
      sample.on_triangle += weights[static_cast<Eigen::Index>(c)] * corners[c];
      sample.normal += weights[static_cast<Eigen::Index>(c)] * normals[c];
    }
    sample.position = sample.on_triangle;
    for (std::size_t c = 0; c < 3; ++c) {
      const double height = (sample.on_triangle - corners[c]).dot(normals[c]);
      sample.position -= 0.5 * weights[static_cast<Eigen::Index>(c)] * height * normals[c];
    }
    sample.normal.normalize();
    return sample;
  }
};

/// Returns the k-th point of a sequence that fills the unit square evenly (R2 sequence, [Roberts2018]).
Vec2 spread(std::uint64_t k) {
  constexpr double kA = 0.7548776662466927;
  constexpr double kB = 0.5698402909980532;
  const auto n = static_cast<double>(k);
  return {0.5 + kA * n - std::floor(0.5 + kA * n), 0.5 + kB * n - std::floor(0.5 + kB * n)};
}

/// Returns samples evenly spread over all triangles that face the observer; each represents `area_per_sample`. Small
/// triangles get one whenever the area since the last sample amounts to that.
std::vector<Sample> samples_of(const TriMesh& surface, const Vec3& to_observer, double least_cosine,
                               double area_per_sample) {
  const Points normals = vertex_normals(surface);
  std::vector<Sample> samples;
  double owed = 0.5;  // samples
  std::uint64_t drawn = 0;
  for (const Triangle& triangle : surface.triangles) {
    CurvedTriangle piece{.corners = corners_of(surface.vertices, triangle), .normals = {}};
    const Vec3 cross = (piece.corners[1] - piece.corners[0]).cross(piece.corners[2] - piece.corners[0]);
    const double area = 0.5 * cross.norm();
    if (!(area > 0.0) || cross.dot(to_observer) < 2.0 * area * least_cosine) continue;
    const Vec3 own = cross / (2.0 * area);
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3& normal = normals[triangle[c].index()];
      piece.normals[c] = normal.dot(own) > kCrease ? normal : own;
    }
    owed += area / area_per_sample;
    const double count = std::floor(owed);
    owed -= count;
    for (double i = 0; i < count; ++i) {
      Vec2 uv = spread(drawn++);
      if (uv.sum() > 1.0) uv = Vec2::Ones() - uv;
      Sample sample = piece.at({1.0 - uv.sum(), uv.x(), uv.y()});
      sample.area_mm2 = area_per_sample;
      samples.push_back(sample);
    }
  }
  return samples;
}

/// Takes the visible samples in a scattered order and keeps each that is no closer than `spacing` to one already kept
/// (dart throwing). Returns their indices, ascending.
std::vector<std::size_t> thinned(const std::vector<Sample>& samples, double spacing) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].is_visible) order.push_back(i);
  }
  // A multiplicative hash of the index scatters neighbours without a random engine.
  const auto scattered = [](std::size_t i) { return (static_cast<std::uint64_t>(i) + 1) * 0x9E3779B97F4A7C15ULL; };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return scattered(a) < scattered(b); });

  using Cell = std::array<std::int64_t, 3>;
  struct CellHash {
    std::size_t operator()(const Cell& c) const {
      return static_cast<std::size_t>((c[0] * 73856093) ^ (c[1] * 19349663) ^ (c[2] * 83492791));
    }
  };
  std::unordered_map<Cell, std::vector<std::size_t>, CellHash> cells;
  const auto cell_of = [spacing](const Vec3& p) {
    return Cell{static_cast<std::int64_t>(std::floor(p.x() / spacing)),
                static_cast<std::int64_t>(std::floor(p.y() / spacing)),
                static_cast<std::int64_t>(std::floor(p.z() / spacing))};
  };
  std::vector<std::size_t> kept;
  for (const std::size_t i : order) {
    const Vec3& p = samples[i].position;
    const Cell cell = cell_of(p);
    bool is_free = true;
    for (std::int64_t dz = -1; dz <= 1 && is_free; ++dz) {
      for (std::int64_t dy = -1; dy <= 1 && is_free; ++dy) {
        for (std::int64_t dx = -1; dx <= 1 && is_free; ++dx) {
          const auto found = cells.find({cell[0] + dx, cell[1] + dy, cell[2] + dz});
          if (found == cells.end()) continue;
          for (const std::size_t other : found->second) {
            is_free = is_free && (samples[other].position - p).squaredNorm() >= spacing * spacing;
          }
        }
      }
    }
    if (!is_free) continue;
    cells[cell].push_back(i);
    kept.push_back(i);
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

}  // namespace

VisibleSurface visible_surface(const TriMesh& surface, const VisibleSurfaceSettings& settings, Workers& workers) {
  INCISE_REQUIRE(!surface.triangles.empty(), "expected a surface with at least 1 triangle, found none");
  INCISE_REQUIRE(std::isfinite(settings.spacing_mm) && settings.spacing_mm > 0.0,
                 fmt::format("expected a spacing above 0 mm, found {}", settings.spacing_mm));
  INCISE_REQUIRE(settings.largest_tilt_deg > 0.0 && settings.largest_tilt_deg <= 90.0,
                 fmt::format("expected a largest tilt in (0, 90] degrees, found {}", settings.largest_tilt_deg));
  INCISE_REQUIRE(settings.approach.allFinite() && settings.approach.norm() > 0.0, "expected an approach direction");
  const Vec3 to_observer = -settings.approach.normalized();
  const double least_cosine = std::cos(units::rad_from_deg(settings.largest_tilt_deg));
  const double area_per_sample = settings.spacing_mm * settings.spacing_mm / kSamplesPerSpacing2;
  const SurfaceQuery query(surface);
  std::vector<Sample> samples = samples_of(surface, to_observer, least_cosine, area_per_sample);
  const double clearance = kClearance * bounding_box(surface.vertices).sizes().norm();
  workers.for_each(samples.size(), 256, [&](std::size_t i) {
    samples[i].is_visible = !query.first_hit(samples[i].on_triangle + clearance * to_observer, to_observer);
  });
  VisibleSurface result;
  for (const Sample& sample : samples) result.area_mm2 += sample.is_visible ? sample.area_mm2 : 0.0;
  for (const std::size_t i : thinned(samples, settings.spacing_mm)) {
    result.cloud.points.push_back(samples[i].position);
    result.cloud.normals.push_back(samples[i].normal);
  }
  return result;
}

}  // namespace incise
