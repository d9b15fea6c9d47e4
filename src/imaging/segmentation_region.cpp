#include "imaging/segmentation_region.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/contour.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

constexpr const char* kWhere = "segmentation";

std::string text_of(const Vec3& p) {
  return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", p.x(), p.y(), p.z());
}
std::string text_of(const Box3& box) {
  return fmt::format("[{}, {}]", text_of(box.min()), text_of(box.max()));
}

// Returns the box of the volume's voxel centres in world coordinates (larger than the volume if its axes are oblique).
Box3 extent_of(const VolumeGrid& grid) {
  Box3 box;
  for (int corner = 0; corner < 8; ++corner)
    box.extend(grid.world_from_index({(corner & 1) != 0 ? grid.size[0] - 1.0 : 0.0,
                                      (corner & 2) != 0 ? grid.size[1] - 1.0 : 0.0,
                                      (corner & 4) != 0 ? grid.size[2] - 1.0 : 0.0}));
  return box;
}

// Returns the indices of the voxels whose centres can lie in the box.
IndexBox index_box(const VolumeGrid& grid, const std::optional<Box3>& roi_mm) {
  IndexBox box{{0, 0, 0}, grid.size};
  if (!roi_mm) return box;
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 index = grid.index_from_world(roi_mm->corner(static_cast<Box3::CornerType>(corner)));
    low = low.cwiseMin(index);
    high = high.cwiseMax(index);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    const double last = grid.size[axis] - 1.0;
    box.low[axis] = static_cast<int>(std::ceil(std::clamp(low[a] - 1e-9, 0.0, last + 1.0)));
    box.high[axis] = static_cast<int>(std::floor(std::clamp(high[a] + 1e-9, -1.0, last))) + 1;
  }
  return box;
}

bool is_empty(const IndexBox& box) {
  return box.low[0] >= box.high[0] || box.low[1] >= box.high[1] || box.low[2] >= box.high[2];
}

void fill_working_volume(const CtVolume& ct, const SegmentationSettings& settings, const IndexBox& box,
                         const std::array<int, 3>& low, WorkingVolume& work) {
  const VolumeGrid& grid = work.hu.grid;
  for (int k = 0; k < grid.size[2]; ++k)
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i < grid.size[0]; ++i) {
        const std::array<int, 3> at{i + low[0], j + low[1], k + low[2]};
        if (!ct.grid.contains(at[0], at[1], at[2])) continue;
        const std::size_t v = grid.offset(i, j, k);
        const std::int16_t hu = ct.at(at[0], at[1], at[2]);
        work.hu.voxels[v] = hu;
        const bool is_tissue = hu >= settings.window_low_hu && hu <= settings.window_high_hu;
        work.tissue.voxels[v] = is_tissue ? 1 : 0;
        bool inside = true;
        for (std::size_t axis = 0; axis < 3; ++axis)
          inside = inside && at[axis] >= box.low[axis] && at[axis] < box.high[axis];
        inside = inside && is_in_roi(settings.roi_box_mm, grid.world_from_index(Vec3(i, j, k)));
        work.region.voxels[v] = inside ? 1 : 0;
        work.in_window.voxels[v] = inside && is_tissue ? 1 : 0;
      }
}

/// Applies one piece of a stroke. An added voxel outside the window gets the window's middle value; a removed voxel
/// keeps its own, as does one beyond the region. @param piece  of the stroke's path: one or two points.
void paint(const Contour& piece, const TissueEdit& edit, const SegmentationSettings& settings, WorkingVolume& work) {
  const VolumeGrid& grid = work.hu.grid;
  const double middle_hu = 0.5 * (settings.window_low_hu + settings.window_high_hu);
  Box3 around;
  for (const Vec3& p : piece.points) around.extend(p);
  around.min().array() -= edit.radius_mm;
  around.max().array() += edit.radius_mm;
  const IndexBox box = index_box(grid, around);
  for (int k = box.low[2]; k < box.high[2]; ++k)
    for (int j = box.low[1]; j < box.high[1]; ++j)
      for (int i = box.low[0]; i < box.high[0]; ++i) {
        const std::size_t v = grid.offset(i, j, k);
        if (nearest_on(piece, grid.world_from_index(Vec3(i, j, k))).distance_mm > edit.radius_mm) continue;
        work.tissue.voxels[v] = edit.is_tissue ? 1 : 0;
        if (work.region.voxels[v] == 0) continue;
        work.in_window.voxels[v] = edit.is_tissue ? 1 : 0;
        std::int16_t& hu = work.hu.voxels[v];
        const bool is_odd = hu < settings.window_low_hu || hu > settings.window_high_hu;
        if (edit.is_tissue && is_odd) hu = static_cast<std::int16_t>(std::lround(middle_hu));
      }
}

