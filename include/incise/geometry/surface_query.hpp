#pragma once

#include <incise/core/ids.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <array>
#include <memory>
#include <optional>
#include <span>

namespace incise {

/// A point of a triangle surface.
struct SurfacePoint {
  TriangleId triangle;
  Vec3 barycentric = Vec3::Zero();  ///< weights of the triangle's corners, sum 1
  Vec3 position_mm = Vec3::Zero();
  Vec3 normal = Vec3::Zero();       ///< of the triangle, unit, outwards
  double distance_mm = 0.0;         ///< from the query point, or along the ray; see the query
};

/// Finds nearest points and ray hits on a fixed triangle surface (bounding volume hierarchy). Copies what it needs.
/// Build O(n log n), query O(log n) typical.
class SurfaceQuery {
 public:
  /// @throws InvalidArgument for a surface without triangles, or a vertex out of range or not finite.
  explicit SurfaceQuery(const TriMesh& surface);

  /// Returns the nearest point of the surface; of equally near triangles, on the one with the lowest index.
  [[nodiscard]] SurfacePoint nearest(const Vec3& p) const;
  /// Returns the first hit of the ray from `origin` along unit `direction`, at a distance in [0, max_mm]; nullopt if
  /// there is none.
  [[nodiscard]] std::optional<SurfacePoint> first_hit(const Vec3& origin, const Vec3& direction,
                                                      double max_mm = 1e9) const;
  /// Returns the point of the surface that an observer looking along `approach` sees at p: the first hit of a ray that
  /// starts outside the surface's box and passes through p; nullopt if there is none. `distance_mm` is the height of p
  /// above that point, positive on the observer's side.
  [[nodiscard]] std::optional<SurfacePoint> seen_at(const Vec3& p, const Vec3& approach) const;

  /// Whether the body enclosed by the surface contains p: a ray from p leaves the body at its first hit.
  /// @pre the surface is closed and oriented outwards.
  /// @param direction  of the ray, unit; choose one along which the ray meets no edge.
  [[nodiscard]] bool contains(const Vec3& p, const Vec3& direction) const;

 private:
  struct Tree;
  std::shared_ptr<Tree> tree_;  ///< shared with copies; does not change once built
};

/// Returns two triangles of a surface that pass through each other although they have no corner position in common: the
/// pair with the lowest indices; nullopt if there is none. Triangles that only touch with corners or lie in one plane
/// do not count. O(n log n) for triangles of similar size.
[[nodiscard]] std::optional<std::array<TriangleId, 2>> find_self_crossing(const TriMesh& surface);

/// A material point inside a tet mesh: it follows the mesh wherever its vertices go.
struct EmbeddedPoint {
  TetId tet;
  std::array<double, 4> barycentric{};  ///< sum 1; may leave [0, 1] for points just outside
};

/// Finds the tets that contain points, for given vertex positions (rest or current). Copies what it needs.
class TetLocator {
 public:
  TetLocator(const TetMesh& mesh, std::span<const Vec3> positions);

  /// Returns the tet that contains p, or else the nearest one with its (extrapolating) barycentric coordinates; nullopt
  /// if p is farther than `tolerance_mm` from every tet.
  [[nodiscard]] std::optional<EmbeddedPoint> locate(const Vec3& p, double tolerance_mm = 0.5) const;

 private:
  struct Tree;
  std::shared_ptr<Tree> tree_;  ///< shared with copies; does not change once built
};

/// Returns the place of an embedded point for the given vertex positions, mm.
[[nodiscard]] Vec3 position_of(const EmbeddedPoint& point, const TetMesh& mesh, std::span<const Vec3> positions);

}  // namespace incise
