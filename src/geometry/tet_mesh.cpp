#include "geometry/face_table.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <fmt/format.h>

#include <utility>

namespace incise {

double signed_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return (b - a).cross(c - a).dot(d - a) / 6.0;
}

double volume_mm3(const TetMesh& mesh) {
  double volume = 0.0;
  for (const Tet& tet : mesh.tets) {
    const auto [a, b, c, d] = corners_of(mesh.vertices, tet);
    volume += signed_volume(a, b, c, d);
  }
  return volume;
}

double enclosed_volume_mm3(const TriMesh& surface) {
  if (surface.triangles.empty()) return 0.0;
  // The tets' common apex is a point of the surface, so a body far from the origin loses no digits.
  const Vec3 apex = vertex(surface.vertices, surface.triangles[0][0]);
  double volume = 0.0;
  for (const Triangle& t : surface.triangles) {
    const auto [a, b, c] = corners_of(surface.vertices, t);
    volume += signed_volume(apex, a, b, c);
  }
  return volume;
}

Triangle face_of(const Tet& tet, int face) {
  //        d
  //       /|\        Seen from outside, counter-clockwise:
  //      / | \         opposite a: b c d
  //     a--|--c        opposite b: a d c
  //      \ | /         opposite c: a b d
  //        b           opposite d: a c b
  constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  INCISE_REQUIRE(face >= 0 && face < 4, fmt::format("expected a face 0, 1, 2 or 3, found {}", face));
  const auto& [first, second, third] = kFaces[static_cast<std::size_t>(face)];
  return {tet[first], tet[second], tet[third]};
}

std::vector<std::array<std::int32_t, 4>> face_neighbours(const TetMesh& mesh) {
  std::vector<std::array<std::int32_t, 4>> neighbours(mesh.tets.size(), {-1, -1, -1, -1});
  for_each_face_group(mesh.tets, mesh.vertices.size(), {}, [&](std::span<const FaceEntry> group) {
    for (std::size_t i = 1; i < group.size(); ++i) {
      const FaceEntry& a = group[i - 1];
      const FaceEntry& b = group[i];
      neighbours[a.tet][a.face] = static_cast<std::int32_t>(b.tet);
      neighbours[b.tet][b.face] = static_cast<std::int32_t>(a.tet);
    }
  });
  return neighbours;
}

std::vector<BoundaryFace> boundary_faces(const TetMesh& mesh, std::span<const std::uint8_t> is_live) {
  INCISE_REQUIRE(is_live.empty() || is_live.size() == mesh.tets.size(),
                 fmt::format("expected a flag for each of {} tets, found {}", mesh.tets.size(), is_live.size()));
  std::vector<std::uint8_t> is_single(4 * mesh.tets.size(), 0);
  for_each_face_group(mesh.tets, mesh.vertices.size(), is_live, [&](std::span<const FaceEntry> group) {
    if (group.size() == 1) is_single[group[0].slot()] = 1;
  });
  std::vector<BoundaryFace> faces;
  for (std::size_t slot = 0; slot < is_single.size(); ++slot) {
    if (is_single[slot] == 0) continue;
    faces.push_back({face_of(mesh.tets[slot / 4], static_cast<int>(slot % 4)), TetId{slot / 4}});
  }
  return faces;
}

std::vector<std::uint8_t> skin_faces(const TetMesh& mesh) {
  std::vector<std::uint8_t> faces(mesh.tets.size(), 0);
  for_each_face_group(mesh.tets, mesh.vertices.size(), {}, [&](std::span<const FaceEntry> group) {
    std::uint8_t& of_tet = faces[group[0].slot() / 4];
    if (group.size() == 1) of_tet = static_cast<std::uint8_t>(of_tet | 1U << group[0].slot() % 4);
  });
  return faces;
}

TriMesh boundary_surface(const TetMesh& mesh) {
  TriMesh surface;
  surface.vertices = mesh.vertices;
  for (const BoundaryFace& face : boundary_faces(mesh)) surface.triangles.push_back(face.corners);
  return surface;
}

Box3 bounding_box(std::span<const Vec3> points) {
  INCISE_REQUIRE(!points.empty(), "expected at least 1 point, found none");
  Box3 box;
  for (const Vec3& p : points) box.extend(p);
  return box;
}

TetMesh make_block(const Vec3& size_mm, std::array<int, 3> cells) {
  INCISE_REQUIRE(size_mm.allFinite() && size_mm.minCoeff() > 0.0, "expected a finite size above 0 along each axis");
  INCISE_REQUIRE(
      cells[0] > 0 && cells[1] > 0 && cells[2] > 0,
      fmt::format("expected at least 1 cell along each axis, found {} x {} x {}", cells[0], cells[1], cells[2]));
  const auto id = [&](const std::array<int, 3>& at) {
    return VertexId{static_cast<std::size_t>(at[0]) +
                    static_cast<std::size_t>(cells[0] + 1) *
                        (static_cast<std::size_t>(at[1]) +
                         static_cast<std::size_t>(cells[1] + 1) * static_cast<std::size_t>(at[2]))};
  };
  TetMesh mesh;
  for (int k = 0; k <= cells[2]; ++k) {
    for (int j = 0; j <= cells[1]; ++j) {
      for (int i = 0; i <= cells[0]; ++i) {
        mesh.vertices.push_back(size_mm.cwiseProduct(Vec3(i, j, k)).cwiseQuotient(Vec3(cells[0], cells[1], cells[2])));
      }
    }
  }
  // Each order of the axes gives one tet: a walk along the cell's edges from its lowest to its highest corner.
  constexpr std::array<std::array<int, 3>, 6> kWalks{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  for (int k = 0; k < cells[2]; ++k) {
    for (int j = 0; j < cells[1]; ++j) {
      for (int i = 0; i < cells[0]; ++i) {
        for (std::size_t walk = 0; walk < kWalks.size(); ++walk) {
          std::array<int, 3> at{i, j, k};
          Tet tet;
          tet[0] = id(at);
          for (std::size_t step = 0; step < 3; ++step) {
            ++at[static_cast<std::size_t>(kWalks[walk][step])];
            tet[step + 1] = id(at);
          }
          if (walk >= 3) std::swap(tet[2], tet[3]);  // odd orders of the axes have the opposite orientation
          mesh.tets.push_back(tet);
        }
      }
    }
  }
  return mesh;
}

}  // namespace incise
