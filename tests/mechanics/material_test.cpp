#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/mechanics/material.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace incise {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(LameParameters, FollowFromYoungsModulusAndPoissonsRatio) {
  const LameParameters lame = lame_parameters(70.0, 0.25);
  EXPECT_NEAR(lame.mu_kpa, 28.0, 1e-12);
  EXPECT_NEAR(lame.lambda_kpa, 28.0, 1e-12);
}

TEST(LameParameters, RefuseAnIncompressibleMaterial) {
  EXPECT_THROW(static_cast<void>(lame_parameters(70.0, 0.5)), InvalidArgument);
}

TEST(Material, DefaultsAreValid) {
  EXPECT_THAT(problems_of(Material{}), IsEmpty());
}

TEST(Material, NamesEveryViolation) {
  Material material;
  material.youngs_modulus_kpa = -70.0;
  material.poissons_ratio = 0.5;
  material.density_kg_m3 = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(sentences(problems_of(material)),
              ElementsAre(HasSubstr("youngs_modulus_kpa: found -70"), HasSubstr("poissons_ratio: found 0.5"),
                          HasSubstr("density_kg_m3: found nan")));
}

TEST(Material, StiffeningThatWouldNotActIsRefused) {
  Material material;
  EXPECT_THAT(validate(material), IsEmpty());
  material.stiffening = 0.469;
  material.fibre_stiffening = 5.0;
  EXPECT_THAT(
      sentences(validate(material)),
      ElementsAre(HasSubstr("stiffening: found 0.469 with model corotational, expected 0, or model: stable_neo"),
                  HasSubstr("fibre_stiffening: found 5 without fibres, expected 0, or fibre_modulus_kpa")));
  material.model = MaterialModel::StableNeoHookean;
  material.fibre_modulus_kpa = 10.0;
  EXPECT_THAT(validate(material), IsEmpty());
  material.stiffening = 101.0;
  material.fibre_stiffening = -1.0;
  EXPECT_THAT(sentences(validate(material)),
              ElementsAre(HasSubstr("expected a number in [0, 100]"), HasSubstr("expected a number in [0, 1000]")));
}

TEST(Material, StiffnessAndDensityHaveARange) {
  Material material;
  for (const double e : {0.99e-6, 1.01e9, 1e300}) {
    material.youngs_modulus_kpa = e;
    EXPECT_THAT(sentences(problems_of(material)), ElementsAre(HasSubstr("expected a number in [1e-06, 1000000000]")))
        << e;
    MaterialField field{.youngs_modulus_kpa = {70.0, e}};
    EXPECT_THAT(sentences(validate(field, 2)), ElementsAre(HasSubstr("expected a number in [1e-6, 1e9] kPa"))) << e;
  }
  for (const double e : {1e-6, 1e9}) {
    material.youngs_modulus_kpa = e;
    EXPECT_THAT(problems_of(material), IsEmpty()) << e;
  }
  for (const double density : {0.0, 1.01e9}) {
    material.density_kg_m3 = density;
    EXPECT_THAT(sentences(problems_of(material)), ElementsAre(HasSubstr("expected a number in (0, 1000000000]")))
        << density;
  }
}

}  // namespace
}  // namespace incise