void apply_edits(const SegmentationSettings& settings, WorkingVolume& work, Monitor& monitor) {
  if (!settings.edits) return;
  work.unedited = work.in_window.voxels;
  for (const TissueEdit& edit : *settings.edits) {
    const Points& path = edit.path_mm;
    paint({{path.front()}, false}, edit, settings, work);
    for (std::size_t i = 1; i < path.size(); ++i) {
      throw_if_cancelled(monitor, "segmenting");
      paint({{path[i - 1], path[i]}, false}, edit, settings, work);
    }
  }
}

void require_tissue(const WorkingVolume& work, const SegmentationSettings& settings) {
  if (std::find(work.in_window.voxels.begin(), work.in_window.voxels.end(), 1) != work.in_window.voxels.end()) return;
  std::int16_t least = std::numeric_limits<std::int16_t>::max();
  std::int16_t greatest = std::numeric_limits<std::int16_t>::min();
  for (std::size_t v = 0; v < work.region.voxels.size(); ++v) {
    if (work.region.voxels[v] == 0) continue;
    least = std::min(least, work.hu.voxels[v]);
    greatest = std::max(greatest, work.hu.voxels[v]);
  }
  if (least > greatest)
    throw CaseError(kWhere, "roi_box_mm", "a region between voxel centres, without a voxel",
                    "a region of at least one voxel");
  throw CaseError(kWhere, "window_hu",
                  fmt::format("no voxel with HU in [{:g}, {:g}]", settings.window_low_hu, settings.window_high_hu),
                  "tissue in the window", fmt::format("The region holds {} to {} HU", least, greatest));
}

using Place = std::array<int, 3>;

Place step_towards(std::int32_t side) {
  Place step{};
  step.at(static_cast<std::size_t>(side / 2)) = side % 2 == 0 ? -1 : 1;
  return step;
}

Place moved(const Place& from, const Place& step, int times = 1) {
  return {from[0] + times * step[0], from[1] + times * step[1], from[2] + times * step[2]};
}

bool is_in(const Mask& mask, const Place& at) {
  return mask.grid.contains(at[0], at[1], at[2]) && mask.at(at[0], at[1], at[2]) != 0;
}

int voxels_within(double length_mm, const VolumeGrid& grid, std::int32_t side) {
  return static_cast<int>(std::ceil(length_mm / grid.spacing_mm[side / 2]));
}

/// Returns whether tissue continues in the 3 x 3 voxels round `beyond`, across the axis of `side`.
bool goes_on(const WorkingVolume& work, const VolumeGrid& scan, const Place& first, const Place& beyond,
             std::int32_t side) {
  constexpr int kLeast = 4;  // of 9: noise gives fewer, the rim of a cut more
  const auto one = static_cast<std::size_t>((side / 2 + 1) % 3), other = static_cast<std::size_t>((side / 2 + 2) % 3);
  int count = 0;
  for (int a = -1; a <= 1; ++a)
    for (int b = -1; b <= 1; ++b) {
      Place at = beyond;
      at[one] += a;
      at[other] += b;
      const bool is_outside = !scan.contains(at[0] + first[0], at[1] + first[1], at[2] + first[2]);
      if (is_outside || (!is_in(work.region, at) && is_in(work.tissue, at))) ++count;
    }
  return count >= kLeast;
}

