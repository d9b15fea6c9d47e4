// A beam clamped at one end and loaded across the other; it bends so little that linear beam theory applies.
#include "verification/bodies.hpp"
#include "verification/check.hpp"
#include "verification/closed_forms.hpp"
#include "verification/convergence.hpp"

namespace incise {
namespace {

constexpr double kBeamLength = 100.0;               // mm
constexpr double kBeamHeight = 10.0;                // mm
constexpr double kEndTraction = -1e-4;              // kPa: a tip displacement near 1e-3 of the height
constexpr double kTipRateTolerance = 0.2;           // the clamped corners, absent from beam theory, reduce the order
constexpr double kTipTolerance = 0.005;             // of the tip displacement: Saint-Venant's end zone over the length
const std::vector<int> kCellsOverHeight{4, 8, 16};  // over the height

/// Returns the tip displacement with cubic cells, n over the height. At ν = 0 nothing changes across the width, so one
/// layer of cells between planes of symmetry represents the whole beam.
double computed_tip_mm(const CheckContext& context, int n) {
  const Material material{.poissons_ratio = 0.0};
  const double width = kBeamHeight / n;
  const TissueModel model =
      make_tissue_model(make_block(Vec3(kBeamLength, width, kBeamHeight), {10 * n, 1, n}), material,
                        {FixedConstraint{plane_across(0, 0.0)}, symmetry_across(1), symmetry_across(1, width),
                         TractionConstraint{plane_across(0, kBeamLength), Vec3(0, 0, kEndTraction)}});
  return mean_displacement(model, solved(context, model, nullptr, kSmallStrainTolerance).state,
                           plane_across(0, kBeamLength))[2];
}

struct Refinement {
  double expected = 0.0;
  std::vector<double> tips;
  LineSeries errors{"tip displacement", {}, {}, false};
};

Refinement refine(const CheckContext& context) {
  Refinement result;
  result.expected = beam_tip_mm(kBeamLength, kBeamHeight, Material{}.youngs_modulus_kpa, kEndTraction * kBeamHeight);
  for (const int n : kCellsOverHeight) {
    result.tips.push_back(computed_tip_mm(context, n));
    result.errors.add(n, std::abs(1.0 - result.tips.back() / result.expected));
  }
  return result;
}

void finish(VerificationCheck& check, const LineSeries& errors) {
  check.note = errors_text(errors, "cells");
  check.plot = {"Cantilever against Timoshenko's beam",
                "cells over the height",
                "relative error of the tip",
                true,
                true,
                {line_of_order(errors, 2.0, "second order"), errors}};
}

constexpr const char* kBeamSource = "Timoshenko's beam: F L³ / 3EI + F L / (5/6 G A)";

}  // namespace

VerificationCheck cantilever_rate(const CheckContext& context) {
  VerificationCheck check =
      described("Cantilever, ν = 0: observed order of convergence of the tip displacement",
                std::string(kBeamSource) + "; order 2 of linear tets", "-", 2.0, kTipRateTolerance);
  const Refinement refinement = refine(context);
  check.found = observed_rate(refinement.errors.y[1], refinement.errors.y[2]);
  finish(check, refinement.errors);
  return check;
}

VerificationCheck cantilever_tip(const CheckContext& context) {
  const Refinement refinement = refine(context);
  VerificationCheck check = described("Cantilever, ν = 0: tip displacement, extrapolated at second order", kBeamSource,
                                      "mm", refinement.expected, kTipTolerance * std::abs(refinement.expected));
  check.found = second_order_limit(refinement.tips[1], refinement.tips[2]);
  finish(check, refinement.errors);
  return check;
}

}  // namespace incise
