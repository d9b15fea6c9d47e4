#pragma once

#include <numbers>

/// The one consistent set of units inside incise: mm, s, kg, mN, kPa (= mN/mm²), µJ (= mN mm).
/// All conversions are here.
namespace incise::units {

inline constexpr double kMmPerM = 1000.0;
inline constexpr double kKgM3ToKgMm3 = 1e-9;              ///< density: kg/m³ -> kg/mm³
inline constexpr double kStandardGravityMmS2 = 9806.65;   ///< CGPM 1901
inline constexpr double kPi = std::numbers::pi;

[[nodiscard]] constexpr double mm_from_m(double metres) { return metres * kMmPerM; }
[[nodiscard]] constexpr double m_from_mm(double millimetres) { return millimetres / kMmPerM; }
[[nodiscard]] constexpr double deg_from_rad(double radians) { return radians * 180.0 / kPi; }
[[nodiscard]] constexpr double rad_from_deg(double degrees) { return degrees * kPi / 180.0; }
[[nodiscard]] constexpr double kg_mm3_from_kg_m3(double density) { return density * kKgM3ToKgMm3; }

}  // namespace incise::units
