#include "contact.hpp"

#include <incise/cutting/carving.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

double point_segment_squared(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length = ab.squaredNorm();
  const double t = length > 0.0 ? std::clamp((p - a).dot(ab) / length, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).squaredNorm();
}

/// Squared distance of two segments; the closest pair of two segments either is interior to both or involves an end point.
double segment_segment_squared(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  double best = std::min({point_segment_squared(a, c, d), point_segment_squared(b, c, d), point_segment_squared(c, a, b),
                          point_segment_squared(d, a, b)});
  const Vec3 u = b - a;
  const Vec3 v = d - c;
  const Vec3 w = a - c;
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double uv = u.dot(v);
  const double determinant = uu * vv - uv * uv;
  if (determinant > 1e-14 * uu * vv) {
    const double s = (uv * v.dot(w) - vv * u.dot(w)) / determinant;
    const double t = (uu * v.dot(w) - uv * u.dot(w)) / determinant;
    if (s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0) best = std::min(best, (w + s * u - t * v).squaredNorm());
  }
  return best;
}

/// Squared distance of p from the plane of a triangle if p projects inside it; infinity otherwise (edges are handled elsewhere).
double point_triangle_interior_squared(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const double area = normal.squaredNorm();
  if (area == 0.0) return std::numeric_limits<double>::infinity();
  const bool is_inside = (b - a).cross(p - a).dot(normal) >= 0.0 && (c - b).cross(p - b).dot(normal) >= 0.0 &&
                         (a - c).cross(p - c).dot(normal) >= 0.0;
  if (!is_inside) return std::numeric_limits<double>::infinity();
  const double height = normal.dot(p - a);
  return height * height / area;
}

