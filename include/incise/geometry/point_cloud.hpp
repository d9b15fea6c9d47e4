#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/problem.hpp>
#include <incise/core/random.hpp>
#include <incise/core/workers.hpp>
#include <incise/geometry/tet_mesh.hpp>
#include <incise/geometry/types.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace incise {

/// Points of a surface, in no order, mm.
struct PointCloud {
  Points points;   ///< N x 3
  Points normals;  ///< N x 3, unit, outwards (towards the observer); empty: unknown
};

/// Returns the vertices of a mesh, with its point data `normals`, made unit, if it has them. If any of these has length
/// 0, the cloud has no normals.
[[nodiscard]] PointCloud cloud_of(const TriMesh& mesh);
/// Returns the cloud as a mesh without triangles, as files store it, with point data `normals` if it has normals.
[[nodiscard]] TriMesh mesh_of(const PointCloud& cloud);

/// Name of the point data that marks a cloud that no camera saw: everything projected onto it is labelled virtual.
/// Files keep the mark.
inline constexpr const char* kVirtualMark = "virtual";
[[nodiscard]] inline bool is_marked_virtual(const TriMesh& cloud) {
  return cloud.point_data.contains(kVirtualMark);
}

/// Returns the points with the given indices, in the order of `indices`.
[[nodiscard]] PointCloud subset(const PointCloud& cloud, std::span<const std::size_t> indices);

/// Returns the points within the box, its border included.
[[nodiscard]] PointCloud crop(const PointCloud& cloud, const Box3& box);

/// Returns one point per occupied cube of a grid: the mean of its points and normals, in order of the cubes, z slowest.
/// The grid starts at the cloud's lowest corner, so the result moves with the cloud.
/// @pre voxel_mm > 0.  O(n log n).
[[nodiscard]] PointCloud downsample(const PointCloud& cloud, double voxel_mm);

/// Median distance from a point to its nearest neighbour, mm; 0 for fewer than 2 points. The median is taken over fewer
/// than 4000 points.
[[nodiscard]] double spacing_mm(std::span<const Vec3> points);

/// Area, mm², of the surface that a sample represents, from the distances to each point's 8th and 9th neighbours: to
/// about 6 %, plus half a spacing or so along the border. 0 for fewer than 10 points.
[[nodiscard]] double sampled_area_mm2(std::span<const Vec3> points);

/// Returns the cloud with the normals of planes fitted to each point's neighbours, oriented against `seen_along`.
/// @param neighbours  points to which a plane is fitted, the point itself included; at least 3.
/// @param seen_along  direction in which the surface was seen (the camera's axis, the approach).
[[nodiscard]] PointCloud with_normals(PointCloud cloud, const Vec3& seen_along, int neighbours, Workers& workers);

/// Standard deviation, mm, of the points about planes fitted to their neighbours, as a median over the cloud. It
/// contains the noise of the cloud and the curvature of its surface within the neighbourhood. 0 for fewer than 4
/// points. The median is taken over fewer than 4000 points.
/// @param neighbours  points to which a plane is fitted, the point itself included; at least 4.
[[nodiscard]] double roughness_mm(std::span<const Vec3> points, int neighbours = 12);

/// Returns the cloud without the points whose mean distance to their `neighbours` nearest ones is more than
/// `deviations` standard deviations above the mean of the cloud. Source: [Rusu2008, 4.1].
[[nodiscard]] PointCloud without_outliers(const PointCloud& cloud, int neighbours, double deviations, Workers& workers);

/// A plane, normal · p = offset, and the indices of the points near it.
struct PlaneFit {
  Vec3 normal = Vec3::UnitZ();
  double offset_mm = 0.0;
  std::vector<std::size_t> inliers;
};

/// Returns the plane that lies within `tolerance_mm` of the most points, refitted to them by least squares; nullopt for
/// fewer than 3 points or points on a line. Source: [Fischler1981].
/// @param trials  number of triples drawn, > 0.
[[nodiscard]] std::optional<PlaneFit> find_plane(std::span<const Vec3> points, double tolerance_mm, int trials,
                                                 Random& random);

/// Settings that turn a camera's cloud into a cloud of the tissue's surface.
struct CleaningSettings {
  std::optional<Box3> box;
  int planes = 0;
  double plane_tolerance_mm = 1.0;
  double plane_least_share = 0.1;
  bool drop_beneath_planes = true;
  int outlier_neighbours = 16;
  double outlier_deviations = 2.0;
  double voxel_mm = 0.0;
  int normal_neighbours = 16;
  Vec3 seen_along = -Vec3::UnitZ();
};
inline void describe(Visitor& v, CleaningSettings& s) {
  v({"box", "Box of the points to keep; points outside it are dropped.", "mm"}, s.box);
  v("planes", s.planes, "Cloud: flat objects (table, holder) to remove with what lies beneath, largest first.",
    {0.0, 20.0});
  v({"plane_tolerance_mm", "Cloud: a point within this distance of a plane belongs to it.", "mm"}, s.plane_tolerance_mm,
    kPositive);
  v("plane_least_share", s.plane_least_share, "Least share of the remaining points for a plane to be removed.",
    {0.0, 1.0, true});
  v("drop_beneath_planes", s.drop_beneath_planes, "Whether to drop what lies behind a plane, seen along `seen_along`.");
  v("outlier_neighbours", s.outlier_neighbours, "Cloud: neighbours used to find outliers; 0 keeps outliers.",
    {0.0, 200.0});
  v("outlier_deviations", s.outlier_deviations,
    "Cloud: standard deviations above the mean distance beyond which a point is removed.", {0.0, 100.0});
  v({"voxel_mm", "Cloud: one point per cube of this size; 0: all points.", "mm"}, s.voxel_mm, {0.0, 100.0});
  v("normal_neighbours", s.normal_neighbours, "Neighbours for a normal; 0: no normals, otherwise at least 3.",
    kNotNegative);
  v.direction("seen_along", s.seen_along, "Direction of sight.");
}

/// Returns every violation; empty if the settings are valid.
[[nodiscard]] std::vector<Problem> validate(const CleaningSettings& settings);

struct CleanedCloud {
  PointCloud cloud;
  std::size_t cropped = 0;       ///< points outside the box
  std::vector<PlaneFit> planes;  ///< removed, normals towards the observer; `inliers` index the cloud before removal
  std::size_t beneath_planes = 0;
  std::size_t outliers = 0;
};

/// Crops a cloud, removes planes and outliers, downsamples it and adds normals, in this order. The result may be empty;
/// the caller decides whether that is an error.
/// @pre points finite, settings valid.
[[nodiscard]] CleanedCloud clean_cloud(const PointCloud& cloud, const CleaningSettings& settings, Random& random,
                                       Workers& workers);

}  // namespace incise
