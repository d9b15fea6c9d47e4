#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/problem.hpp>

#include <vector>

namespace incise {

/// Constants of the moving line source that models the electrode's heat in tissue (docs/models/thermal.md). None is
/// calibrated for incise. Conductivity and heat capacity: muscle in the IT'IS database (Hasgall2018). Damage: the
/// temperature above which tissue coagulates almost at once (Thomsen1991); in fact damage also depends on time
/// (Pearce2010).
struct ThermalSettings {
  double conductivity_w_m_k = 0.49;    ///< thermal conductivity of tissue, W/(m K), [0.01, 100]
  double heat_capacity_mj_m3_k = 3.73; ///< per volume: 1090 kg/m³ · 3421 J/(kg K), MJ/(m³ K), [0.01, 100]
  double body_c = 37.0;                ///< temperature of the tissue before the cut, °C, [-20, 60]
  double damage_c = 60.0;              ///< temperature at which tissue counts as damaged, °C, [45, 200] and at least 5
                                       ///< above body_c
  /// Share of the electrode's power that heats the tissue beside the kerf, [0.001, 1]. The rest leaves with steam and
  /// smoke and through the cable. No source quantifies it; 1 gives an upper bound.
  double absorbed_fraction = 1.0;

  /// Returns the thermal diffusivity k / (ρ c), mm²/s.
  [[nodiscard]] double diffusivity_mm2_s() const { return conductivity_w_m_k / heat_capacity_mj_m3_k; }
};

inline void describe(Visitor& v, ThermalSettings& s) {
  v({"conductivity_w_m_k", "Thermal conductivity of the tissue; muscle in the IT'IS database.", "W/(m K)"},
    s.conductivity_w_m_k, {0.01, 100.0});
  v({"heat_capacity_mj_m3_k", "Heat capacity of the tissue per volume; muscle in the IT'IS database.", "MJ/(m3 K)"},
    s.heat_capacity_mj_m3_k, {0.01, 100.0});
  v({"body_c", "Temperature of the tissue before the cut.", "°C"}, s.body_c, {-20.0, 60.0});
  v({"damage_c",
     "Temperature at which tissue counts as damaged (Thomsen 1991: coagulation); at least 5 K above body_c.", "°C"},
    s.damage_c, {45.0, 200.0});
  v("absorbed_fraction", s.absorbed_fraction,
    "Share of the power that heats the tissue beside the kerf; 1: an upper bound.", {0.001, 1.0});
}

/// Returns all violations; empty: the settings are valid.
[[nodiscard]] std::vector<Problem> validate(const ThermalSettings& settings);

/// Returns the thermal half width, mm: the distance beside a line source, moving straight at constant speed through an
/// infinite body, to which tissue reaches the temperature of damage. The temperature is
/// T − T₀ = q′ / (2 π k) · exp(−v x / (2 a)) · K₀(v r / (2 a)), largest over x, with q′ the absorbed power per length
/// of electrode in tissue and a the diffusivity. The half width is proportional to 1 / v. At high power it approaches
/// q′ / (√(2 π e) ρ c v (T_damage − T₀)). Returns 0 where it would be below 1e-12 of the length 2 a / v.
/// @param power_w     of the electrode, > 0.
/// @param speed_mm_s  of the real tool, not of the simulated one, > 0.
/// @param depth_mm    length of the electrode in tissue, over which the power is spread evenly, > 0.
/// @throws InvalidArgument listing the values out of range.
/// Source: Rosenthal1946, CarslawJaeger1959 (10.7). Assumes tissue constants independent of temperature, no boiling, no
/// blood flow and no surface.
[[nodiscard]] double thermal_half_width_mm(const ThermalSettings& settings, double power_w, double speed_mm_s, double depth_mm);

}  // namespace incise
