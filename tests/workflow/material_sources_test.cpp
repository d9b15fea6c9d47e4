#include <incise/core/error.hpp>
#include <incise/workflow/material_sources.hpp>
#include <incise/workflow/study.hpp>

#include <gmock/gmock.h>

#include <cmath>

namespace incise {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// A bar of 4 x 20 x 4 mm along y in cells of 1 mm, clamped at y = 0 and pulled by 1 mm at y = 20; nothing resists a
/// change of its width (Poisson's ratio 0), so that each layer is in uniaxial tension.
class PulledBar : public ::testing::Test {
 protected:
  PulledBar() {
    settings_.gravity_mm_s2 = Vec3::Zero();
    settings_.material.youngs_modulus_kpa = 10.0;
    settings_.material.poissons_ratio = 0.0;
    settings_.tumor_configuration = TumorConfiguration::Rest;
    settings_.constraints = std::vector<Constraint>{
        FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(5, 0.1, 5))}},
        DisplacedConstraint{BoxRegion{Box3(Vec3(-1, 19.9, -1), Vec3(5, 21, 5))}, Vec3(0.0, 1.0, 0.0)}};
  }

  /// How far the bar's middle plane moves, of the 1 mm.
  [[nodiscard]] double middle_moves_mm(const MaterialSources& sources) const {
    TetMesh mesh = make_block({4, 20, 4}, {4, 20, 4});
    lay_on_mesh(settings_, sources, mesh);
    const TissueModel model = tissue_of(settings_, std::move(mesh));
    Workers workers(1);
    Monitor silent;
    const StaticResult result = stretch(model, workers, silent);
    EXPECT_EQ(result.outcome, Outcome::Success);
    double sum = 0.0;
    int count = 0;
    for (std::size_t v = 0; v < model.mesh.vertices.size(); ++v) {
      if (std::abs(model.mesh.vertices[v].y() - 10.0) > 1e-9) continue;
      sum += result.state.positions[v].y() - 10.0;
      ++count;
    }
    return sum / count;
  }

  /// Voxels of 0.5 mm over the bar and 1 mm round it.
  template <class Value, class Of>
  static Volume<Value> volume_of(const Of& of) {
    Volume<Value> volume;
    volume.grid.size = {13, 45, 13};
    volume.grid.spacing_mm = Vec3::Constant(0.5);
    volume.grid.origin_mm = Vec3::Constant(-1.0);
    for (std::size_t v = 0; v < volume.grid.voxel_count(); ++v) {
      const auto [i, j, k] = volume.grid.voxel_at(v);
      volume.voxels.push_back(of(volume.grid.world_from_index(Vec3(i, j, k))));
    }
    return volume;
  }

  Case settings_;
};

// Two halves in series, E and n E: of the stretch, the softer half takes n / (n + 1).
TEST_F(PulledBar, TheSofterHalfOfTwoInSeriesTakesItsShareOfTheStretch) {
  EXPECT_NEAR(middle_moves_mm({}), 0.5, 1e-3);
  MaterialSources sources;
  // Not known in the lower half, where the case's 10 kPa hold. A voxel lies in the plane between them.
  sources.elasticity_kpa = volume_of<float>([](const Vec3& p) { return p.y() > 10.1 ? 40.0F : 0.0F; });
  EXPECT_NEAR(middle_moves_mm(sources), 0.8, 2e-3) << "elasticity map";
  settings_.variation.tumor_modulus_kpa = 40.0;
  sources = {};
  TetMesh upper = make_block({6, 12, 6}, {1, 1, 1});
  for (Vec3& place : upper.vertices) place += Vec3(-1, 10, -1);
  sources.tumor = boundary_surface(upper);
  EXPECT_NEAR(middle_moves_mm(sources), 0.8, 2e-3) << "stiff tumour, from its surface";
  settings_.variation.tumor_modulus_kpa.reset();
  settings_.variation.labels = {{7, 40.0, std::nullopt}};
  sources = {};
  sources.labels =
      volume_of<std::uint8_t>([](const Vec3& p) { return static_cast<std::uint8_t>(p.y() > 9.9 ? 7 : 1); });
  EXPECT_NEAR(middle_moves_mm(sources), 0.8, 2e-3) << "stiff tumour, from a label of the scan";
}

TEST_F(PulledBar, AMapIsTrilinearBetweenItsKnownVoxels) {
  MaterialSources sources;
  sources.elasticity_kpa =
      volume_of<float>([](const Vec3& p) { return static_cast<float>(20.0 + 2.0 * p.x() + p.y() - 0.5 * p.z()); });
  TetMesh mesh = make_block({4, 20, 4}, {4, 20, 4});
  lay_on_mesh(settings_, sources, mesh);
  const std::vector<double>& modulus = mesh.cell_data.at(kLaidModulusArray).values;
  for (std::size_t t = 0; t < mesh.tets.size(); t += 37) {
    Vec3 centroid = Vec3::Zero();
    for (const VertexId corner : mesh.tets[t]) centroid += 0.25 * mesh.vertices[corner.index()];
    EXPECT_NEAR(modulus[t], 20.0 + 2.0 * centroid.x() + centroid.y() - 0.5 * centroid.z(), 1e-4);
  }
}

