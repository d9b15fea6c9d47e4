#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/problem.hpp>

#include <string>
#include <vector>

namespace incise {

/// What the heat of an electrode does to tissue: constants of the moving line source (docs/models/thermal.md). None is calibrated for incise.
/// Conductivity and heat capacity: muscle in the IT'IS database (Hasgall2018). Damage: the temperature from which tissue
/// coagulates within a moment (Thomsen1991); the truth depends on time, too (Pearce2010).
struct ThermalSettings {
  double conductivity_w_m_k = 0.49;    ///< of heat in tissue, W/(m K), > 0
  double heat_capacity_mj_m3_k = 3.73; ///< per volume: 1090 kg/m³ · 3421 J/(kg K), MJ/(m³ K), > 0
  double body_c = 37.0;                ///< temperature of the tissue before the cut, °C, above -273.15
  double damage_c = 60.0;              ///< temperature at which tissue counts as damaged, °C, 45 or more and at least 5 above body_c
  /// Share of the electrode's power that heats the tissue beside the kerf, (0, 1]. The rest goes with steam and smoke and back through the
  /// cable; no source says how much, so that 1 gives an upper bound.
  double absorbed_fraction = 1.0;

  /// Heat diffuses at k / (ρ c), mm²/s.
  [[nodiscard]] double diffusivity_mm2_s() const { return conductivity_w_m_k / heat_capacity_mj_m3_k; }
};

inline void describe(Visitor& v, ThermalSettings& s) {
  v({"conductivity_w_m_k", "Of heat in tissue; muscle in the IT'IS database.", "W/(m K)"}, s.conductivity_w_m_k,
    {0.01, 100.0});
  v({"heat_capacity_mj_m3_k", "Per volume; muscle in the IT'IS database.", "MJ/(m3 K)"}, s.heat_capacity_mj_m3_k,
    {0.01, 100.0});
  v({"body_c", "Temperature of the tissue before the cut.", "°C"}, s.body_c, {-20.0, 60.0});
  v({"damage_c",
     "Temperature at which tissue counts as damaged (Thomsen 1991: coagulation); at least 5 K above body_c.", "°C"},
    s.damage_c, {45.0, 200.0});
  v("absorbed_fraction", s.absorbed_fraction,
    "Share of the power that heats the tissue beside the kerf; 1: an upper bound.", {0.001, 1.0});
}

/// Every violation; empty: valid.
[[nodiscard]] std::vector<Problem> validate(const ThermalSettings& settings);

/// How far beside a line source that runs straight on at constant speed through an infinite body tissue reaches the temperature of damage,
/// mm: T − T₀ = q′ / (2 π k) · exp(−v x / (2 a)) · K₀(v r / (2 a)), largest over x, with q′ the absorbed power per length of needle in tissue.
/// In the limit of much power or speed: q′ / (√(2 π e) ρ c v (T_damage − T₀)). Proportional to 1 / v at any speed. 0 where it is below 1e-12
/// of the length 2 a / v.
/// @param power_w     of the electrode, > 0.
/// @param speed_mm_s  of the real tool, not of the simulated one, > 0.
/// @param depth_mm    length of the electrode in tissue, over which the power is spread evenly, > 0.
/// @throws InvalidArgument listing what is out of range.
/// Source: Rosenthal1946, CarslawJaeger1959 (10.7). Takes constants of tissue that hold at any temperature, no boiling, no blood flow, no surface.
[[nodiscard]] double thermal_half_width_mm(const ThermalSettings& settings, double power_w, double speed_mm_s, double depth_mm);

}  // namespace incise
