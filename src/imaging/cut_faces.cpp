#include <incise/imaging/cut_faces.hpp>

namespace incise {
namespace {

Vec3 outward(const VolumeGrid& grid, std::int32_t side) {
  return (side % 2 == 0 ? -1.0 : 1.0) * grid.direction.col(side / 2);
}

}  // namespace

RegionFace face_of(const VolumeGrid& grid, std::int32_t side) {
  const Vec3 direction = outward(grid, side);
  Eigen::Index world = 0;
  direction.cwiseAbs().maxCoeff(&world);
  return static_cast<RegionFace>(2 * world + (direction[world] > 0.0 ? 1 : 0));
}

CutFaces::CutFaces(const Segmentation& found) : grid_(found.labels.grid) {
  if (found.cut.empty()) return;
  sides_.resize(grid_.voxel_count());
  for (const CutVoxel& cut : found.cut) {
    std::uint8_t& sides = sides_.at(static_cast<std::size_t>(cut.voxel));
    sides = static_cast<std::uint8_t>(sides | 1U << cut.side);
  }
}

unsigned CutFaces::sides_near(const Vec3& place) const {
  const Eigen::Array3i middle = grid_.index_from_world(place).array().round().cast<int>();
  unsigned near = 0;
  for (int k = middle[2] - 1; k <= middle[2] + 1; ++k)
    for (int j = middle[1] - 1; j <= middle[1] + 1; ++j)
      for (int i = middle[0] - 1; i <= middle[0] + 1; ++i) {
        if (grid_.contains(i, j, k)) near |= sides_[grid_.offset(i, j, k)];
      }
  return near;
}

std::optional<RegionFace> CutFaces::under(const std::array<Vec3, 3>& corners) const {
  if (empty()) return std::nullopt;
  const unsigned sides = sides_near(corners[0]) & sides_near(corners[1]) & sides_near(corners[2]);
  if (sides == 0) return std::nullopt;
  constexpr double kAlike = 0.5;  // skin beside a face, at a right angle to it, is the specimen's own
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).stableNormalized();
  for (std::int32_t side = 0; side < 6; ++side) {
    if ((sides & 1U << side) != 0 && normal.dot(outward(grid_, side)) >= kAlike) return face_of(grid_, side);
  }
  return std::nullopt;
}

}  // namespace incise
