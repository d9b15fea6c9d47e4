#include "evaluation/coverage.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace incise {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
/// Gaps between segments up to this angle, rad, are only rounding.
constexpr double kSeam = 1e-9;

std::vector<Vec2> flat_points(const Contour& contour, const Vec3& approach) {
  const ViewFrame view = view_along(approach);
  std::vector<Vec2> flat;
  for (const Vec3& p : contour.points) flat.push_back(view.to_view(p).head<2>());
  if (contour.is_closed && !flat.empty()) flat.push_back(flat.front());
  return flat;
}

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Whether c and d lie on different sides of the line through a and b, or on it.
bool parts(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  return cross(b - a, c - a) * cross(b - a, d - a) <= 0.0;
}

}  // namespace

double angular_coverage(const Contour& contour, const Vec2& center, const Vec3& approach) {
  const std::vector<Vec2> flat = flat_points(contour, approach);
  std::vector<std::pair<double, double>> spans;  // within [0, 2π]
  for (std::size_t i = 0; i + 1 < flat.size(); ++i) {
    const Vec2 a = flat[i] - center;
    const Vec2 b = flat[i + 1] - center;
    const double turn = std::atan2(cross(a, b), a.dot(b));  // the short way from a to b
    double low = std::atan2(a.y(), a.x()) + std::min(0.0, turn);
    if (low < 0.0) low += kTurn;
    const double high = low + std::abs(turn);
    spans.emplace_back(low, std::min(high, kTurn));
    if (high > kTurn) spans.emplace_back(0.0, high - kTurn);
  }
  std::sort(spans.begin(), spans.end());
  double gaps = 0.0;
  double end = 0.0;
  const auto pass_to = [&](double low) {
    if (low - end > kSeam) gaps += low - end;
  };
  for (const auto& [low, high] : spans) {
    pass_to(low);
    end = std::max(end, high);
  }
  pass_to(kTurn);
  return 1.0 - gaps / kTurn;
}

bool meet_in_view(const Contour& a, const Contour& b, const Vec3& approach) {
  const std::vector<Vec2> p = flat_points(a, approach);
  const std::vector<Vec2> q = flat_points(b, approach);
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    for (std::size_t j = 0; j + 1 < q.size(); ++j) {
      const bool are_apart = (p[i].cwiseMax(p[i + 1]).array() < q[j].cwiseMin(q[j + 1]).array()).any() ||
                             (q[j].cwiseMax(q[j + 1]).array() < p[i].cwiseMin(p[i + 1]).array()).any();
      if (!are_apart && parts(p[i], p[i + 1], q[j], q[j + 1]) && parts(q[j], q[j + 1], p[i], p[i + 1])) return true;
    }
  }
  return false;
}

}  // namespace incise