TEST_F(PulledBar, WhatIsLaidBesideTheSpecimenIsRefused) {
  MaterialSources sources;
  sources.elasticity_kpa = volume_of<float>([](const Vec3&) { return 0.0F; });
  EXPECT_THAT(
      [&] { static_cast<void>(middle_moves_mm(sources)); },
      ThrowsMessage<CaseError>(HasSubstr("specimen.material.elasticity_map: found a map that is above 0 nowhere")));
  settings_.variation.tumor_modulus_kpa = 40.0;
  TetMesh beside = make_block({6, 12, 6}, {1, 1, 1});
  for (Vec3& place : beside.vertices) place.x() += 50.0;
  sources = {};
  sources.tumor = boundary_surface(beside);
  EXPECT_THAT([&] { static_cast<void>(middle_moves_mm(sources)); },
              ThrowsMessage<CaseError>(HasSubstr("a tumor.surface that holds no tetrahedron")));
}

TEST_F(PulledBar, AMapIsJudgedByWhatItCovers) {
  MaterialSources sources;
  EXPECT_EQ(digest_of(sources), "");
  TetMesh mesh = make_block({4, 20, 4}, {4, 20, 4});
  sources.elasticity_kpa =
      volume_of<float>([](const Vec3& p) { return p.y() > 15.1 ? 20.0F + static_cast<float>(p.y()) : 0.0F; });
  const std::string digest = digest_of(sources);
  const std::optional<MapCoverage> coverage = lay_on_mesh(settings_, sources, mesh);
  ASSERT_TRUE(coverage);
  EXPECT_NEAR(coverage->share, 0.25, 0.02);
  EXPECT_GT(coverage->least_kpa, 35.0);
  EXPECT_LT(coverage->greatest_kpa, 40.5);
  EXPECT_TRUE(verdict_of_map(*coverage).has("scan"));
  EXPECT_EQ(verdict_of_map({0.9, 10.0, 20.0}).status(), VerdictStatus::Ok);
  sources.elasticity_kpa->voxels.back() *= 2.0F;
  EXPECT_NE(digest_of(sources), digest);
  sources.elasticity_kpa = volume_of<float>([](const Vec3&) { return 1e30F; });
  EXPECT_THAT([&] { static_cast<void>(lay_on_mesh(settings_, sources, mesh)); },
              ThrowsMessage<CaseError>(HasSubstr("specimen.material.elasticity_map: found 1e+30 at (")));
  sources = {};
  static_cast<void>(lay_on_mesh(settings_, sources, mesh));
  EXPECT_FALSE(mesh.cell_data.contains(kLaidModulusArray)) << "what an older map has laid goes";
}

TEST_F(PulledBar, LabelsAreThoseOfTissueAlone) {
  settings_.segmentation.label_values = std::vector<std::int32_t>{1};
  settings_.variation.labels = {{1, 40.0, std::nullopt}};
  MaterialSources sources;  // another organ, label 5, begins where the tissue ends, and nearer to its last tets
  sources.labels =
      volume_of<std::uint8_t>([](const Vec3& p) { return static_cast<std::uint8_t>(p.y() < 19.6 ? 1 : 5); });
  TetMesh mesh = make_block({4, 20, 4}, {4, 20, 4});
  static_cast<void>(lay_on_mesh(settings_, sources, mesh));
  for (const double label : mesh.cell_data.at("label").values) EXPECT_EQ(label, 1.0);
}

/// A specimen with a tumour's surface, or none.
class WithTumor : public Inputs {
 public:
  explicit WithTumor(bool has_surface) : has_surface_(has_surface) {}
  CtVolume read_ct(Monitor&) override { return {}; }
  std::optional<TriMesh> read_tumor_surface() override {
    return has_surface_ ? std::optional(boundary_surface(make_block({1, 1, 1}, {1, 1, 1}))) : std::nullopt;
  }

 private:
  bool has_surface_;
};

TEST_F(PulledBar, AStiffTumorNeedsItsSurfaceAtRest) {
  settings_.variation.tumor_modulus_kpa = 40.0;
  Monitor silent;
  WithTumor inputs(true), none(false);
  EXPECT_TRUE(read_material_sources(settings_, inputs, silent).tumor.has_value());
  EXPECT_THAT([&] { static_cast<void>(read_material_sources(settings_, none, silent)); },
              ThrowsMessage<CaseError>(HasSubstr("specimen.material.tumor_modulus_kpa: found no tumor.surface")));
  settings_.tumor_configuration = TumorConfiguration::Stretched;
  EXPECT_THAT([&] { static_cast<void>(read_material_sources(settings_, inputs, silent)); },
              ThrowsMessage<CaseError>(HasSubstr("expected tumor.configuration: rest")));
}

}  // namespace
}  // namespace incise