/// Returns the body's voxels that lie straight inwards from an artificial side, with only tissue between.
/// @param is_made  (voxel, the voxel beyond its side, side) -> whether this side is artificial
template <class IsMade>
std::vector<MadeVoxel> find_made(const Mask& body, const WorkingVolume& work, double opening_mm,
                                 const IsMade& is_made) {
  const VolumeGrid& grid = body.grid;
  std::vector<MadeVoxel> made;
  for (std::size_t v = 0; v < body.voxels.size(); ++v) {
    if (body.voxels[v] == 0 && work.in_window.voxels[v] == 0) continue;
    const Place at = grid.voxel_at(v);
    for (std::int32_t side = 0; side < 6; ++side) {
      const Place step = step_towards(side);
      if (!is_made(at, moved(at, step), side)) continue;
      Place inwards = at;
      for (int left = voxels_within(opening_mm, grid, side); left > 0 && !is_in(body, inwards); --left) {
        if (!is_in(work.in_window, inwards)) break;
        inwards = moved(inwards, step, -1);
      }
      if (is_in(body, inwards))
        made.push_back({static_cast<std::int32_t>(grid.offset(inwards[0], inwards[1], inwards[2])), side});
    }
  }
  return made;
}

}  // namespace

bool is_in_roi(const std::optional<Box3>& roi_mm, const Vec3& p) {
  constexpr double kRoundingMm = 1e-6;
  return !roi_mm || ((p.array() >= roi_mm->min().array() - kRoundingMm).all() &&
                     (p.array() <= roi_mm->max().array() + kRoundingMm).all());
}

VolumeGrid sub_grid(const VolumeGrid& grid, const std::array<int, 3>& low, const std::array<int, 3>& size) {
  VolumeGrid part = grid;
  part.size = size;
  part.origin_mm = grid.world_from_index(Vec3(low[0], low[1], low[2]));
  return part;
}

WorkingVolume cut_out(const CtVolume& ct, const SegmentationSettings& settings, int pad, std::int16_t beyond,
                      Monitor& monitor) {
  const IndexBox box = index_box(ct.grid, settings.roi_box_mm);
  if (is_empty(box))
    throw CaseError(kWhere, "roi_box_mm", text_of(*settings.roi_box_mm),
                    fmt::format("a box that meets the volume, {} mm", text_of(extent_of(ct.grid))));
  std::array<int, 3> low{};
  std::array<int, 3> size{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = box.low[axis] - pad;
    size[axis] = box.high[axis] - box.low[axis] + 2 * pad;
  }
  const VolumeGrid grid = sub_grid(ct.grid, low, size);
  WorkingVolume work{{grid, std::vector<std::int16_t>(grid.voxel_count(), beyond)},
                     {grid, std::vector<std::uint8_t>(grid.voxel_count(), 0)},
                     {grid, std::vector<std::uint8_t>(grid.voxel_count(), 0)},
                     {grid, std::vector<std::uint8_t>(grid.voxel_count(), 0)},
                     {}};
  fill_working_volume(ct, settings, box, low, work);
  apply_edits(settings, work, monitor);
  require_tissue(work, settings);
  return work;
}

