// Nearly incompressible tissue on a coarse mesh: the standard linear tet locks; tets with averaged volume must not.
#include "verification/bodies.hpp"
#include "verification/check.hpp"

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace {

constexpr double kPoissonsRatio = 0.49;
constexpr double kLockedPercent = 15.0;
constexpr double kFreeShare = 0.03;             // of the reference
const std::vector<int> kMeshes{8, 16, 24, 36};  // cells each way; both checks use the last

Material nearly_incompressible(MaterialModel model, VolumeTreatment volume) {
  return {.model = model, .volume = volume, .poissons_ratio = kPoissonsRatio};
}

LineSeries tips(const CheckContext& context, const Material& material) {
  LineSeries curve{material.volume == VolumeTreatment::PerTet ? "volume per tet" : "averaged", {}, {}, false};
  for (const int n : kMeshes) curve.add(n, 1000.0 * panel_tip_of_tets_mm(context, material, n));
  return curve;
}

/// Fills in plot and note, the same for both checks: both treatments of the volume on all meshes, and the reference.
void draw(VerificationCheck& check, MaterialModel model, double reference_um, const LineSeries& standard,
          const LineSeries& averaged) {
  const double last = kMeshes.back();
  check.plot = {fmt::format("Cook's membrane at ν = 0.49, {}", law_text({.model = model})),
                "cells each way",
                "tip displacement, µm",
                false,
                false,
                {{"nine-node quadrilaterals", {0.0, last}, {reference_um, reference_um}, true}, standard, averaged}};
  check.note =
      fmt::format("{} x {} cells: per tet {:.2f} % off, averaged {:.2f} % off", kMeshes.back(), kMeshes.back(),
                  100.0 * (standard.y.back() / reference_um - 1.0), 100.0 * (averaged.y.back() / reference_um - 1.0));
}

}  // namespace

VerificationCheck locking_of_the_standard_tet(const CheckContext& context, MaterialModel model) {
  const Material per_tet = nearly_incompressible(model, VolumeTreatment::PerTet);
  VerificationCheck check =
      described(fmt::format("Cook's membrane, ν = 0.49, {}: error of the standard tet, to show that this mesh locks",
                            law_text(per_tet)),
                "tip by nine-node quadrilaterals, extrapolated", "%", kLockedPercent, 0.0);
  check.criterion = Criterion::AtLeast;
  const double reference = 1000.0 * panel_reference_tip_mm(per_tet);
  const LineSeries standard = tips(context, per_tet);
  check.found = 100.0 * std::abs(standard.y.back() / reference - 1.0);
  draw(check, model, reference, standard, tips(context, nearly_incompressible(model, VolumeTreatment::Averaged)));
  return check;
}

VerificationCheck no_locking_when_averaged(const CheckContext& context, MaterialModel model) {
  const Material averaged = nearly_incompressible(model, VolumeTreatment::Averaged);
  const double reference = 1000.0 * panel_reference_tip_mm(averaged);
  VerificationCheck check = described(
      fmt::format("Cook's membrane, ν = 0.49, {}: tip displacement on the mesh that locks", law_text(averaged)),
      "tip by nine-node quadrilaterals, extrapolated", "µm", reference, kFreeShare * reference);
  const LineSeries curve = tips(context, averaged);
  check.found = curve.y.back();
  draw(check, model, reference, tips(context, nearly_incompressible(model, VolumeTreatment::PerTet)), curve);
  return check;
}

}  // namespace incise
