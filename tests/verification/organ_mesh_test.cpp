// Meshes of organs as others made them, slivers included: they stretch and sag without a tet turning inside out.
#include "support/data_dir.hpp"

#include <incise/io/mesh_io.hpp>
#include <incise/mechanics/statics.hpp>

#include <gtest/gtest.h>

#include <Eigen/LU>

namespace incise {
namespace {

struct Organ {
  const char* name;
  const char* file;
  double scale;     // of the file's unit to a body of natural size in mm
  Vec3 pulled_end;  // outwards
};

void PrintTo(const Organ& organ, std::ostream* out) {
  *out << organ.name;
}

class OrganMesh : public ::testing::TestWithParam<Organ> {
 protected:
  static TetMesh mesh() {
    TetMesh mesh = read_tet_mesh(*testing::data_dir() / GetParam().file);
    for (Vec3& p : mesh.vertices) p *= GetParam().scale;
    return mesh;
  }
  static double extent(const TetMesh& mesh) {
    return bounding_box(mesh.vertices).sizes().dot(GetParam().pulled_end.cwiseAbs());
  }
  /// The planner's default, and the law that is defined for every strain and does not lock.
  static std::vector<Material> tissues() {
    Material safe{.model = MaterialModel::StableNeoHookean, .volume = VolumeTreatment::Averaged};
    return {Material{}, safe};
  }
  static void expect_sound(const TissueModel& model, const StaticResult& result) {
    EXPECT_EQ(result.outcome, Outcome::Success)
        << result.iterations << " iterations, residual " << result.relative_residual;
    EXPECT_EQ(result.inverted_tets, 0u);
    // Counted here once more, from the corners.
    std::size_t inverted = 0;
    for (const Tet& tet : model.mesh.tets) {
      std::array<Vec3, 4> x;
      for (std::size_t c = 0; c < 4; ++c) x[c] = vertex(result.state.positions, tet[c]);
      if (!(signed_volume(x[0], x[1], x[2], x[3]) > 0.0)) ++inverted;
    }
    EXPECT_EQ(inverted, 0u);
    std::printf("[ figure   ] %zu tets, %d iterations, largest displacement %.2f mm\n", model.mesh.tets.size(),
                result.iterations, result.max_displacement_mm);
  }
  static StaticResult solve(const TissueModel& model) {
    Workers workers(2);
    Monitor monitor;
    StaticSettings settings{.max_newton_iterations = 200};
    return solve_static(model, settings, workers, monitor);
  }
};

TEST_P(OrganMesh, StretchesByATenthWithoutAnInvertedTet) {
  INCISE_NEEDS_DATA_DIR();
  const TetMesh body = mesh();
  const Vec3 end = GetParam().pulled_end;
  const double length = extent(body);
  for (const Material& tissue : tissues()) {
    const TissueModel model =
        make_tissue_model(body, tissue,
                          {FixedConstraint{EndRegion{-end, 0.15 * length}},
                           DisplacedConstraint{EndRegion{end, 0.15 * length}, 0.1 * length * end}});
    expect_sound(model, solve(model));
  }
}

TEST_P(OrganMesh, SagsUnderItsWeightWithoutAnInvertedTet) {
  INCISE_NEEDS_DATA_DIR();
  const TetMesh body = mesh();
  for (const Material& tissue : tissues()) {
    const TissueModel model = make_tissue_model(
        body, tissue, {FixedConstraint{EndRegion{-GetParam().pulled_end, 0.25 * extent(body)}}}, Vec3(0, -9806.65, 0));
    expect_sound(model, solve(model));
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, OrganMesh,
    ::testing::Values(Organ{"liver", "meshes/sofa/liver2.msh", 80.0, Vec3::UnitX()},
                      Organ{"tongue_with_slivers", "meshes/artisynth_tongue/tongue.1.node", 1000.0, -Vec3::UnitX()},
                      Organ{"tongue_of_21051_tets", "meshes/lrquad_tongue/tongue_tuned_v3.1.node", 0.5, Vec3::UnitY()}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace incise