std::vector<std::size_t> locate_seeds(const CtVolume& ct, const WorkingVolume& work,
                                      const SegmentationSettings& settings) {
  std::vector<std::size_t> offsets;
  for (std::size_t s = 0; s < settings.seeds_mm.size(); ++s) {
    const Vec3& seed = settings.seeds_mm[s];
    const std::string field = fmt::format("seed_mm[{}]", s);
    const Eigen::Array3d in_ct = ct.grid.index_from_world(seed).array().round();
    const Eigen::Array3d count(ct.grid.size[0], ct.grid.size[1], ct.grid.size[2]);
    if (!((in_ct >= 0.0).all() && (in_ct < count).all()))
      throw CaseError(kWhere, field, text_of(seed),
                      fmt::format("a point inside the volume, {} mm", text_of(extent_of(ct.grid))));
    const Eigen::Array3i at = work.hu.grid.index_from_world(seed).array().round().cast<int>();
    if (!work.region.grid.contains(at[0], at[1], at[2]) || work.region.at(at[0], at[1], at[2]) == 0)
      throw CaseError(
          kWhere, field, text_of(seed),
          fmt::format("a point inside roi_box_mm {}", settings.roi_box_mm ? text_of(*settings.roi_box_mm) : ""));
    if (work.in_window.at(at[0], at[1], at[2]) == 0) {
      const std::int16_t hu = work.hu.at(at[0], at[1], at[2]);
      const bool is_tissue = hu >= settings.window_low_hu && hu <= settings.window_high_hu;
      throw CaseError(
          kWhere, field, fmt::format("{} with {} HU", text_of(seed), hu),
          is_tissue ? std::string("a point that no stroke of `edits` removes")
                    : fmt::format("tissue in window_hu [{:g}, {:g}]", settings.window_low_hu, settings.window_high_hu));
    }
    offsets.push_back(work.hu.grid.offset(at[0], at[1], at[2]));
  }
  return offsets;
}

std::vector<MadeVoxel> find_cut_voxels(const Mask& body, const WorkingVolume& work, const VolumeGrid& scan,
                                       double opening_mm) {
  const Eigen::Array3i low = scan.index_from_world(body.grid.origin_mm).array().round().cast<int>();
  const Place first{low[0], low[1], low[2]};
  return find_made(body, work, opening_mm, [&](const Place&, const Place& beyond, std::int32_t side) {
    return !is_in(work.region, beyond) && goes_on(work, scan, first, beyond, side);
  });
}

std::vector<MadeVoxel> find_painted_voxels(const Mask& body, const WorkingVolume& work, double opening_mm) {
  if (work.unedited.empty()) return {};
  const VolumeGrid& grid = body.grid;
  const auto is_changed = [&](const Place& at) {
    const std::size_t v = grid.offset(at[0], at[1], at[2]);
    return work.unedited[v] != work.in_window.voxels[v];
  };
  return find_made(body, work, opening_mm, [&](const Place& at, const Place& beyond, std::int32_t) {
    return !is_in(work.in_window, beyond) && !is_in(body, beyond) &&
           (is_changed(at) || (grid.contains(beyond[0], beyond[1], beyond[2]) && is_changed(beyond)));
  });
}

std::vector<MadeVoxel> carried_to_surface(const std::vector<MadeVoxel>& made, const VolumeGrid& from,
                                          const Mask& smoothed, double reach_mm) {
  const VolumeGrid& to = smoothed.grid;
  const Eigen::Array3i low = from.index_from_world(to.origin_mm).array().round().cast<int>();
  const Place origin{-low[0], -low[1], -low[2]};
  std::vector<MadeVoxel> carried;
  for (const MadeVoxel& voxel : made) {
    const Place step = step_towards(voxel.side);
    Place at = moved(from.voxel_at(static_cast<std::size_t>(voxel.voxel)), origin);
    for (int left = 1 + voxels_within(reach_mm, to, voxel.side); left > 0 && !is_in(smoothed, at); --left)
      at = moved(at, step, -1);
    if (is_in(smoothed, at)) carried.push_back({static_cast<std::int32_t>(to.offset(at[0], at[1], at[2])), voxel.side});
  }
  return carried;
}

IndexBox box_of(const Mask& mask) {
  IndexBox box{mask.grid.size, {0, 0, 0}};
  for (int k = 0; k < mask.grid.size[2]; ++k)
    for (int j = 0; j < mask.grid.size[1]; ++j)
      for (int i = 0; i < mask.grid.size[0]; ++i) {
        if (mask.at(i, j, k) == 0) continue;
        const std::array<int, 3> at{i, j, k};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          box.low[axis] = std::min(box.low[axis], at[axis]);
          box.high[axis] = std::max(box.high[axis], at[axis] + 1);
        }
      }
  INCISE_REQUIRE(box.low[0] < box.high[0], "expected a mask with at least one voxel, found none");
  return box;
}

}  // namespace incise
