#include "plane_cross.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/contour.hpp>
#include <incise/geometry/contour_checks.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

std::size_t segment_count(const Contour& contour) {
  const std::size_t n = contour.points.size();
  if (n < 2) return 0;
  return contour.is_closed ? n : n - 1;
}

const Vec3& segment_end(const Contour& contour, std::size_t segment) {
  return contour.points[(segment + 1) % contour.points.size()];
}

void require_finite(const Contour& contour) {
  for (std::size_t i = 0; i < contour.points.size(); ++i) {
    INCISE_REQUIRE(contour.points[i].allFinite(), fmt::format("point {} of the contour is not finite", i));
  }
}

std::vector<Vec2> flat_points(const Contour& contour, const Vec3& approach) {
  const ViewFrame view = view_along(approach);
  std::vector<Vec2> flat;
  flat.reserve(contour.points.size());
  for (const Vec3& p : contour.points) flat.push_back(view.to_view(p).head<2>());
  return flat;
}

}  // namespace

double length_mm(const Contour& contour) {
  double length = 0.0;
  for (std::size_t i = 0; i < segment_count(contour); ++i) {
    length += (segment_end(contour, i) - contour.points[i]).norm();
  }
  return length;
}

std::vector<double> arclengths_mm(const Points& points) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < points.size(); ++i)
    lengths.push_back(i == 0 ? 0.0 : lengths.back() + (points[i] - points[i - 1]).norm());
  return lengths;
}

Contour resample(const Contour& contour, std::size_t count) {
  const std::size_t least = contour.is_closed ? 3 : 2;
  INCISE_REQUIRE(contour.points.size() >= 2,
                 fmt::format("expected at least 2 points, found {}", contour.points.size()));
  INCISE_REQUIRE(count >= least, fmt::format("expected a count of at least {}, found {}", least, count));
  require_finite(contour);
  const double length = length_mm(contour);
  INCISE_REQUIRE(length > 0.0, "all points of the contour coincide, expected a positive length");

  Contour result{.points = {}, .is_closed = contour.is_closed};
  result.points.reserve(count);
  const double spacing = length / static_cast<double>(contour.is_closed ? count : count - 1);
  std::size_t segment = 0;
  double passed = 0.0;  // arc length at the start of `segment`
  double segment_length = (segment_end(contour, 0) - contour.points[0]).norm();
  for (std::size_t i = 0; i < count; ++i) {
    const double wanted = spacing * static_cast<double>(i);
    while (segment + 1 < segment_count(contour) && passed + segment_length <= wanted) {
      passed += segment_length;
      ++segment;
      segment_length = (segment_end(contour, segment) - contour.points[segment]).norm();
    }
    const double fraction = segment_length > 0.0 ? std::min(1.0, (wanted - passed) / segment_length) : 0.0;
    const Vec3& start = contour.points[segment];
    result.points.push_back(start + fraction * (segment_end(contour, segment) - start));
  }
  if (!contour.is_closed) result.points.back() = contour.points.back();  // exact, not to rounding
  return result;
}

ContourPoint nearest_on(const Contour& contour, const Vec3& p) {
  INCISE_REQUIRE(!contour.points.empty(), "expected at least 1 point, found an empty contour");
  INCISE_REQUIRE(p.allFinite(), "the query point is not finite");
  ContourPoint best{contour.points[0], (contour.points[0] - p).norm(), 0, 0.0};
  double best_squared = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < segment_count(contour); ++i) {
    const Vec3& start = contour.points[i];
    const Vec3 along = segment_end(contour, i) - start;
    const double squared_length = along.squaredNorm();
    const double fraction = squared_length > 0.0 ? std::clamp((p - start).dot(along) / squared_length, 0.0, 1.0) : 0.0;
    const Vec3 candidate = start + fraction * along;
    const double squared = (candidate - p).squaredNorm();
    if (squared < best_squared) {
      best_squared = squared;
      best = {candidate, std::sqrt(squared), i, fraction};
    }
  }
  return best;
}

ViewFrame view_along(const Vec3& approach) {
  INCISE_REQUIRE(approach.allFinite() && approach.norm() > 0.0, "expected a finite approach that is not zero");
  ViewFrame view;
  view.z = -approach.normalized();
  if (std::abs(view.z.x()) < 0.9) {
    view.x = (Vec3::UnitX() - view.z.x() * view.z).normalized();
    view.y = view.z.cross(view.x);
  } else {
    view.y = (Vec3::UnitY() - view.z.y() * view.z).normalized();
    view.x = view.y.cross(view.z);
  }
  return view;
}

Contour flat_in_view(Contour contour, const ViewFrame& view) {
  for (Vec3& p : contour.points) p = Vec3(view.x.dot(p), view.y.dot(p), 0.0);
  return contour;
}

double signed_area_mm2(const Contour& contour, const Vec3& approach) {
  const std::vector<Vec2> flat = flat_points(contour, approach);
  if (flat.size() < 3) return 0.0;
  // Relative to the first point, so that a contour far from the origin loses no digits.
  double twice = 0.0;
  for (std::size_t i = 1; i + 1 < flat.size(); ++i) twice += plane_cross(flat[i] - flat[0], flat[i + 1] - flat[0]);
  return 0.5 * twice;
}

Contour counter_clockwise(Contour contour, const Vec3& approach) {
  if (contour.points.size() > 2 && signed_area_mm2(contour, approach) < 0.0) {
    std::reverse(contour.points.begin() + 1, contour.points.end());
  }
  return contour;
}

Contour start_farthest_along(Contour contour, const Vec3& direction) {
  INCISE_REQUIRE(contour.is_closed, "expected a closed contour, found an open one");
  INCISE_REQUIRE(direction.allFinite() && direction.norm() > 0.0, "expected a finite direction that is not zero");
  const auto farthest =
      std::max_element(contour.points.begin(), contour.points.end(),
                       [&](const Vec3& a, const Vec3& b) { return a.dot(direction) < b.dot(direction); });
  std::rotate(contour.points.begin(), farthest, contour.points.end());
  return contour;
}

bool contains_in_view(const Contour& polygon, const Vec3& p, const Vec3& approach) {
  const std::vector<Vec2> flat = flat_points(polygon, approach);
  const Vec2 q = view_along(approach).to_view(p).head<2>();
  bool is_inside = false;
  for (std::size_t i = 0, j = flat.size() - 1; i < flat.size(); j = i++) {
    const Vec2& a = flat[j];
    const Vec2& b = flat[i];
    if ((a.y() > q.y()) == (b.y() > q.y())) continue;
    const double x = a.x() + (q.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (q.x() < x) is_inside = !is_inside;
  }
  return is_inside;
}

bool crosses_itself_in_view(const Contour& contour, const Vec3& approach) {
  return first_crossing_in_view(contour, approach).has_value();
}

Vec3 curve_centroid(const Contour& contour) {
  INCISE_REQUIRE(!contour.points.empty(), "expected at least 1 point, found an empty contour");
  Vec3 weighted = Vec3::Zero();
  double length = 0.0;
  for (std::size_t i = 0; i < segment_count(contour); ++i) {
    const Vec3& end = segment_end(contour, i);
    const double segment_length = (end - contour.points[i]).norm();
    weighted += 0.5 * segment_length * (end + contour.points[i]);
    length += segment_length;
  }
  if (length == 0.0) return contour.points[0];
  return weighted / length;
}

}  // namespace incise
