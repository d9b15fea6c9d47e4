#include "contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

constexpr double kListedBeyondMm = 3.0;  // travel of tool and tissue after which the list is rebuilt
constexpr double kRoundingMm = 1e-9;     // of positions that are sums of steps

Box3 grown(const Box3& box, double by_mm) {
  return {box.min() - Vec3::Constant(by_mm), box.max() + Vec3::Constant(by_mm)};
}

double point_segment_squared(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length = ab.squaredNorm();
  const double t = length > 0.0 ? std::clamp((p - a).dot(ab) / length, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).squaredNorm();
}

/// Squared distance of two segments. The closest pair of points is interior to both or includes an end point.
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

/// Squared distance of p from the plane of a triangle if p projects into the triangle; otherwise infinity (edges are
/// handled elsewhere).
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

constexpr std::array<std::array<std::size_t, 3>, 4> kFaceCorners{{{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};

/// Whether the segment enters the solid tet: it is clipped against the four half-spaces.
bool meets(const std::array<Vec3, 4>& tet, const Vec3& a, const Vec3& b) {
  double enter = 0.0;
  double leave = 1.0;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const auto [i, j, k] = kFaceCorners[corner];
    const Vec3& origin = tet[i];
    Vec3 inwards = (tet[j] - origin).cross(tet[k] - origin);
    const double side = inwards.dot(tet[corner] - origin);
    if (side == 0.0) return false;  // flat: its edges give the distance
    if (side < 0.0) inwards = -inwards;
    const double at_a = inwards.dot(a - origin);
    const double at_b = inwards.dot(b - origin);
    if (at_a < 0.0 && at_b < 0.0) return false;
    if (at_a < 0.0) enter = std::max(enter, at_a / (at_a - at_b));
    if (at_b < 0.0) leave = std::min(leave, at_a / (at_a - at_b));
  }
  return enter <= leave;
}

/// A flat core of four corners, as a corner and two sides.
struct Rectangle {
  Vec3 origin;
  Vec3 u;
  Vec3 v;
  explicit Rectangle(std::span<const Vec3> corners) : origin(corners[0]), u(corners[1] - corners[0]), v(corners[3] - corners[0]) {}

  /// Whether a point projects into the rectangle along its normal.
  [[nodiscard]] bool is_over(const Vec3& p) const {
    const double s = (p - origin).dot(u);
    const double t = (p - origin).dot(v);
    return s >= 0.0 && s <= u.squaredNorm() && t >= 0.0 && t <= v.squaredNorm();
  }
  [[nodiscard]] double height(const Vec3& p) const { return (p - origin).dot(u.cross(v).normalized()); }
};

/// Distance of a tet from a rectangle. The nearest pair has a point on the rectangle's border, or is a corner of the
/// tet over the rectangle's interior, or an edge of the tet passes through the rectangle.
double distance_to_rectangle(const std::array<Vec3, 4>& tet, std::span<const Vec3> corners) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i) best = std::min(best, distance_to_segment(tet, corners[i], corners[(i + 1) % 4]));
  const Rectangle rectangle(corners);
  std::array<double, 4> heights{};
  for (std::size_t i = 0; i < 4; ++i) {
    heights[i] = rectangle.height(tet[i]);
    if (rectangle.is_over(tet[i])) best = std::min(best, std::abs(heights[i]));
  }
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      if (heights[i] * heights[j] >= 0.0) continue;
      const Vec3 crossing = tet[i] + heights[i] / (heights[i] - heights[j]) * (tet[j] - tet[i]);
      if (rectangle.is_over(crossing)) return 0.0;
    }
  }
  return best;
}

/// Squared distance of a point from a core.
double point_core_squared(const Vec3& p, const ToolCore& core) {
  const std::span<const Vec3> c = core.corners();
  if (c.size() <= 2) return point_segment_squared(p, c.front(), c.back());
  const Rectangle rectangle(c);
  if (rectangle.is_over(p)) return rectangle.height(p) * rectangle.height(p);
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i) best = std::min(best, point_segment_squared(p, c[i], c[(i + 1) % 4]));
  return best;
}

constexpr int kPassingSteps = 12;          // at most, of regula falsi for a moment at which contact begins or ends
constexpr double kPassingMm = 1e-6;        // such a moment is found when the distance is within this of the limit
constexpr int kLeastSteps = 8;             // of the golden section search for the moment of least distance

/// A moment, and the distance at it minus the limit.
struct Moment {
  double t;
  double over_mm;
};

/// The moment between two at which the distance crosses the limit, which lies between their distances. Regula falsi,
/// Illinois variant.
template <class Over>
double passing_moment(const Over& over, Moment from, Moment to) {
  double t = from.t;
  int kept = 0;  // the end that was kept last; its value is halved if it is kept again
  for (int i = 0; i < kPassingSteps; ++i) {
    t = from.t + (to.t - from.t) * from.over_mm / (from.over_mm - to.over_mm);
    const double now = over(t);
    if (std::abs(now) < kPassingMm) break;
    if ((now > 0.0) == (from.over_mm > 0.0)) {
      from = {t, now};
      if (kept == 2) to.over_mm *= 0.5;
      kept = 2;
    } else {
      to = {t, now};
      if (kept == 1) from.over_mm *= 0.5;
      kept = 1;
    }
  }
  return t;
}

