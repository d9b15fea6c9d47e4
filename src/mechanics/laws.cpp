#include "mechanics/laws.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace incise {
namespace {

/// Sum of two principal stretches, relative to the largest or to 1, below which the polar rotation is ambiguous. The
/// tangent uses at least this sum.
constexpr double kLeastStretchSum = 1e-6;
/// Below this stretch a fibre has lost its direction.
constexpr double kLeastFibreStretch = 1e-6;
/// Change of shape w at which the stiffening is half of Yeoh's: far beyond what tissue survives, and low enough that
/// the energy of inverted tets stays finite.
constexpr double kMostStiffenedShape = 100.0;

Mat3 cofactors(const Mat3& f) {
  Mat3 c;
  c.col(0) = f.col(1).cross(f.col(2));
  c.col(1) = f.col(2).cross(f.col(0));
  c.col(2) = f.col(0).cross(f.col(1));
  return c;
}

double determinant(const Mat3& f) {
  return f.col(0).dot(f.col(1).cross(f.col(2)));
}

/// The stable Neo-Hookean shape energy as f(I) + h(J), I = |F|², J = det F, and its derivatives.
struct NeoHookean {
  double f1, f2;  // f', f''
  double h1, h2;  // h', h''
  NeoHookean(double mu, double i, double j)
      : f1(2.0 / 3.0 * mu * (i / (i + 1.0))),
        f2(2.0 / 3.0 * mu / ((i + 1.0) * (i + 1.0))),
        h1(mu * (5.0 / 6.0 * (j - 1.0) - 1.0)),
        h2(5.0 / 6.0 * mu) {}
};

/// Returns w = 2 Ψ_shape/μ of the stable Neo-Hookean law without stiffening, >= 0. At small strain and constant volume
/// it tends to I₁ − 3.
double shape_measure(const Deformation& d) {
  const double stretch = d.f.squaredNorm() - 3.0;
  const double dilation = determinant(d.f) - 1.0;
  return 2.0 * (2.0 / 3.0 * (stretch - std::log1p(0.25 * stretch)) - dilation + 5.0 / 12.0 * dilation * dilation);
}

/// Yeoh's stiffening of the stable Neo-Hookean shape energy Ψ₀: g(Ψ₀) = Ψ₀ + c μ/2 w²/(1 + w/w_m), w = 2 Ψ₀/μ.
struct Stiffening {
  double energy_kpa;  // g − Ψ₀
  double slope;       // g'
  double root_of_g2;  // √g'', per √kPa: multiplied by a large stress, where g'' alone would underflow
  Stiffening(const ShapeLaw& law, double w) {
    const double u = w / kMostStiffenedShape;
    const double q = 1.0 / (1.0 + u);
    energy_kpa = 0.5 * law.mu_kpa * law.stiffening * (w * (w * q));
    slope = 1.0 + law.stiffening * (w * q * (1.0 + q));
    root_of_g2 = 2.0 * std::sqrt(law.stiffening / law.mu_kpa * q) * q;
  }
};

/// Returns the matrix with its negative eigenvalues set to zero.
Mat3 projected(const Mat3& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(symmetric);
  const Vec3 values = solver.eigenvalues().cwiseMax(0.0);
  const Mat3 result = solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
  return 0.5 * (result + result.transpose());
}

/// Curvatures of the symmetric and the skew change of each pair of directions; entry k is for the other two directions.
struct PairCurvatures {
  Vec3 symmetric;
  Vec3 skew;
};

PairCurvatures corotational_pairs(double mu, double p, const Vec3& sigma, bool is_frozen) {
  PairCurvatures pairs{Vec3::Constant(2.0 * mu), Vec3::Zero()};
  if (is_frozen) return pairs;
  const double least = kLeastStretchSum * std::max(1.0, sigma.cwiseAbs().maxCoeff());
  for (int k = 0; k < 3; ++k) {
    pairs.skew[k] = 2.0 * mu + (2.0 * p - 4.0 * mu) / std::max(sigma[(k + 1) % 3] + sigma[(k + 2) % 3], least);
  }
  return pairs;
}

/// Energy, force and slope of the force of a fibre, relative to those of the linear one, E_f/2 e².
struct FibreGrowth {
  double energy = 1.0, force = 1.0, slope = 1.0;
  FibreGrowth(double stiffening, double strain) {
    if (stiffening == 0.0 || !(strain > 0.0)) return;
    const double exponent = stiffening * strain * strain;
    const double x = std::min(exponent, kMostFibreExponent);
    force = std::exp(x);
    slope = force * (1.0 + 2.0 * x);
    energy = x > 0.0 ? std::expm1(x) / x : 1.0;
    if (x == exponent) return;
    // Continue with the slope at the limit, whose strain is this share of the fibre's.
    const double share = std::sqrt(kMostFibreExponent / stiffening) / strain;
    const double beyond = 1.0 - share;
    energy = share * share * energy + 2.0 * share * beyond * force + beyond * beyond * slope;
    force = share * force + beyond * slope;
  }
};

}  // namespace

double dilation(MaterialModel model, const Deformation& d) {
  return model == MaterialModel::Corotational ? d.r.cwiseProduct(d.f).sum() - 3.0 : determinant(d.f) - 1.0;
}

Mat3 dilation_gradient(MaterialModel model, const Deformation& d) {
  return model == MaterialModel::Corotational ? d.r : cofactors(d.f);
}

