// The result must not depend on which corner of a tet is named first, as it does if rotations are taken from a tet's
// edges.
#include "verification/bodies.hpp"
#include "verification/check.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace incise {
namespace {

constexpr double kOrderTolerance = 1e-6;  // mm, of some 15 mm: rounding and the solver's residual
const Vec3 kWedgeSize(100, 60, 25);       // mm
const Vec3 kGravity(0, 0, -9810);         // mm/s²

TissueModel cantilever(const std::array<std::size_t, 4>& order) {
  TetMesh mesh = make_block(kWedgeSize, {12, 8, 5});
  for (Tet& tet : mesh.tets) tet = {tet[order[0]], tet[order[1]], tet[order[2]], tet[order[3]]};
  return make_tissue_model(mesh, {}, {FixedConstraint{plane_across(0, 0.0)}}, kGravity);
}

}  // namespace

VerificationCheck vertex_order(const CheckContext& context) {
  VerificationCheck check =
      described("Cantilever under its weight, corners of every tet named in another order: largest change of a vertex",
                "no physics in names", "mm", 0.0, kOrderTolerance);
  const TissueModel model = cantilever({0, 1, 2, 3});
  const TissueState state = solved(context, model).state;
  LineSeries line{"order as made", {}, {}, true};
  for (int i = 0; i <= 12; ++i) {
    const double x = kWedgeSize[0] * i / 12.0;
    line.add(x, mean_displacement(model, state, plane_across(0, x))[2]);
  }
  check.plot = {"Cantilever under its weight, corners renamed", "x at rest, mm", "mean sag, mm", false, false, {line}};
  // Even orders, which keep a tet's volume positive: one for each other corner in first place.
  for (const std::array<std::size_t, 4>& order : {std::array<std::size_t, 4>{2, 3, 0, 1}, {1, 2, 0, 3}, {3, 1, 0, 2}}) {
    const TissueModel other = cantilever(order);
    const TissueState found = solved(context, other).state;
    LineSeries marks{fmt::format("{}{}{}{}", order[0], order[1], order[2], order[3]), line.x, {}, false};
    for (const double x : line.x) marks.y.push_back(mean_displacement(other, found, plane_across(0, x))[2]);
    check.plot.series.push_back(marks);
    for (std::size_t v = 0; v < state.positions.size(); ++v) {
      check.found = std::max(check.found, (state.positions[v] - found.positions[v]).norm());
    }
  }
  check.note = fmt::format("sag of the end: {:.2f} mm", -line.y.back());
  return check;
}

}  // namespace incise
