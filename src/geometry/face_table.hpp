#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace incise {

/// One face of one tet in the table of faces: its two higher corners, ascending; the lowest corner is the row.
struct FaceEntry {
  std::uint32_t middle = 0;
  std::uint32_t highest = 0;
  std::uint32_t tet = 0;
  std::uint32_t face = 0;
  [[nodiscard]] std::size_t slot() const { return 4 * static_cast<std::size_t>(tet) + face; }
};

/// Calls visit(group) once for each distinct face of the live tets (empty span: all), with the tets that share it in
/// ascending order. Faces are put in rows by their lowest vertex and sorted within their row: O(M) for meshes of
/// bounded vertex degree.
/// @pre every corner < vertex_count.
template <class Visit>
void for_each_face_group(std::span<const Tet> tets, std::size_t vertex_count, std::span<const std::uint8_t> is_live,
                         const Visit& visit) {
  const auto sorted_face = [&](std::size_t tet, std::size_t face) {
    std::array<std::uint32_t, 3> corners{};
    std::size_t n = 0;
    for (std::size_t corner = 0; corner < 4; ++corner) {
      if (corner != face) corners[n++] = static_cast<std::uint32_t>(tets[tet][corner].value);
    }
    std::sort(corners.begin(), corners.end());
    return corners;
  };
  const auto is_counted = [&](std::size_t tet) { return is_live.empty() || is_live[tet] != 0; };

  std::vector<std::size_t> row_start(vertex_count + 1, 0);
  for (std::size_t tet = 0; tet < tets.size(); ++tet) {
    if (!is_counted(tet)) continue;
    for (std::size_t face = 0; face < 4; ++face) ++row_start[sorted_face(tet, face)[0] + 1];
  }
  for (std::size_t row = 0; row < vertex_count; ++row) row_start[row + 1] += row_start[row];
  std::vector<FaceEntry> entries(row_start[vertex_count]);
  std::vector<std::size_t> next(row_start.begin(), row_start.end() - 1);
  for (std::size_t tet = 0; tet < tets.size(); ++tet) {
    if (!is_counted(tet)) continue;
    for (std::size_t face = 0; face < 4; ++face) {
      const auto [lowest, middle, highest] = sorted_face(tet, face);
      entries[next[lowest]++] = {middle, highest, static_cast<std::uint32_t>(tet), static_cast<std::uint32_t>(face)};
    }
  }
  const auto same_face = [](const FaceEntry& a, const FaceEntry& b) {
    return a.middle == b.middle && a.highest == b.highest;
  };
  for (std::size_t row = 0; row < vertex_count; ++row) {
    const std::span<FaceEntry> faces(entries.data() + row_start[row], row_start[row + 1] - row_start[row]);
    std::sort(faces.begin(), faces.end(), [](const FaceEntry& a, const FaceEntry& b) {
      return std::tie(a.middle, a.highest, a.tet, a.face) < std::tie(b.middle, b.highest, b.tet, b.face);
    });
    for (std::size_t begin = 0; begin < faces.size();) {
      std::size_t end = begin + 1;
      while (end < faces.size() && same_face(faces[begin], faces[end])) ++end;
      visit(std::span<const FaceEntry>(faces.subspan(begin, end - begin)));
      begin = end;
    }
  }
}

}  // namespace incise
