#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/meshing/quality.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

namespace incise {
namespace {

using Edge = std::pair<VertexId, VertexId>;

constexpr std::array<std::array<std::size_t, 2>, 6> kTetEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

using Corners = std::array<Vec3, 4>;

/// Returns the normals of the faces opposite each corner, of length twice the face's area; outward for a positive tet.
std::array<Vec3, 4> area_normals(const Corners& c) {
  return {(c[3] - c[1]).cross(c[2] - c[1]), (c[2] - c[0]).cross(c[3] - c[0]), (c[3] - c[0]).cross(c[1] - c[0]),
          (c[1] - c[0]).cross(c[2] - c[0])};
}

/// Returns 3 r / R from the volume, the areas of the faces and the products of opposite edges (Crelle's formula for R).
double radius_ratio(const Corners& c, const std::array<Vec3, 4>& normals, double volume) {
  double twice_area = 0.0;
  for (const Vec3& n : normals) twice_area += n.norm();
  const double p = (c[0] - c[1]).norm() * (c[2] - c[3]).norm();
  const double q = (c[0] - c[2]).norm() * (c[1] - c[3]).norm();
  const double r = (c[0] - c[3]).norm() * (c[1] - c[2]).norm();
  const double under_root = (p + q + r) * (p + q - r) * (p - q + r) * (-p + q + r);
  if (!(under_root > 0.0) || !(volume > 0.0)) return 0.0;
  const double inscribed = 6.0 * volume / twice_area;
  const double circumscribed = std::sqrt(under_root) / (24.0 * volume);
  return 3.0 * inscribed / circumscribed;
}

double dihedral_deg(const Vec3& n, const Vec3& m) {
  return 180.0 - units::deg_from_rad(std::atan2(n.cross(m).norm(), n.dot(m)));
}

void require_usable(const TetMesh& mesh) {
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    INCISE_REQUIRE(mesh.vertices[v].allFinite(), fmt::format("vertex {} is not finite", v));
  }
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (const VertexId id : mesh.tets[t]) {
      INCISE_REQUIRE(id.is_valid() && id.index() < mesh.vertices.size(),
                     fmt::format("tet {}: found vertex index {}, expected 0 to {}", t, id.value,
                                 static_cast<std::ptrdiff_t>(mesh.vertices.size()) - 1));
    }
  }
}

std::vector<Edge> edges_of(const TetMesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(6 * mesh.tets.size());
  for (const Tet& tet : mesh.tets) {
    for (const auto& [a, b] : kTetEdges) edges.push_back(std::minmax(tet[a], tet[b]));
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

EdgeStatistics statistics_of(const TetMesh& mesh, const std::function<bool(const Vec3&)>* accepts_midpoint) {
  EdgeStatistics result;
  double sum_mm = 0.0;
  double min_mm = std::numeric_limits<double>::infinity();
  for (const auto& [from, to] : edges_of(mesh)) {
    const Vec3& a = vertex(mesh.vertices, from);
    const Vec3& b = vertex(mesh.vertices, to);
    if (accepts_midpoint != nullptr && !(*accepts_midpoint)(0.5 * (a + b))) continue;
    const double edge_mm = (b - a).norm();
    sum_mm += edge_mm;
    min_mm = std::min(min_mm, edge_mm);
    result.max_mm = std::max(result.max_mm, edge_mm);
    ++result.count;
  }
  if (result.count > 0) {
    result.min_mm = min_mm;
    result.mean_mm = sum_mm / static_cast<double>(result.count);
  }
  return result;
}

void add_angles(MeshQuality& quality, const std::array<Vec3, 4>& normals) {
  for (const auto& [a, b] : kTetEdges) {
    const double angle = dihedral_deg(normals[a], normals[b]);
    quality.min_dihedral_deg = std::min(quality.min_dihedral_deg, angle);
    quality.max_dihedral_deg = std::max(quality.max_dihedral_deg, angle);
    const auto bin = static_cast<std::size_t>(angle / MeshQuality::kBinWidthDeg);
    ++quality.dihedral_histogram[std::min(bin, quality.dihedral_histogram.size() - 1)];
  }
}

}  // namespace

MeshQuality quality_of(const TetMesh& mesh) {
  require_usable(mesh);
  MeshQuality quality;
  quality.tets = mesh.tets.size();
  quality.vertices = mesh.vertices.size();
  if (mesh.tets.empty()) return quality;

  quality.min_dihedral_deg = 180.0;
  quality.min_radius_ratio = std::numeric_limits<double>::infinity();
  quality.smallest_tet_mm3 = std::numeric_limits<double>::infinity();
  double ratio_sum = 0.0;
  for (const Tet& tet : mesh.tets) {
    const Corners c = corners_of(mesh.vertices, tet);
    const double volume = signed_volume(c[0], c[1], c[2], c[3]);
    const std::array<Vec3, 4> normals = area_normals(c);
    const double ratio = radius_ratio(c, normals, volume);
    add_angles(quality, normals);
    quality.volume_mm3 += volume;
    quality.smallest_tet_mm3 = std::min(quality.smallest_tet_mm3, volume);
    quality.min_radius_ratio = std::min(quality.min_radius_ratio, ratio);
    ratio_sum += ratio;
  }
  quality.mean_radius_ratio = ratio_sum / static_cast<double>(mesh.tets.size());
  quality.edges = statistics_of(mesh, nullptr);
  return quality;
}

EdgeStatistics edges_where(const TetMesh& mesh, const std::function<bool(const Vec3&)>& accepts_midpoint) {
  require_usable(mesh);
  return statistics_of(mesh, &accepts_midpoint);
}

std::string to_text(const MeshQuality& quality) {
  constexpr std::size_t kBarWidth = 48;
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "tetrahedra         {:>12}\nvertices           {:>12}\n", quality.tets, quality.vertices);
  fmt::format_to(out, "volume             {:>12.1f} mm3\n", quality.volume_mm3);
  fmt::format_to(out, "smallest tet       {:>12.3g} mm3\n", quality.smallest_tet_mm3);
  fmt::format_to(out, "dihedral angle     {:>12.1f} to {:.1f} deg\n", quality.min_dihedral_deg,
                 quality.max_dihedral_deg);
  fmt::format_to(out, "radius ratio       {:>12.3f} min, {:.3f} mean (1 = regular)\n", quality.min_radius_ratio,
                 quality.mean_radius_ratio);
  fmt::format_to(out, "edge length        {:>12.2f} to {:.2f} mm, mean {:.2f} mm, {} edges\n", quality.edges.min_mm,
                 quality.edges.max_mm, quality.edges.mean_mm, quality.edges.count);
  fmt::format_to(out, "dihedral angles, six per tetrahedron\n");
  const std::size_t most = *std::max_element(quality.dihedral_histogram.begin(), quality.dihedral_histogram.end());
  for (std::size_t bin = 0; bin < quality.dihedral_histogram.size(); ++bin) {
    const std::size_t count = quality.dihedral_histogram[bin];
    const std::size_t length = most == 0 ? 0 : (count * kBarWidth + most - 1) / most;  // a single angle still shows
    fmt::format_to(out, "{:>4} - {:>3} deg {:>10} {}\n", bin * MeshQuality::kBinWidthDeg,
                   (bin + 1) * MeshQuality::kBinWidthDeg, count, std::string(length, '#'));
  }
  return text;
}

}  // namespace incise
