#include "verification/closed_forms.hpp"

#include <incise/core/error.hpp>

#include <cmath>

namespace incise {
namespace {

constexpr int kBisections = 200;  // far more than the bits of a double

/// Returns the point of [low, high] where f changes sign. @throws InvalidArgument unless f(low) and f(high) differ in
/// sign.
template <class F>
double root(double low, double high, const F& f) {
  const bool is_low_positive = f(low) > 0.0;
  INCISE_REQUIRE(is_low_positive != (f(high) > 0.0), "expected a change of sign between the ends");
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    ((f(middle) > 0.0) == is_low_positive ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

struct NeoHookean {
  double mu, lambda, alpha;
};

NeoHookean neo_hookean(const Material& material) {
  const LameParameters lame = lame_parameters(material.youngs_modulus_kpa, material.poissons_ratio);
  NeoHookean law{4.0 / 3.0 * lame.mu_kpa, lame.lambda_kpa + 5.0 / 6.0 * lame.mu_kpa, 0.0};
  law.alpha = 1.0 + 0.75 * law.mu / law.lambda;
  return law;
}

Vec3 isotropic_stress_kpa(const Material& material, const Vec3& s) {
  if (material.model == MaterialModel::Corotational) {
    const LameParameters lame = lame_parameters(material.youngs_modulus_kpa, material.poissons_ratio);
    return 2.0 * lame.mu_kpa * (s - Vec3::Ones()) + Vec3::Constant(lame.lambda_kpa * (s.sum() - 3.0));
  }
  const NeoHookean law = neo_hookean(material);
  const double volume = s.prod();
  return law.mu * (1.0 - 1.0 / (s.squaredNorm() + 1.0)) * s +
         law.lambda * (volume - law.alpha) * volume * s.cwiseInverse();
}

}  // namespace

Vec3 principal_stress_kpa(const Material& material, const Vec3& s) {
  INCISE_REQUIRE(material.fibre_modulus_kpa == 0.0 || material.fibre_direction.normalized() == Vec3::UnitX(),
                 "expected fibres along the first principal direction");
  INCISE_REQUIRE(material.stiffening == 0.0 && material.fibre_stiffening == 0.0, "expected no stiffening");
  return isotropic_stress_kpa(material, s) + material.fibre_modulus_kpa * (s[0] - 1.0) * Vec3::UnitX();
}

double free_stretch_of_bar(const Material& material, double along) {
  return root(1e-3, 3.0, [&](double s) { return principal_stress_kpa(material, Vec3(along, s, s))[2]; });
}

double free_stretch_of_sheet(const Material& material, double along) {
  return root(1e-3, 3.0, [&](double s) { return principal_stress_kpa(material, Vec3(along, along, s))[2]; });
}

double simple_shear_stress_kpa(const Material& material, double shear) {
  if (material.model == MaterialModel::StableNeoHookean) {
    return neo_hookean(material).mu * shear * (1.0 - 1.0 / (4.0 + shear * shear));
  }
  const LameParameters lame = lame_parameters(material.youngs_modulus_kpa, material.poissons_ratio);
  const double diagonal = std::sqrt(4.0 + shear * shear);
  const double sine = shear / diagonal;
  return 2.0 * lame.mu_kpa * (shear - sine) + lame.lambda_kpa * (diagonal - 2.0) * sine;
}

double beam_tip_mm(double length, double height, double youngs_modulus, double force) {
  const double bending = youngs_modulus * height * height * height / 12.0;
  const double shear = 5.0 / 6.0 * 0.5 * youngs_modulus * height;
  return force * length * length * length / (3.0 * bending) + force * length / shear;
}

double sphere_displacement_mm(double r, double a, double b, double pressure_kpa, double youngs_modulus_kpa, double nu) {
  const double a3 = a * a * a;
  const double b3 = b * b * b;
  return pressure_kpa * a3 / (youngs_modulus_kpa * (b3 - a3)) *
         ((1.0 - 2.0 * nu) * r + (1.0 + nu) * b3 / (2.0 * r * r));
}

double corner_exponent(double angle, double nu) {
  const double kappa = 3.0 - 4.0 * nu;
  const double sine = std::sin(angle);
  return root(0.3, 1.0, [&](double alpha) {
    const double left = std::sin(alpha * angle);
    return 4.0 * kappa * left * left - (kappa + 1.0) * (kappa + 1.0) + 4.0 * alpha * alpha * sine * sine;
  });
}

}  // namespace incise
