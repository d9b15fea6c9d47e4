// A linear displacement is a state of uniform stress on any mesh: the force on every inner vertex must be 0.
#include "verification/bodies.hpp"
#include "verification/check.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace incise {
namespace {

constexpr double kPatchTolerance = 1e-11;  // rounding of positions over a strain of 1 %
const Vec3 kPatchSize(60, 20, 10);         // mm

Mat3 gradient(double share) {
  Mat3 g;
  g << 0.15, 0.1, 0.0, -0.05, -0.05, 0.1, 0.08, 0.0, 0.05;
  return Mat3::Identity() + share * g;
}

/// Returns the largest force on an inner vertex over the largest on the boundary, with every vertex at F X.
double inner_force_share(const CheckContext& context, const TissueModel& model, const Mat3& f) {
  TissueState state = rest_state(model);
  for (Vec3& p : state.positions) p = f * p;
  Points forces(state.positions.size(), Vec3::Zero());
  add_elastic_response(model, state, forces, nullptr, context.workers);
  double inner = 0.0;
  double outer = 0.0;
  for (std::size_t v = 0; v < forces.size(); ++v) {
    double& largest = model.is_fixed[v][0] && model.is_fixed[v][1] && model.is_fixed[v][2] ? outer : inner;
    largest = std::max(largest, forces[v].norm());
  }
  return inner / outer;
}

/// Returns the largest distance of a vertex in equilibrium from F X, over the body's length.
double position_error(const CheckContext& context, TissueModel& model, const Mat3& f) {
  prescribe_boundary(model, f);
  const StaticResult result = solved(context, model, nullptr, 1e-13);
  double error = 0.0;
  for (std::size_t v = 0; v < model.mesh.vertices.size(); ++v) {
    error = std::max(error, (result.state.positions[v] - f * model.mesh.vertices[v]).norm());
  }
  return error / kPatchSize[0];
}

}  // namespace

VerificationCheck patch_test(const CheckContext& context, const Material& material) {
  VerificationCheck check =
      described(fmt::format("Patch test on an irregular mesh, {}: forces inside and distance from the linear field",
                            law_text(material)),
                "Irons and Razzaque 1972: exact to rounding", "-", 0.0, kPatchTolerance);
  TissueModel model = make_tissue_model(irregular_block(kPatchSize, {6, 4, 3}, 0.2, 5), material,
                                        {FixedConstraint{plane_across(0, 0.0)}});
  prescribe_boundary(model, gradient(1.0));
  LineSeries curve{"largest inner force / largest boundary force", {}, {}, false};
  for (const double share : {0.01, 0.03, 0.1, 0.3, 1.0, 2.0}) {
    curve.add(share, inner_force_share(context, model, gradient(share)));
  }
  const double positions = position_error(context, model, gradient(1.0));
  check.found = std::max(positions, *std::max_element(curve.y.begin(), curve.y.end()));
  check.note =
      fmt::format("{} tets; positions off by {:.1e} of the length after Newton", model.mesh.tets.size(), positions);
  check.plot = {"Patch test: " + law_text(material),
                "share of the displacement gradient",
                "inner force / boundary force",
                true,
                false,
                {curve, {"tolerance", {0.01, 2.0}, {kPatchTolerance, kPatchTolerance}, true}}};
  return check;
}

}  // namespace incise
