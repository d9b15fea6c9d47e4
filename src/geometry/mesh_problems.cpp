#include "geometry/face_table.hpp"

#include <incise/geometry/disjoint_sets.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

using Kind = MeshProblem::Kind;

/// A tet is flat if its volume is at most this share of the cube of its longest edge: rounding could invert it.
constexpr double kFlatRatio = 1e-12;

/// Collects offenders of one kind; reports an entry if there are any.
struct Finding {
  Kind kind;
  std::size_t first = 0;
  std::size_t count = 0;

  void add(std::size_t index) {
    if (count == 0 || index < first) first = index;
    ++count;
  }
  template <class... Args>
  void report(std::vector<MeshProblem>& problems, fmt::format_string<Args...> text, Args&&... args) const {
    if (count > 0) problems.push_back({kind, first, count, fmt::format(text, std::forward<Args>(args)...)});
  }
};

bool has_valid_corners(const TetMesh& mesh, const Tet& tet) {
  return std::all_of(tet.begin(), tet.end(),
                     [&](VertexId id) { return id.is_valid() && id.index() < mesh.vertices.size(); });
}

void find_bad_tets(const TetMesh& mesh, std::vector<MeshProblem>& problems) {
  Finding inverted{Kind::InvertedTet};
  Finding flat{Kind::FlatTet};
  for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
    const std::array<Vec3, 4> p = corners_of(mesh.vertices, mesh.tets[i]);
    double longest = 0.0;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) longest = std::max(longest, (p[a] - p[b]).norm());
    }
    const double volume = signed_volume(p[0], p[1], p[2], p[3]);
    if (std::abs(volume) <= kFlatRatio * longest * longest * longest) {
      flat.add(i);
    } else if (volume < 0.0) {
      inverted.add(i);
    }
  }
  inverted.report(problems, "{} tets have a negative volume, the first is tet {}", inverted.count, inverted.first);
  flat.report(problems, "{} tets have no volume, the first is tet {}", flat.count, flat.first);
}

void find_duplicates(const TetMesh& mesh, std::vector<MeshProblem>& problems) {
  std::vector<std::pair<Tet, std::size_t>> sorted;
  sorted.reserve(mesh.tets.size());
  for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
    Tet corners = mesh.tets[i];
    std::sort(corners.begin(), corners.end());
    sorted.emplace_back(corners, i);
  }
  std::sort(sorted.begin(), sorted.end());
  Finding duplicate{Kind::DuplicateTet};
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].first == sorted[i - 1].first) duplicate.add(sorted[i].second);
  }
  duplicate.report(problems, "{} tets repeat the corners of an earlier one, the first is tet {}", duplicate.count,
                   duplicate.first);
}

void find_bad_faces(const TetMesh& mesh, std::vector<MeshProblem>& problems) {
  Finding shared{Kind::NonManifoldFace};
  DisjointSets bodies(mesh.tets.size());
  for_each_face_group(mesh.tets, mesh.vertices.size(), {}, [&](std::span<const FaceEntry> group) {
    if (group.size() > 2) shared.add(group[0].tet);
    for (std::size_t i = 1; i < group.size(); ++i) bodies.join(group[0].tet, group[i].tet);
  });
  shared.report(problems, "{} faces belong to more than two tets, the first is one of tet {}", shared.count,
                shared.first);

  Finding component{Kind::Disconnected};
  for (std::size_t i = 1; i < mesh.tets.size(); ++i) {
    if (bodies.root(i) == i) component.add(i);  // the lowest tet of each further component
  }
  component.report(problems, "the tets form {} bodies that share no face, the second begins with tet {}",
                   component.count + 1, component.first);
}

void find_unused_vertices(const TetMesh& mesh, std::vector<MeshProblem>& problems) {
  std::vector<std::uint8_t> is_used(mesh.vertices.size(), 0);
  for (const Tet& tet : mesh.tets) {
    for (const VertexId id : tet) is_used[id.index()] = 1;
  }
  Finding unused{Kind::UnusedVertex};
  for (std::size_t i = 0; i < is_used.size(); ++i) {
    if (is_used[i] == 0) unused.add(i);
  }
  unused.report(problems, "{} vertices belong to no tet, the first is vertex {}", unused.count, unused.first);
}

void find_bad_data(const TetMesh& mesh, std::vector<MeshProblem>& problems) {
  const auto check = [&](const std::map<std::string, DataArray>& arrays, std::size_t items, const char* what) {
    for (const auto& [name, array] : arrays) {
      const std::size_t expected = items * static_cast<std::size_t>(std::max(array.components, 0));
      if (array.components > 0 && array.values.size() == expected) continue;
      problems.push_back({Kind::WrongDataLength, 0, array.values.size(),
                          fmt::format("{} data '{}' holds {} numbers, expected {} x {} components", what, name,
                                      array.values.size(), items, array.components)});
      return;
    }
  };
  check(mesh.point_data, mesh.vertices.size(), "point");
  check(mesh.cell_data, mesh.tets.size(), "cell");
}

}  // namespace

std::vector<MeshProblem> find_problems(const TetMesh& mesh) {
  std::vector<MeshProblem> problems;
  if (mesh.tets.empty()) problems.push_back({Kind::NoTets, 0, 0, "the mesh has no tetrahedra"});

  Finding non_finite{Kind::NonFiniteVertex};
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!mesh.vertices[i].allFinite()) non_finite.add(i);
  }
  non_finite.report(problems, "{} vertices have a coordinate that is not a finite number, the first is vertex {}",
                    non_finite.count, non_finite.first);

  Finding out_of_range{Kind::IndexOutOfRange};
  for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
    if (!has_valid_corners(mesh, mesh.tets[i])) out_of_range.add(i);
  }
  out_of_range.report(problems, "{} tets name a vertex outside [0, {}), the first is tet {}", out_of_range.count,
                      mesh.vertices.size(), out_of_range.first);

  find_bad_data(mesh, problems);
  if (out_of_range.count > 0) return problems;  // nothing below can be read safely
  if (non_finite.count == 0) find_bad_tets(mesh, problems);
  find_duplicates(mesh, problems);
  find_bad_faces(mesh, problems);
  find_unused_vertices(mesh, problems);
  return problems;
}

}  // namespace incise
