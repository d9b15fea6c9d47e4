#include <incise/core/error.hpp>
#include <incise/io/surface_io.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise {
namespace {

using Kind = SurfaceProblem::Kind;

/// One side of a triangle, with its smaller vertex first.
struct Side {
  std::size_t low, high;
  bool is_forward;  ///< the triangle runs from low to high
  auto operator<=>(const Side&) const = default;
};

/// Counts the places of one kind of problem and keeps the first.
struct Tally {
  std::array<std::size_t, 2> first{0, 0};
  std::size_t count = 0;
  void add(std::size_t a, std::size_t b) {
    if (count++ == 0) first = {a, b};
  }
};

void report(std::vector<SurfaceProblem>& problems, Kind kind, const Tally& tally, const std::string& text) {
  if (tally.count > 0) problems.push_back({kind, tally.first, tally.count, text});
}

std::string edge_text(const char* what, const Tally& tally) {
  return fmt::format("{} at {} edge{}, the first from vertex {} to {}", what, tally.count, tally.count == 1 ? "" : "s",
                     tally.first[0], tally.first[1]);
}

void find_edge_problems(const TriMesh& surface, std::vector<SurfaceProblem>& problems) {
  std::vector<Side> sides;
  sides.reserve(3 * surface.triangles.size());
  for (const Triangle& triangle : surface.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = triangle[k].index(), b = triangle[(k + 1) % 3].index();
      if (a != b) sides.push_back({std::min(a, b), std::max(a, b), a < b});
    }
  }
  std::sort(sides.begin(), sides.end());
  Tally non_manifold, open, inconsistent;
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
    const std::size_t around = end - i;
    if (around > 2) non_manifold.add(sides[i].low, sides[i].high);
    if (around == 1) open.add(sides[i].low, sides[i].high);
    if (around == 2 && sides[i].is_forward == sides[i + 1].is_forward) inconsistent.add(sides[i].low, sides[i].high);
  }
  report(problems, Kind::NonManifoldEdge, non_manifold,
         edge_text("more than two triangles meet (non-manifold)", non_manifold));
  report(problems, Kind::OpenBoundary, open, edge_text("an open boundary (one triangle only)", open));
  report(problems, Kind::InconsistentOrientation, inconsistent,
         edge_text("neighbouring triangles of opposite orientation", inconsistent));
}

}  // namespace

std::vector<SurfaceProblem> find_surface_problems(const TriMesh& surface) {
  std::vector<SurfaceProblem> problems;
  if (surface.triangles.empty()) return {{Kind::NoTriangles, {0, 0}, 0, "no triangles"}};
  Tally not_finite, out_of_range, degenerate;
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    if (!surface.vertices[i].allFinite()) not_finite.add(i, i);
  }
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const auto& [a, b, c] = surface.triangles[i];
    for (const VertexId id : {a, b, c}) {
      if (!id.is_valid() || id.index() >= surface.vertices.size()) {
        out_of_range.add(i, i);
        break;
      }
    }
    if (a == b || b == c || c == a) degenerate.add(i, i);
  }
  report(
      problems, Kind::NonFiniteVertex, not_finite,
      fmt::format("not-a-number coordinates at {} vertices, the first is {}", not_finite.count, not_finite.first[0]));
  report(problems, Kind::IndexOutOfRange, out_of_range,
         fmt::format("a missing vertex in {} triangles, the first is {}", out_of_range.count, out_of_range.first[0]));
  if (!problems.empty()) return problems;
  report(problems, Kind::DegenerateTriangle, degenerate,
         fmt::format("a corner twice in {} triangles, the first is {}", degenerate.count, degenerate.first[0]));
  find_edge_problems(surface, problems);
  if (problems.empty() && enclosed_volume_mm3(surface) <= 0.0) {
    problems.push_back(
        {Kind::InsideOut, {0, 0}, surface.triangles.size(), "normals that point inwards (negative enclosed volume)"});
  }
  return problems;
}

void require_closed_manifold(const TriMesh& surface, const std::filesystem::path& path) {
  const auto problems = find_surface_problems(surface);
  if (!problems.empty()) throw DataError(path, "surface", problems.front().text, "a closed, outward oriented surface");
}

}  // namespace incise
