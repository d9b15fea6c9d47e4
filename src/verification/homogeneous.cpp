// States of uniform strain up to 50 %, for which linear tets are exact: they test only the law.
#include "verification/bodies.hpp"
#include "verification/check.hpp"
#include "verification/closed_forms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace incise {
namespace {

constexpr double kStretchTolerance = 1e-8;  // of the size: Newton stops at 1e-10 of the loads
constexpr double kShearTolerance = 1e-10;
const Vec3 kBarSize(40, 20, 20);  // mm
const std::vector<double> kStrains{0.05, 0.1, 0.2, 0.3, 0.4, 0.5};

/// Returns the largest distance of a vertex from diag(stretches) X, relative to the longest side.
double distance_from(const TissueModel& model, const TissueState& state, const Vec3& stretches) {
  double worst = 0.0;
  for (std::size_t v = 0; v < state.positions.size(); ++v) {
    worst = std::max(worst, (state.positions[v] - stretches.cwiseProduct(model.mesh.vertices[v])).norm());
  }
  return worst / kBarSize.maxCoeff();
}

LineSeries closed_form_curve(const std::function<double(double)>& stress) {
  LineSeries curve{"closed form", {}, {}, true};
  for (int i = 0; i <= 50; ++i) curve.add(0.01 * i, stress(0.01 * i));
  return curve;
}

/// Pulls a block along its first `axes` axes with dead tractions equal to the stress in closed form, and compares every
/// vertex with its place.
VerificationCheck pulled(const CheckContext& context, const Material& material, int axes, const char* name,
                         const std::function<Vec3(double)>& stretches_at) {
  VerificationCheck check = described(
      fmt::format("{}, {}, ν = {}: largest distance of a vertex from its place in closed form, up to 50 % strain", name,
                  law_text(material), material.poissons_ratio),
      material.model == MaterialModel::Corotational ? "P = R (2μ(S − I) + λ tr(S − I) I), free sides: P = 0"
                                                    : "Smith, de Goes and Kim 2018, free sides by root finding",
      "of the length", 0.0, kStretchTolerance);
  const TetMesh mesh = irregular_block(kBarSize, {6, 3, 3}, 0.2, 3);
  LineSeries marks{"computed", {}, {}, false};
  TissueState state;
  for (const double strain : kStrains) {
    const Vec3 stretches = stretches_at(strain);
    const double stress = principal_stress_kpa(material, stretches)[0];
    std::vector<Constraint> constraints;
    for (int axis = 0; axis < 3; ++axis) constraints.push_back(symmetry_across(axis));
    for (int axis = 0; axis < axes; ++axis) {
      constraints.emplace_back(TractionConstraint{plane_across(axis, kBarSize[axis]), stress * Vec3::Unit(axis)});
    }
    const TissueModel model = make_tissue_model(mesh, material, constraints);
    state = solved(context, model, state.positions.empty() ? nullptr : &state).state;
    check.found = std::max(check.found, distance_from(model, state, stretches));
    marks.add(mean_displacement(model, state, plane_across(0, kBarSize[0]))[0] / kBarSize[0], stress);
  }
  const LineSeries line =
      closed_form_curve([&](double e) { return principal_stress_kpa(material, stretches_at(e))[0]; });
  check.plot = {
      fmt::format("{}: {}", name, law_text(material)), "strain", "traction, kPa", false, false, {line, marks}};
  return check;
}

}  // namespace

VerificationCheck uniaxial_stretch(const CheckContext& context, const Material& material) {
  return pulled(context, material, 1, "Uniaxial stretch", [&](double strain) {
    const double side = free_stretch_of_bar(material, 1.0 + strain);
    return Vec3(1.0 + strain, side, side);
  });
}

VerificationCheck equibiaxial_stretch(const CheckContext& context, const Material& material) {
  return pulled(context, material, 2, "Equibiaxial stretch", [&](double strain) {
    return Vec3(1.0 + strain, 1.0 + strain, free_stretch_of_sheet(material, 1.0 + strain));
  });
}

VerificationCheck simple_shear(const CheckContext& context, const Material& material) {
  VerificationCheck check = described(
      fmt::format("Simple shear, {}, ν = {}: largest difference of the shear stress from its closed form, up to 50 %",
                  law_text(material), material.poissons_ratio),
      material.model == MaterialModel::Corotational ? "2μ(γ − sin θ) + λ(√(4 + γ²) − 2) sin θ, tan θ = γ/2"
                                                    : "Smith, de Goes and Kim 2018: 4μ/3 γ (1 − 1/(4 + γ²))",
      "of μ", 0.0, kShearTolerance);
  TissueModel model = make_tissue_model(irregular_block(kBarSize, {6, 3, 3}, 0.2, 3), material,
                                        {FixedConstraint{plane_across(1, 0.0)}});
  const double mu = lame_parameters(material.youngs_modulus_kpa, material.poissons_ratio).mu_kpa;
  LineSeries marks{"mean stress from the nodal forces", {}, {}, false};
  for (const double shear : kStrains) {
    Mat3 f = Mat3::Identity();
    f(0, 1) = shear;
    prescribe_boundary(model, f);
    const Mat3 stress = mean_stress_kpa(context, model, solved(context, model, nullptr, 1e-12).state);
    check.found = std::max(check.found, std::abs(stress(0, 1) - simple_shear_stress_kpa(material, shear)) / mu);
    marks.add(shear, stress(0, 1));
  }
  const LineSeries line = closed_form_curve([&](double g) { return simple_shear_stress_kpa(material, g); });
  check.plot = {"Simple shear: " + law_text(material), "shear γ", "shear stress, kPa", false, false, {line, marks}};
  return check;
}

}  // namespace incise
