// A hollow sphere, radii 10 and 20 mm, under inner pressure: an eighth of it between three planes of symmetry.
#include "verification/bodies.hpp"
#include "verification/check.hpp"
#include "verification/closed_forms.hpp"
#include "verification/convergence.hpp"

#include <fmt/format.h>

namespace incise {
namespace {

constexpr double kInner = 10.0;     // mm
constexpr double kOuter = 20.0;     // mm
constexpr double kPressure = 1e-2;  // kPa: strains near 1e-4
constexpr double kSphereRateTolerance = 0.3;
constexpr double kSphereTolerance = 0.005;    // of the displacement, after extrapolation
constexpr double kFinestRadialError = 0.025;  // of the displacement: greatest allowed error of the finest mesh
const std::vector<int> kLayers{2, 4, 8};

struct Sphere {
  TissueModel model;
  TissueState state;
  /// Returns the mean radial displacement of the inner surface, µm.
  [[nodiscard]] double inner_um() const {
    double sum = 0.0;
    int count = 0;
    for (std::size_t v = 0; v < state.positions.size(); ++v) {
      const Vec3& rest = model.mesh.vertices[v];
      if (rest.norm() > kInner + 1e-6) continue;
      sum += (state.positions[v] - rest).dot(rest.normalized());
      ++count;
    }
    return 1000.0 * sum / count;
  }
};

Sphere inflate(const CheckContext& context, int layers) {
  const Material material{.poissons_ratio = 0.3};
  TissueModel model = make_tissue_model(eighth_of_a_sphere(kInner, layers), material,
                                        {symmetry_across(0), symmetry_across(1), symmetry_across(2)});
  add_pressure_outwards(model, kInner, kPressure);
  TissueState state = solved(context, model, nullptr, kSmallStrainTolerance).state;
  return {std::move(model), std::move(state)};
}

double closed_form_um(double r) {
  return 1000.0 * sphere_displacement_mm(r, kInner, kOuter, kPressure, Material{}.youngs_modulus_kpa, 0.3);
}

constexpr const char* kSphereSource = "Lamé 1852: u = p a³ / (E (b³ − a³)) ((1 − 2ν) r + (1 + ν) b³ / 2r²)";

}  // namespace

VerificationCheck thick_sphere_rate(const CheckContext& context) {
  VerificationCheck check =
      described("Thick sphere under inner pressure, ν = 0.3: observed order of convergence of the inner displacement",
                std::string(kSphereSource) + "; order 2 of linear tets", "-", 2.0, kSphereRateTolerance);
  LineSeries marks{"inner displacement", {}, {}, false};
  for (const int n : kLayers) {
    marks.add(n, std::abs(1.0 - inflate(context, n).inner_um() / closed_form_um(kInner)));
  }
  check.note = errors_text(marks, "layers");
  check.found = observed_rate(marks.y[1], marks.y[2]);
  check.plot = {"Thick sphere: convergence",
                "layers of cells",
                "relative error of the inner displacement",
                true,
                true,
                {line_of_order(marks, 2.0, "second order"), marks}};
  return check;
}

VerificationCheck thick_sphere_displacement(const CheckContext& context) {
  VerificationCheck check =
      described("Thick sphere under inner pressure, ν = 0.3: inner displacement, extrapolated at second order",
                kSphereSource, "µm", closed_form_um(kInner), kSphereTolerance * closed_form_um(kInner));
  std::vector<double> found;
  Sphere finest;
  for (const int n : kLayers) {
    finest = inflate(context, n);
    found.push_back(finest.inner_um());
  }
  require_small_error(found.back() / check.expected - 1.0, kFinestRadialError);
  check.found = second_order_limit(found[1], found[2]);
  LineSeries marks{fmt::format("vertices, {} layers", kLayers.back()), {}, {}, false};
  const std::size_t stride = 1 + finest.state.positions.size() / 200;
  for (std::size_t v = 0; v < finest.state.positions.size(); v += stride) {
    const Vec3& rest = finest.model.mesh.vertices[v];
    marks.add(rest.norm(), 1000.0 * (finest.state.positions[v] - rest).dot(rest.normalized()));
  }
  LineSeries line{"Lamé", {}, {}, true};
  for (int i = 0; i <= 40; ++i) {
    const double radius = kInner + (kOuter - kInner) * i / 40.0;
    line.add(radius, closed_form_um(radius));
  }
  check.note = fmt::format("finest mesh: {} tets, {:.4f} µm", finest.model.mesh.tets.size(), found.back());
  check.plot = {
      "Thick sphere: radial displacement", "radius, mm", "radial displacement, µm", false, false, {line, marks}};
  return check;
}

}  // namespace incise