double shape_energy_kpa(const ShapeLaw& law, const Deformation& d) {
  if (law.model == MaterialModel::Corotational) return law.mu_kpa * (d.f - d.r).squaredNorm();
  const double w = shape_measure(d);
  const double energy = law.mu_kpa * (0.5 * w);
  return law.stiffening > 0.0 ? energy + Stiffening(law, w).energy_kpa : energy;
}

Mat3 shape_stress_kpa(const ShapeLaw& law, const Deformation& d) {
  if (law.model == MaterialModel::Corotational) return 2.0 * law.mu_kpa * (d.f - d.r);
  const NeoHookean plain(law.mu_kpa, d.f.squaredNorm(), determinant(d.f));
  Mat3 stress = 2.0 * plain.f1 * d.f + plain.h1 * cofactors(d.f);
  if (law.stiffening > 0.0) stress *= Stiffening(law, shape_measure(d)).slope;
  return stress;
}

PrincipalTangent principal_tangent(const ShapeLaw& shape, double p_kpa, double k_kpa, const Deformation& d,
                                   Tangent tangent) {
  const Mat3 s = d.r.transpose() * d.f;
  const Eigen::SelfAdjointEigenSolver<Mat3> stretches(0.5 * (s + s.transpose()));
  const Vec3& sigma = stretches.eigenvalues();
  PrincipalTangent result;
  result.v = stretches.eigenvectors();
  result.u = d.r * result.v;

  PairCurvatures pairs;
  if (shape.model == MaterialModel::Corotational) {
    result.stretch = Mat3::Constant(k_kpa);
    result.stretch.diagonal().array() += 2.0 * shape.mu_kpa;
    pairs = corotational_pairs(shape.mu_kpa, p_kpa, sigma, tangent == Tangent::FrozenRotations);
  } else {
    NeoHookean law(shape.mu_kpa, sigma.squaredNorm(), sigma.prod());
    const Vec3 dj(sigma[1] * sigma[2], sigma[2] * sigma[0], sigma[0] * sigma[1]);
    if (shape.stiffening > 0.0) {  // g' ∂²Ψ₀ + g'' ∂Ψ₀ ∂Ψ₀ᵀ; the second term affects only the stretches
      const Stiffening growth(shape, shape_measure(d));
      const Vec3 slope = growth.root_of_g2 * (2.0 * law.f1 * sigma + law.h1 * dj);
      result.stretch = slope * slope.transpose();
      for (double* part : {&law.f1, &law.f2, &law.h1, &law.h2}) *part *= growth.slope;
    }
    law.h1 += p_kpa;
    law.h2 += k_kpa;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        result.stretch(i, j) += 4.0 * law.f2 * (sigma[i] * sigma[j]) + law.h2 * (dj[i] * dj[j]) +
                                (i == j ? 2.0 * law.f1 : law.h1 * sigma[3 - i - j]);
      }
    }
    pairs.symmetric = Vec3::Constant(2.0 * law.f1) - law.h1 * sigma;
    pairs.skew = Vec3::Constant(2.0 * law.f1) + law.h1 * sigma;
  }
  if (tangent != Tangent::Exact) {
    if (shape.model != MaterialModel::Corotational) result.stretch = projected(result.stretch);  // else 2μ I + k 11ᵀ
    pairs.symmetric = pairs.symmetric.cwiseMax(0.0);
    pairs.skew = pairs.skew.cwiseMax(0.0);
  }
  result.straight = 0.5 * (pairs.symmetric + pairs.skew);
  result.crossed = 0.5 * (pairs.symmetric - pairs.skew);
  return result;
}

Mat3 stiffness_block(const PrincipalTangent& t, const Vec3& a, const Vec3& b) {
  Mat3 block;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    block(i, i) = t.stretch(i, i) * (a[i] * b[i]) + (t.straight[k] * (a[j] * b[j]) + t.straight[j] * (a[k] * b[k]));
    block(i, j) = t.stretch(i, j) * (a[i] * b[j]) + t.crossed[k] * (a[j] * b[i]);
    block(j, i) = t.stretch(j, i) * (a[j] * b[i]) + t.crossed[k] * (a[i] * b[j]);
  }
  return t.u * block * t.u.transpose();
}

double fibre_energy_kpa(const FibreLaw& law, const Vec3& fibre, const Mat3& f) {
  const double strain = (f * fibre).norm() - 1.0;
  return 0.5 * law.modulus_kpa * strain * strain * FibreGrowth(law.stiffening, strain).energy;
}

Mat3 fibre_stress_kpa(const FibreLaw& law, const Vec3& fibre, const Mat3& f) {
  const Vec3 along = f * fibre;
  const double length = along.norm();
  const double growth = FibreGrowth(law.stiffening, length - 1.0).force;
  return law.modulus_kpa * growth * (1.0 - 1.0 / std::max(length, kLeastFibreStretch)) * along * fibre.transpose();
}

Mat3 fibre_tangent_kpa(const FibreLaw& law, const Vec3& fibre, const Mat3& f, Tangent tangent) {
  const Vec3 along = f * fibre;
  const double length = std::max(along.norm(), kLeastFibreStretch);
  const FibreGrowth growth(law.stiffening, length - 1.0);
  double across = growth.force * (1.0 - 1.0 / length);
  if (tangent != Tangent::Exact) across = std::max(across, 0.0);
  const Vec3 n = along / length;
  Mat3 h = (law.modulus_kpa * (growth.slope - across)) * (n * n.transpose());
  h.diagonal().array() += law.modulus_kpa * across;
  return h;
}

}  // namespace incise
