#include <incise/core/units.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

TEST(Units, ConvertBetweenSiAndTheUnitsOfTheLibrary) {
  EXPECT_DOUBLE_EQ(units::mm_from_m(0.025), 25.0);
  EXPECT_DOUBLE_EQ(units::m_from_mm(25.0), 0.025);
  EXPECT_DOUBLE_EQ(units::kg_mm3_from_kg_m3(1040.0), 1.04e-6);
}

TEST(Units, ConvertBetweenDegreesAndRadians) {
  EXPECT_DOUBLE_EQ(units::deg_from_rad(units::kPi / 2.0), 90.0);
  EXPECT_DOUBLE_EQ(units::rad_from_deg(180.0), units::kPi);
}

}  // namespace
}  // namespace incise
