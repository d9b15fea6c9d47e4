#include <incise/core/error.hpp>
#include <incise/evaluation/hu.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace incise {
namespace {

/// Moments about the origin up to third order, moments[p][q] = ∬ x^p y^q dA.
using Moments = std::array<std::array<double, 4>, 4>;

/// Binomial coefficients up to the third row.
constexpr double kBinomial[4][4] = {{1, 0, 0, 0}, {1, 1, 0, 0}, {1, 2, 1, 0}, {1, 3, 3, 1}};
constexpr double kFactorial[6] = {1, 1, 2, 6, 24, 120};

/// Adds the moments of the triangle (origin, a, b), which are negative if it is clockwise:
/// ∬ x^p y^q = (a × b) p! q! / (p+q+2)! Σ_ij C(i+j, j) C(p+q−i−j, q−j) a_x^i b_x^(p−i) a_y^j b_y^(q−j).
void add_triangle(const Vec2& a, const Vec2& b, Moments& moments) {
  const double cross = a.x() * b.y() - a.y() * b.x();
  std::array<std::array<double, 4>, 4> power{};  // of a_x, b_x, a_y, b_y
  const std::array<double, 4> base{a.x(), b.x(), a.y(), b.y()};
  for (std::size_t k = 0; k < 4; ++k) {
    power[k][0] = 1.0;
    for (std::size_t n = 1; n < 4; ++n) power[k][n] = power[k][n - 1] * base[k];
  }
  for (std::size_t p = 0; p < 4; ++p) {
    for (std::size_t q = 0; p + q < 4; ++q) {
      double sum = 0.0;
      for (std::size_t i = 0; i <= p; ++i) {
        for (std::size_t j = 0; j <= q; ++j) {
          sum += kBinomial[i + j][j] * kBinomial[p + q - i - j][q - j] * power[0][i] * power[1][p - i] * power[2][j] *
                 power[3][q - j];
        }
      }
      moments[p][q] += cross * kFactorial[p] * kFactorial[q] / kFactorial[p + q + 2] * sum;
    }
  }
}

Moments moments_of(const std::vector<Vec2>& polygon, const Vec2& origin) {
  Moments moments{};
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    add_triangle(polygon[i] - origin, polygon[(i + 1) % polygon.size()] - origin, moments);
  }
  return moments;
}

std::array<double, 7> hu_invariants(const Moments& central, double area) {
  const auto nu = [&](std::size_t p, std::size_t q) {
    return central[p][q] / std::pow(area, 1.0 + 0.5 * static_cast<double>(p + q));
  };
  const double n20 = nu(2, 0), n02 = nu(0, 2), n11 = nu(1, 1);
  const double n30 = nu(3, 0), n21 = nu(2, 1), n12 = nu(1, 2), n03 = nu(0, 3);
  const double d = n20 - n02;
  const double a = n30 - 3.0 * n12, b = 3.0 * n21 - n03;
  const double s = n30 + n12, t = n21 + n03;
  std::array<double, 7> hu{n20 + n02,
                           d * d + 4.0 * n11 * n11,
                           a * a + b * b,
                           s * s + t * t,
                           a * s * (s * s - 3.0 * t * t) + b * t * (3.0 * s * s - t * t),
                           d * (s * s - t * t) + 4.0 * n11 * s * t,
                           b * s * (s * s - 3.0 * t * t) - a * t * (3.0 * s * s - t * t)};
  // Each is a polynomial of this degree in ν, whose own rounding error is below 1e-13.
  constexpr std::array<double, 7> degree{1, 2, 2, 2, 4, 3, 4};
  for (std::size_t i = 0; i < hu.size(); ++i) {
    if (std::abs(hu[i]) < std::pow(1e-13, degree[i])) hu[i] = 0.0;
  }
  return hu;
}

/// 1 / (sign(h) log10|h|), and its limit 0 for h = 0; infinite for |h| = 1.
double inverse_log(double h) {
  if (h == 0.0) return 0.0;
  return (h > 0.0 ? 1.0 : -1.0) / std::log10(std::abs(h));
}

/// Whether an invariant is so close to 0, as it is for symmetric shapes, that noise determines its logarithm or sign.
bool has_noise(const std::array<double, 7>& hu) {
  constexpr double kOfItsSize = 0.1;
  for (const std::size_t i : {1U, 2U, 3U}) {
    if (std::abs(hu[i]) <= kHuNoise) return true;
  }
  const double third = std::sqrt(std::abs(hu[2])) * std::pow(std::abs(hu[3]), 1.5);  // h5² + h7² = h3 h4³
  const double mixed = std::sqrt(std::abs(hu[1])) * std::abs(hu[3]);                 // |h6| is at most this
  return std::abs(hu[4]) <= kOfItsSize * third || std::abs(hu[5]) <= kOfItsSize * mixed ||
         std::abs(hu[6]) <= kOfItsSize * third;
}

}  // namespace

FilledMoments filled_moments(const Contour& contour, const Vec3& approach) {
  INCISE_REQUIRE(contour.is_closed && contour.points.size() >= 3,
                 fmt::format("expected a closed contour of at least 3 points, found {} of {}",
                             contour.is_closed ? "a closed one" : "an open one", contour.points.size()));
  const ViewFrame view = view_along(approach);
  std::vector<Vec2> polygon;
  polygon.reserve(contour.points.size());
  for (std::size_t i = 0; i < contour.points.size(); ++i) {
    INCISE_REQUIRE(contour.points[i].allFinite(), fmt::format("point {} of the contour is not finite", i));
    polygon.push_back(view.to_view(contour.points[i]).head<2>());
  }
  if (signed_area_mm2(contour, approach) < 0.0) polygon = {polygon.rbegin(), polygon.rend()};

  // First about a corner, then about the centroid found in this way: central moments without cancellation.
  const Moments rough = moments_of(polygon, polygon[0]);
  INCISE_REQUIRE(rough[0][0] > 0.0, "the contour fills no area in the picture");
  const Vec2 centroid = polygon[0] + Vec2(rough[1][0], rough[0][1]) / rough[0][0];
  const Moments central = moments_of(polygon, centroid);
  return {central[0][0], centroid, hu_invariants(central, central[0][0])};
}

HuScore hu_score(const std::array<double, 7>& a, const std::array<double, 7>& b) {
  double opencv = 0.0;
  double seven = 0.0;
  HuScore score;
  for (std::size_t i = 0; i < a.size(); ++i) {
    INCISE_REQUIRE(std::isfinite(a[i]) && std::isfinite(b[i]), fmt::format("invariant {} is not finite", i + 1));
    const double term = std::abs(inverse_log(a[i]) - inverse_log(b[i]));
    seven += term;
    if (std::abs(a[i]) > kHuCutOff && std::abs(b[i]) > kHuCutOff) opencv += term;
    for (const double h : {std::abs(a[i]), std::abs(b[i])}) {
      if (std::abs(h - kHuCutOff) <= 0.1 * kHuCutOff) score.is_unstable = true;
    }
  }
  score.seven_is_unstable = has_noise(a) || has_noise(b);
  if (std::isfinite(opencv)) score.opencv = opencv;
  if (std::isfinite(seven)) score.seven = seven;
  return score;
}

}  // namespace incise