/// Whether the segment enters the solid tet: it is clipped against the four half-spaces.
bool meets(const std::array<Vec3, 4>& tet, const Vec3& a, const Vec3& b) {
  static constexpr std::array<std::array<int, 3>, 4> kFaces{{{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};
  double enter = 0.0;
  double leave = 1.0;
  for (int corner = 0; corner < 4; ++corner) {
    const auto [i, j, k] = kFaces[static_cast<std::size_t>(corner)];
    const Vec3& origin = tet[static_cast<std::size_t>(i)];
    Vec3 inwards = (tet[static_cast<std::size_t>(j)] - origin).cross(tet[static_cast<std::size_t>(k)] - origin);
    const double side = inwards.dot(tet[static_cast<std::size_t>(corner)] - origin);
    if (side == 0.0) return false;  // flat: its edges tell the distance
    if (side < 0.0) inwards = -inwards;
    const double at_a = inwards.dot(a - origin);
    const double at_b = inwards.dot(b - origin);
    if (at_a < 0.0 && at_b < 0.0) return false;
    if (at_a < 0.0) enter = std::max(enter, at_a / (at_a - at_b));
    if (at_b < 0.0) leave = std::min(leave, at_a / (at_a - at_b));
  }
  return enter <= leave;
}

}  // namespace

double distance_to_segment(const std::array<Vec3, 4>& tet, const Vec3& a, const Vec3& b) {
  if (meets(tet, a, b)) return 0.0;
  static constexpr std::array<std::array<int, 2>, 6> kEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
  static constexpr std::array<std::array<int, 3>, 4> kFaces{{{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};
  double best = std::numeric_limits<double>::infinity();
  const auto corner = [&tet](int i) -> const Vec3& { return tet[static_cast<std::size_t>(i)]; };
  for (const auto& [i, j] : kEdges) best = std::min(best, segment_segment_squared(corner(i), corner(j), a, b));
  for (const auto& [i, j, k] : kFaces) {
    best = std::min(best, point_triangle_interior_squared(a, corner(i), corner(j), corner(k)));
    best = std::min(best, point_triangle_interior_squared(b, corner(i), corner(j), corner(k)));
  }
  return std::sqrt(best);
}

ContactInterval contact_interval(std::span<const double> distances_mm, double limit_mm) {
  ContactInterval interval;
  if (distances_mm.size() < 2) return interval;
  const double width = 1.0 / static_cast<double>(distances_mm.size() - 1);
  for (std::size_t i = 0; i + 1 < distances_mm.size(); ++i) {
    const double from = distances_mm[i] - limit_mm;
    const double to = distances_mm[i + 1] - limit_mm;
    if (from > 0.0 && to > 0.0) continue;
    const double start = from > 0.0 ? from / (from - to) : 0.0;
    const double end = to > 0.0 ? from / (from - to) : 1.0;
    if (interval.fraction == 0.0 && end > start) interval.first = (static_cast<double>(i) + start) * width;
    interval.fraction += (end - start) * width;
  }
  return interval;
}

std::array<Vec3, 4> corners_of(const TetMesh& mesh, std::span<const Vec3> positions, std::size_t tet) {
  const Tet& t = mesh.tets[tet];
  return {positions[t[0].index()], positions[t[1].index()], positions[t[2].index()], positions[t[3].index()]};
}

std::vector<TetId> contact_candidates(const TissueModel& model, std::span<const std::uint8_t> is_live,
                                      std::span<const Vec3> before, std::span<const Vec3> after, const ToolPose& tool_before,
                                      const ToolPose& tool_after, const Needle& needle, double limit_mm, Workers& workers) {
  Box3 swept(tool_before.tip_mm);
  swept.extend(tool_after.tip_mm);
  swept.extend(tool_before.tip_mm - needle.length_mm * tool_before.axis);
  swept.extend(tool_after.tip_mm - needle.length_mm * tool_after.axis);
  const Vec3 low = swept.min() - Vec3::Constant(limit_mm);
  const Vec3 high = swept.max() + Vec3::Constant(limit_mm);

  constexpr std::size_t kChunk = 4096;
  const std::size_t count = model.mesh.tets.size();
  std::vector<std::vector<TetId>> found(Workers::chunk_count(count, kChunk));
  workers.for_chunks(count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    for (std::size_t tet = begin; tet < end; ++tet) {
      if (is_live[tet] == 0) continue;
      Vec3 tet_low = Vec3::Constant(std::numeric_limits<double>::infinity());
      Vec3 tet_high = -tet_low;
      for (const VertexId v : model.mesh.tets[tet]) {
        tet_low = tet_low.cwiseMin(before[v.index()]).cwiseMin(after[v.index()]);
        tet_high = tet_high.cwiseMax(before[v.index()]).cwiseMax(after[v.index()]);
      }
      if ((tet_low.array() <= high.array()).all() && (tet_high.array() >= low.array()).all()) {
        found[chunk].emplace_back(tet);
      }
    }
  });
  std::vector<TetId> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

double share_within(const std::array<Vec3, 4>& tet, const Vec3& a, const Vec3& b, double limit_mm) {
  // The points (i, j, k, l) / 4 with i + j + k + l = 4, drawn a little towards the centroid so that each stands for its surroundings.
  constexpr int kOrder = 4;
  constexpr double kShrink = 0.8;
  const Vec3 centroid = 0.25 * (tet[0] + tet[1] + tet[2] + tet[3]);
  int inside = 0;
  int samples = 0;
  for (int i = 0; i <= kOrder; ++i) {
    for (int j = 0; i + j <= kOrder; ++j) {
      for (int k = 0; i + j + k <= kOrder; ++k) {
        const int l = kOrder - i - j - k;
        const Vec3 corner_mix = (i * tet[0] + j * tet[1] + k * tet[2] + l * tet[3]) / kOrder;
        const Vec3 p = centroid + kShrink * (corner_mix - centroid);
        ++samples;
        if (point_segment_squared(p, a, b) <= limit_mm * limit_mm) ++inside;
      }
    }
  }
  return static_cast<double>(inside) / samples;
}

}  // namespace incise
