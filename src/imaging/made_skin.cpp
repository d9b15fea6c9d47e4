#include <incise/imaging/made_skin.hpp>

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

MadeSkin::MadeSkin(const Segmentation& found)
    : grid_(found.labels.grid), cut_(sides_of(found.cut)), painted_(sides_of(found.painted)) {}

MadeSkin::Sides MadeSkin::sides_of(const std::vector<MadeVoxel>& voxels) const {
  Sides sides;
  if (voxels.empty()) return sides;
  sides.resize(grid_.voxel_count());
  for (const MadeVoxel& made : voxels) {
    std::uint8_t& of_voxel = sides.at(static_cast<std::size_t>(made.voxel));
    of_voxel = static_cast<std::uint8_t>(of_voxel | 1U << made.side);
  }
  return sides;
}

unsigned MadeSkin::sides_near(const Sides& sides, const Vec3& place) const {
  const Eigen::Array3i middle = grid_.index_from_world(place).array().round().cast<int>();
  unsigned near = 0;
  for (int k = middle[2] - 1; k <= middle[2] + 1; ++k)
    for (int j = middle[1] - 1; j <= middle[1] + 1; ++j)
      for (int i = middle[0] - 1; i <= middle[0] + 1; ++i) {
        if (grid_.contains(i, j, k)) near |= sides[grid_.offset(i, j, k)];
      }
  return near;
}

std::optional<std::int32_t> MadeSkin::side_at(const Sides& sides, const Vec3& place, const Vec3& normal) const {
  if (sides.empty()) return std::nullopt;
  constexpr double kAlike = 0.5;  // cosine; skin at a right angle to a cut face is natural
  const unsigned near = sides_near(sides, place);
  for (std::int32_t side = 0; side < 6; ++side) {
    if ((near & 1U << side) != 0 && normal.dot(outward(grid_, side)) >= kAlike) return side;
  }
  return std::nullopt;
}

std::optional<RegionFace> MadeSkin::cut_at(const Vec3& place, const Vec3& normal) const {
  const std::optional<std::int32_t> side = side_at(cut_, place, normal);
  return side ? std::optional(face_of(grid_, *side)) : std::nullopt;
}

bool MadeSkin::is_painted(const Vec3& place, const Vec3& normal) const {
  return side_at(painted_, place, normal).has_value();
}

}  // namespace incise
