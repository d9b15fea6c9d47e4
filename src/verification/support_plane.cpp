// A block on a rigid platform: the block must not sink in, and the platform carries the load but never pulls on tissue.
#include "verification/bodies.hpp"
#include "verification/check.hpp"

#include <incise/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise {
namespace {

const Vec3 kSlabSize(40, 30, 15);           // mm
constexpr double kPenetration = 0.05;       // mm, promised by SupportPlane
constexpr double kBalanceTolerance = 1e-6;  // of the load: Newton stops at 1e-10
const Vec3 kSlabGravity(0, 0, -units::kStandardGravityMmS2);
const std::vector<double> kPressures{1.0, 5.0, 10.0, 20.0};  // kPa, dead loads; near 35 the clamped edge is crushed
constexpr std::size_t kClamp = 0;                            // indices of the constraints
constexpr std::size_t kSupport = 1;

/// Makes a block on the platform, clamped at one end, under a load.
TissueModel block_on_platform(const TractionConstraint& load) {
  return make_tissue_model(
      irregular_block(kSlabSize, {8, 6, 3}, 0.2, 11), {},
      {FixedConstraint{plane_across(0, 0.0)}, SupportConstraint{Vec3::Zero(), Vec3::UnitZ()}, load}, kSlabGravity);
}

TissueModel pressed_block(double pressure_kpa) {
  return block_on_platform({plane_across(2, kSlabSize[2]), Vec3(0, 0, -pressure_kpa)});
}

/// Returns the load on clamp and platform, mN: weight and pressure.
double load_mn(double pressure_kpa) {
  const double weight = units::kg_mm3_from_kg_m3(Material{}.density_kg_m3) * kSlabSize.prod() * -kSlabGravity[2];
  return weight + pressure_kpa * kSlabSize[0] * kSlabSize[1];
}

}  // namespace

VerificationCheck support_penetration(const CheckContext& context) {
  VerificationCheck check =
      described("Block pressed onto a support plane with up to 20 kPa: deepest vertex behind the plane",
                "promise of SupportPlane: at most 0.05 mm", "mm", 0.0, kPenetration);
  LineSeries marks{"deepest vertex", {}, {}, false};
  for (const double pressure : kPressures) {
    const StaticResult result = solved(context, pressed_block(pressure));
    check.found = std::max(check.found, result.penetration_mm);
    marks.add(pressure, result.penetration_mm);
  }
  check.plot = {"Support: penetration",
                "pressure on top, kPa",
                "deepest vertex, mm",
                false,
                false,
                {{"promised", {0.0, kPressures.back()}, {kPenetration, kPenetration}, true}, marks}};
  return check;
}

VerificationCheck support_balance(const CheckContext& context) {
  VerificationCheck check = described(
      "Block clamped at one end, pressed onto a support plane: force carried by clamp and plane divided by weight and "
      "load, as 1 plus the largest component of the difference",
      "balance of forces", "-", 1.0, kBalanceTolerance);
  check.found = 1.0;
  LineSeries line{"weight and load", {}, {}, true};
  LineSeries marks{"plane and clamp", {}, {}, false};
  LineSeries plane{"plane", {}, {}, false};
  for (const double pressure : kPressures) {
    const StaticResult result = solved(context, pressed_block(pressure));
    const double push = result.reactions_mn[kSupport][2];
    const Vec3 left_over = result.reactions_mn[kSupport] + result.reactions_mn[kClamp] - Vec3(0, 0, load_mn(pressure));
    check.found = std::max(check.found, 1.0 + left_over.cwiseAbs().maxCoeff() / load_mn(pressure));
    line.add(pressure, load_mn(pressure) / 1000.0);
    marks.add(pressure, (push + result.reactions_mn[kClamp][2]) / 1000.0);
    plane.add(pressure, push / 1000.0);
  }
  check.plot = {"Support: balance", "pressure on top, kPa", "force, N", false, false, {line, marks, plane}};
  return check;
}

VerificationCheck support_pull(const CheckContext& context) {
  VerificationCheck check =
      described("Block lifted off a support plane at one end: strongest pull of the plane on any vertex",
                "a platform pushes or does nothing", "mN", 0.0, 0.0);
  const TissueModel model = block_on_platform({plane_across(0, kSlabSize[0]), Vec3(0, 0, 2.0)});
  const TissueState state = solved(context, model).state;
  Points pushes(state.positions.size(), Vec3::Zero());
  add_support_response(model, state, pushes, nullptr);
  LineSeries marks{"underside", {}, {}, false};
  double highest = 0.0;
  for (const VertexId v : select(model.mesh, plane_across(2, 0.0))) {
    check.found = std::max(check.found, -pushes[v.index()][2]);
    highest = std::max(highest, state.positions[v.index()][2]);
    marks.add(model.mesh.vertices[v.index()][0], state.positions[v.index()][2]);
  }
  // The test is meaningless unless the tissue lifts.
  if (!(highest > 1.0))
    throw NotSolved(fmt::format("the block should rise by more than 1 mm, found {:.3g} mm", highest));
  check.note = fmt::format("the underside rises by up to {:.2f} mm", highest);
  check.plot = {"Support: a block lifted at one end",
                "x at rest, mm",
                "height of the underside, mm",
                false,
                false,
                {{"plane", {0.0, kSlabSize[0]}, {0.0, 0.0}, true}, marks}};
  return check;
}

}  // namespace incise
