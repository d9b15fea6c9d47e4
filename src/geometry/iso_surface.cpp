#include <incise/core/error.hpp>
#include <incise/geometry/iso_surface.hpp>

#include <cmath>

namespace incise {
namespace {

/// The cells between voxel centres, and one layer of cells around the volume.
class SurfaceNets {
 public:
  SurfaceNets(const GrayVolume& volume, double level) : volume_(volume), level_(level) {
    for (std::size_t a = 0; a < 3; ++a) cells_[a] = volume.grid.size[a] + 1;
  }

  TriMesh make() {
    vertex_of_.assign(layer_size() * 2, VertexId{});
    for (int k = 0; k < cells_[2]; ++k) {
      for (int j = 0; j < cells_[1]; ++j) {
        for (int i = 0; i < cells_[0]; ++i) visit({i, j, k});
      }
    }
    return std::move(surface_);
  }

 private:
  using Cell = std::array<int, 3>;

  [[nodiscard]] std::size_t layer_size() const {
    return static_cast<std::size_t>(cells_[0]) * static_cast<std::size_t>(cells_[1]);
  }
  /// Only two layers of cells are kept: quadrilaterals join cells of one layer, or of it and the layer before.
  [[nodiscard]] VertexId& vertex_of(const Cell& c) {
    const auto layer = static_cast<std::size_t>(c[2] % 2);
    return vertex_of_[layer * layer_size() + static_cast<std::size_t>(c[1]) * static_cast<std::size_t>(cells_[0]) +
                      static_cast<std::size_t>(c[0])];
  }
  /// Returns the value minus the level at a voxel's centre; -1 beyond the volume.
  [[nodiscard]] double height(const Cell& voxel) const {
    if (!volume_.grid.contains(voxel[0], voxel[1], voxel[2])) return -1.0;
    return static_cast<double>(volume_.at(voxel[0], voxel[1], voxel[2])) - level_;
  }

  void visit(const Cell& cell) {
    std::array<double, 8> heights;
    bool has_inside = false, has_outside = false;
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const int c = static_cast<int>(corner);
      heights[corner] = height({cell[0] - 1 + (c & 1), cell[1] - 1 + (c >> 1 & 1), cell[2] - 1 + (c >> 2 & 1)});
      (heights[corner] >= 0.0 ? has_inside : has_outside) = true;
    }
    if (!has_inside || !has_outside) return;
    vertex_of(cell) = VertexId(surface_.vertices.size());
    surface_.vertices.push_back(mean_crossing(cell, heights));
    for (std::size_t axis = 0; axis < 3; ++axis) join_around(cell, axis, heights);
  }

  [[nodiscard]] Vec3 mean_crossing(const Cell& cell, const std::array<double, 8>& heights) const {
    Vec3 sum = Vec3::Zero();
    int crossings = 0;
    for (std::size_t low = 0; low < 8; ++low) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t high = low | std::size_t{1} << axis;
        if (high == low || (heights[low] >= 0.0) == (heights[high] >= 0.0)) continue;
        Vec3 at(static_cast<double>(low & 1), static_cast<double>(low >> 1 & 1), static_cast<double>(low >> 2 & 1));
        at[static_cast<Eigen::Index>(axis)] = heights[low] / (heights[low] - heights[high]);
        sum += at;
        ++crossings;
      }
    }
    const Vec3 index = Vec3(cell[0] - 1, cell[1] - 1, cell[2] - 1) + sum / crossings;
    return volume_.grid.world_from_index(index);
  }

  /// Adds the quadrilateral across the edge from the cell's first corner along an axis, if the surface crosses it. The
  /// four cells around the edge have all been visited.
  void join_around(const Cell& cell, std::size_t axis, const std::array<double, 8>& heights) {
    const bool is_inside = heights[0] >= 0.0;
    if (is_inside == (heights[std::size_t{1} << axis] >= 0.0)) return;
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    Cell left = cell, below = cell, diagonal = cell;
    --left[u], --below[v], --diagonal[u], --diagonal[v];
    const std::array<VertexId, 4> corners{vertex_of(diagonal), vertex_of(below), vertex_of(cell), vertex_of(left)};
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
      if (is_inside)
        surface_.triangles.push_back({corners[a], corners[b], corners[c]});
      else
        surface_.triangles.push_back({corners[a], corners[c], corners[b]});
    };
    add(0, 1, 2);
    add(0, 2, 3);
  }

  const GrayVolume& volume_;
  const double level_;
  Cell cells_{};
  std::vector<VertexId> vertex_of_;
  TriMesh surface_;
};

}  // namespace

TriMesh iso_surface(const GrayVolume& volume, double level) {
  INCISE_REQUIRE(std::isfinite(level), "expected a finite level");
  for (const float value : volume.voxels) {
    if (!std::isfinite(value)) throw InvalidArgument("iso_surface", "expected finite values");
  }
  TriMesh surface = SurfaceNets(volume, level).make();
  if (volume.grid.direction.determinant() < 0.0) {
    for (Triangle& t : surface.triangles) std::swap(t[1], t[2]);
  }
  return surface;
}

}  // namespace incise
