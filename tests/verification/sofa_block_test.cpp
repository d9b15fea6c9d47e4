// SOFA's fields for the textbook corotational element (true polar rotations), 702 vertices, 2880 tets, nu 0.49.
#include "mechanics/bodies.hpp"
#include "support/data_dir.hpp"

#include <incise/mechanics/solvers.hpp>
#include <incise/mechanics/statics.hpp>

#include <gtest/gtest.h>

#include <fstream>

namespace incise {
namespace {

using testing::plane_x;

// The file prints 8 significant digits of displacements up to 20 mm; its own check found residuals of that size.
constexpr double kPrintedDigitsMm = 2e-6;

struct Reference {
  TetMesh mesh;
  std::map<std::string, Points> fields;
};

Points read_points(std::istream& in, std::size_t count) {
  Points points(count);
  for (Vec3& p : points) in >> p[0] >> p[1] >> p[2];
  return points;
}

/// Legacy VTK text: vertices, tets and vector fields, as this one file has them.
Reference read_reference() {
  std::ifstream in(*testing::data_dir() / "fem/sofa_block/block_3k.vtk");
  Reference reference;
  std::string word;
  while (in >> word) {
    if (word == "POINTS") {
      std::size_t count = 0;
      in >> count >> word;
      reference.mesh.vertices = read_points(in, count);
    } else if (word == "CELLS") {
      std::size_t count = 0;
      in >> count >> word;
      reference.mesh.tets.resize(count);
      for (Tet& tet : reference.mesh.tets) {
        std::size_t corners = 0;
        in >> corners;
        for (VertexId& v : tet) {
          std::size_t index = 0;
          in >> index;
          v = VertexId{index};
        }
      }
    } else if (word == "VECTORS") {
      in >> word;
      const std::string name = word;
      in >> word;
      reference.fields[name] = read_points(in, reference.mesh.vertices.size());
    }
  }
  return reference;
}

Material sofa_material() {
  Material material;
  material.density_kg_m3 = 1000.0;
  return material;
}

void expect_field(const TissueModel& model, const Points& positions, const Points& expected, double tolerance) {
  ASSERT_EQ(expected.size(), positions.size());
  double worst = 0.0;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    worst = std::max(worst, (positions[v] - model.mesh.vertices[v] - expected[v]).norm());
  }
  EXPECT_LT(worst, tolerance);
  ::testing::Test::RecordProperty("largest_difference_mm", std::to_string(worst));
}

StaticResult solve(const TissueModel& model) {
  Workers workers(1);
  Monitor monitor;
  StaticSettings settings;
  settings.relative_tolerance = 1e-11;
  return solve_static(model, settings, workers, monitor);
}

TEST(SofaBlock, StretchOf20MmAgreesToThePrintedDigits) {
  INCISE_NEEDS_DATA_DIR();
  const Reference reference = read_reference();
  const Region underside = BoxRegion{Box3(Vec3(0.001, -1, -1e-6), Vec3(99.999, 61, 1e-6))};
  const TissueModel model =
      make_tissue_model(reference.mesh, sofa_material(),
                        {FixedConstraint{plane_x(0.0)}, DisplacedConstraint{plane_x(100.0), Vec3(20, 0, 0)},
                         FixedConstraint{underside, {false, false, true}}});
  const StaticResult result = solve(model);
  ASSERT_EQ(result.outcome, Outcome::Success);
  expect_field(model, result.state.positions, reference.fields.at("u_stretch_polarF"), kPrintedDigitsMm);
  EXPECT_NEAR(result.reactions_mn[1][0], 28861.0, 0.5);
}

TEST(SofaBlock, CantileverAgreesToThePrintedDigits) {
  INCISE_NEEDS_DATA_DIR();
  const Reference reference = read_reference();
  const TissueModel model =
      make_tissue_model(reference.mesh, sofa_material(), {FixedConstraint{plane_x(0.0)}}, Vec3(0, 0, -9810));
  const StaticResult result = solve(model);
  ASSERT_EQ(result.outcome, Outcome::Success);
  expect_field(model, result.state.positions, reference.fields.at("u_cantilever_polarF"), kPrintedDigitsMm);
}

/// 20 steps of implicit Euler with one linear solve each, the scheme of the reference: ((1 + h a) M + (h² + h b) K) dv
/// = h (f - (h + b) K v - a M v).
TEST(SofaBlock, TwentyDynamicStepsAgreeToThePrintedDigits) {
  INCISE_NEEDS_DATA_DIR();
  const Reference reference = read_reference();
  const TissueModel model =
      make_tissue_model(reference.mesh, sofa_material(), {FixedConstraint{plane_x(0.0)}}, Vec3(0, 0, -9810));
  constexpr double h = 0.01;
  constexpr double a = 0.1;
  constexpr double b = 0.01;
  Workers workers(1);
  TissueState state = rest_state(model);
  const std::size_t count = state.positions.size();
  Points velocity(count, Vec3::Zero());
  Points product(count);
  Points change(count);
  SparseCholesky cholesky(model.pattern);
  for (int step = 0; step < 20; ++step) {
    BlockMatrix matrix(model.pattern);
    Points right = model.dead_load_mn;
    add_elastic_response(model, state, right, &matrix, workers);
    multiply(matrix, velocity, product, workers);
    for (std::size_t v = 0; v < count; ++v) {
      right[v] = h * (right[v] - (h + b) * product[v] - a * model.vertex_mass_kg[v] * velocity[v]);
    }
    for (double& value : matrix.values) value *= h * h + h * b;
    for (std::size_t v = 0; v < count; ++v) {
      for (const int i : {0, 4, 8})
        matrix.block(model.pattern->diagonal[v])[i] += (1.0 + h * a) * model.vertex_mass_kg[v];
    }
    hold_constrained(model, matrix, right);
    ASSERT_TRUE(cholesky.factor(matrix));
    cholesky.solve(right, change);
    for (std::size_t v = 0; v < count; ++v) {
      velocity[v] += change[v];
      state.positions[v] += h * velocity[v];
    }
  }
  expect_field(model, state.positions, reference.fields.at("u_dyn20_cantilever_polarF"), kPrintedDigitsMm);
}

}  // namespace
}  // namespace incise