/// A moment of contact between two moments without contact or, if there is none, the moment of least distance (golden
/// section search).
template <class Over>
Moment least_moment(const Over& over, double from, double to) {
  const double share = 0.5 * (std::sqrt(5.0) - 1.0);
  Moment a{to - share * (to - from), 0.0};
  Moment b{from + share * (to - from), 0.0};
  a.over_mm = over(a.t);
  b.over_mm = over(b.t);
  for (int i = 0; i < kLeastSteps && a.over_mm > 0.0 && b.over_mm > 0.0; ++i) {
    if (a.over_mm < b.over_mm) {
      to = b.t;
      b = a;
      a.t = to - share * (to - from);
      a.over_mm = over(a.t);
    } else {
      from = a.t;
      a = b;
      b.t = from + share * (to - from);
      b.over_mm = over(b.t);
    }
  }
  return a.over_mm < b.over_mm ? a : b;
}

}  // namespace

double distance_to_core(const std::array<Vec3, 4>& tet, const ToolCore& core) {
  const std::span<const Vec3> corners = core.corners();
  return corners.size() <= 2 ? distance_to_segment(tet, corners.front(), corners.back())
                             : distance_to_rectangle(tet, corners);
}

double distance_to_core(const Vec3& point, const ToolCore& core) {
  return std::sqrt(point_core_squared(point, core));
}

double distance_to_segment(const std::array<Vec3, 4>& tet, const Vec3& a, const Vec3& b) {
  if (meets(tet, a, b)) return 0.0;
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) best = std::min(best, segment_segment_squared(tet[i], tet[j], a, b));
  }
  for (const auto& [i, j, k] : kFaceCorners) {
    best = std::min(best, point_triangle_interior_squared(a, tet[i], tet[j], tet[k]));
    best = std::min(best, point_triangle_interior_squared(b, tet[i], tet[j], tet[k]));
  }
  return std::sqrt(best);
}

ContactInterval contact_interval(std::span<const double> distances_mm, const std::function<double(double)>& distance_mm,
                                 double limit_mm) {
  const auto over = [&](double t) { return distance_mm(t) - limit_mm; };
  std::vector<Moment> moments;
  double change = 0.0;
  for (std::size_t m = 0; m < distances_mm.size(); ++m) {
    moments.push_back({static_cast<double>(m) / static_cast<double>(distances_mm.size() - 1), distances_mm[m] - limit_mm});
    if (m > 0) change = std::max(change, std::abs(distances_mm[m] - distances_mm[m - 1]));
  }
  ContactInterval interval;
  interval.at_end = moments.back().over_mm <= 0.0;
  const auto touching = [](const Moment& moment) { return moment.over_mm <= 0.0; };
  const auto begin = std::find_if(moments.begin(), moments.end(), touching);
  if (begin != moments.end()) {
    const auto end = std::find_if(moments.rbegin(), moments.rend(), touching).base();  // the first moment after contact
    interval.first = begin == moments.begin() ? 0.0 : passing_moment(over, *(begin - 1), *begin);
    interval.fraction = (end == moments.end() ? 1.0 : passing_moment(over, *(end - 1), *end)) - interval.first;
    return interval;
  }
  // No contact at any of the moments. Between two of them a convex distance falls no farther than it changes from one
  // to the next.
  const auto least = std::min_element(moments.begin(), moments.end(), [](const Moment& a, const Moment& b) { return a.over_mm < b.over_mm; });
  if (least->over_mm > change) return interval;
  const Moment& before = least == moments.begin() ? *least : *(least - 1);
  const Moment& after = least + 1 == moments.end() ? *least : *(least + 1);
  const Moment inside = least_moment(over, before.t, after.t);
  if (inside.over_mm > 0.0) return interval;
  interval.first = passing_moment(over, before, inside);
  interval.fraction = passing_moment(over, inside, after) - interval.first;
  return interval;
}

std::vector<TetId> NearTets::candidates(const TissueModel& model, std::span<const std::uint8_t> is_wanted,
                                        std::span<const Vec3> before, std::span<const Vec3> after,
                                        std::span<const ToolCore> cores, double limit_mm, Workers& workers) {
  Box3 swept;
  for (const ToolCore& core : cores) {
    for (const Vec3& corner : core.corners()) swept.extend(corner);
  }
  const Box3 wanted = grown(swept, limit_mm);
  const auto box_of = [&](std::size_t tet) {
    Box3 box;
    for (const VertexId v : model.mesh.tets[tet]) box.extend(before[v.index()]).extend(after[v.index()]);
    return box;
  };
  if (!is_known_ || !reach_.contains(grown(wanted, moved_mm_ + kRoundingMm))) {
    reach_ = grown(wanted, kListedBeyondMm);
    moved_mm_ = 0.0;
    is_known_ = true;
    constexpr std::size_t kChunk = 4096;
    const std::size_t count = model.mesh.tets.size();
    std::vector<std::vector<TetId>> found(Workers::chunk_count(count, kChunk));
    workers.for_chunks(count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      for (std::size_t tet = begin; tet < end; ++tet) {
        if (box_of(tet).intersects(reach_)) found[chunk].emplace_back(tet);
      }
    });
    listed_.clear();
    for (const auto& part : found) listed_.insert(listed_.end(), part.begin(), part.end());
  }
  std::vector<TetId> all;
  for (const TetId tet : listed_) {
    if (is_wanted[tet.index()] != 0 && box_of(tet.index()).intersects(wanted)) all.push_back(tet);
  }
  return all;
}

double share_within(const std::array<Vec3, 4>& tet, const ToolCore& core, double limit_mm) {
  // The points (i, j, k, l) / 4 with i + j + k + l = 4, moved towards the centroid so that each represents its
  // surroundings.
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
        if (point_core_squared(p, core) <= limit_mm * limit_mm) ++inside;
      }
    }
  }
  return static_cast<double>(inside) / samples;
}

}  // namespace incise
