#pragma once

#include <incise/core/defaults.hpp>
#include <incise/core/describe.hpp>
#include <incise/core/names.hpp>
#include <incise/core/problem.hpp>

#include <optional>
#include <vector>

namespace incise {

/// The rule by which tissue is cut.
enum class CutRule {
  Tets,     ///< Each tet has a dose; the tool holds and removes whole tets.
  Lattice,  ///< Each point of a fixed lattice has a dose; the tool holds and parts points, and tets lose stiffness.
  Paper,    ///< Whole tets by the paper's rule (II-C.2): from the surface inwards, after a count of steps in contact.
};
inline constexpr std::array<std::string_view, 3> kCutRuleNames{"tets", "lattice", "paper"};
[[nodiscard]] constexpr Names names_of(CutRule) {
  return kCutRuleNames;
}

/// Treatment of a tet's count of steps when contact is lost; the paper does not specify it.
enum class ContactCount {
  Keep,   ///< The count resumes when the tet is touched again.
  Reset,  ///< The count restarts from 0.
};
inline constexpr std::array<std::string_view, 2> kContactCountNames{"keep", "reset"};
[[nodiscard]] constexpr Names names_of(ContactCount) {
  return kContactCountNames;
}

/// Settings of the simulated cut. Calibration finds the speed and the dullness (paper II-C.4); their defaults are the
/// paper's chosen pair. docs/models/cutting.md describes the other settings.
struct CutSettings {
  double speed_mm_s = 13.0;           ///< of the simulated tool, [0.01, 100]
  double dullness = 9.0;              ///< contact that a tet needs before it is removed, in reference steps, (0, 1000]
  double reference_step_s = 0.02;     ///< τ₀, the time that one unit of dullness represents, (0, 1]
  double power_w = 35.0;              ///< of the electrode, (0, 120]; a run takes it from its plan
  double reference_power_w = 35.0;    ///< power for which dullness holds, (0, 120]; the paper's (II-B.3)
  double reference_real_speed_mm_s = 7.0;  ///< speed of the real tool for which dullness holds, [0.1, 50]; the paper's
                                           ///< (II-B.1)
  double reference_depth_mm = 5.0;         ///< depth of its tip for which dullness holds, [0.5, 50]; the paper's
  double power_exponent = 1.0;  ///< m: the dose grows as relative_energy()^m, [0, 10]; 0: power, real speed and depth
                                ///< have no effect
  std::optional<double> tear_energy_kpa;  ///< work per rest volume at which held tissue tears, kPa (= µJ/mm³),
                                          ///< [1e-3, 1e6]; absent: tissue does not tear. Only with CutRule::Tets
  std::optional<double> slip_mm;      ///< distance behind its holding place at which held tissue slips, > 0; absent: it
                                      ///< never slips
  /// Speed of the real tool, > 0; a run takes it from its path. Absent: the reference speed, and viscous tissue relaxes
  /// in the time of the simulated tool.
  std::optional<double> real_speed_mm_s;
  std::optional<double> depth_mm;     ///< of the real tool's tip, > 0; a run takes it from its path. Absent: the
                                      ///< reference depth
  double advance_per_step_mm = 0.26;  ///< tool travel in one simulation step, [0.01, 10] and at most the tool's
                                      ///< diameter or thickness; not with CutRule::Paper
  double reach_mm = 0.25;             ///< a tet is in contact within the tool's radius + reach of its core, [0, 5]
  double bond_stiffness_kpa_mm2 = 1500.0;  ///< pull on held tissue per volume and offset, kPa/mm² (= mN/mm⁴), [0, 1e6];
                                           ///< 0: no drag. Tets of finite size use a reduced value
  double overlap_mm = kRingOverlapMm;      ///< a ring is cut this far beyond its start, [0, 50], less than once round
  double residual_tolerance = 0.15;   ///< of each step's linear solve: |r| <= this · max(|pulls of the tool|, 5 mN),
                                      ///< [1e-6, 0.3]; the next step corrects the remainder
  double max_step_mm =
      1.0;  ///< greatest motion of a vertex in one step with the tool in, > 0; longer ones are shortened and counted
  CutRule rule = CutRule::Tets;
  ContactCount contact_count = ContactCount::Keep;  ///< used only with CutRule::Paper
  // Only with CutRule::Lattice, in place of reach, bond stiffness and tear energy. Not calibrated
  // (docs/decisions/0010-cutting-law.md).
  double kernel_radius_mm = 1.6;            ///< distance from its core within which the tool acts, [0.5, 5]
  double dose_length_mm = 3.0;              ///< speed · dullness · τ₀ at which a fixed point of reference tissue in the
                                            ///< tool's way just parts, [0.1, 10]
  double hold_per_mm2 = 16.0;  ///< pull on a point per volume, offset and shear modulus, 1/mm², [0, 1e4]; 0: no drag.
                               ///< The layer that moves with the tool is 1/√hold_per_mm2 thick

  /// Returns the contact time that removes a tet of the reference tissue at the reference energy, s.
  [[nodiscard]] double dwell_s() const { return dullness * reference_step_s; }
  /// Returns the energy per area of the cut divided by that at the references: (P / P_ref) (u_ref h_ref) / (u h).
  [[nodiscard]] double relative_energy() const;
  /// Returns the dose per second of contact with the reference tissue, 1/s: relative_energy()^m / (d τ₀).
  [[nodiscard]] double dwell_rate_per_s() const;
  /// Returns the time that passes for viscous tissue in a step of the simulated tool, s: that of the real tool over the
  /// same travel.
  [[nodiscard]] double tissue_s(double step_s) const {
    return step_s * speed_mm_s / real_speed_mm_s.value_or(speed_mm_s);
  }
  /// Returns the duration of one simulation step, s. With the paper's rule it is reference_step_s at every speed, as in
  /// SOFA: that rule counts steps, and in steps of equal travel the speed would have no effect.
  [[nodiscard]] double step_s() const {
    return rule == CutRule::Paper ? reference_step_s : advance_per_step_mm / speed_mm_s;
  }
  /// Returns the tool's travel in one simulation step, mm.
  [[nodiscard]] double advance_mm() const {
    return rule == CutRule::Paper ? speed_mm_s * reference_step_s : advance_per_step_mm;
  }
};
/// Describes the settings that decide when tissue is cut. A case file adds the tissue's toughness after them.
inline void describe_effect(Visitor& v, CutSettings& s) {
  v({"speed_mm_s", "Speed of the simulated tool.", "mm/s"}, s.speed_mm_s, {0.01, 100.0});
  v({"dullness", "Contact needed before a tetrahedron is removed, in reference steps.", "steps"}, s.dullness,
    {0.0, 1000.0, true});
  v({"reference_step_s", "The time that one unit of dullness represents.", "s"}, s.reference_step_s, {0.0, 1.0, true});
  v.internal("power_w", s.power_w, "Power of the electrode.", {0.0, 120.0, true});
  v({"reference_power_w", "Power for which dullness holds.", "W"}, s.reference_power_w, {0.0, 120.0, true});
  v({"reference_real_speed_mm_s", "Speed of the real tool for which dullness holds.", "mm/s"},
    s.reference_real_speed_mm_s, {0.1, 50.0});
  v({"reference_depth_mm", "Depth of the real tool's tip for which dullness holds.", "mm"}, s.reference_depth_mm,
    {0.5, 50.0});
  v("power_exponent", s.power_exponent,
    "Exponent m: contact cuts E^m times as fast, where E is the energy per area of the cut, plan.power_w / "
    "(plan.speed_mm_s plan.depth_mm), divided by that of the references. 0: power, speed and depth have no effect.",
    {0.0, 10.0});
  v.internal("real_speed_mm_s", s.real_speed_mm_s, "Speed of the real tool.", kPositive);
  v.internal("depth_mm", s.depth_mm, "Depth of the real tool's tip.", kPositive);
  v({"tear_energy_kpa", "Work of the tool per volume at which held tissue tears; absent: it does not tear.", "kPa"},
    s.tear_energy_kpa, {1e-3, 1e6});
  v({"slip_mm", "Distance behind its holding place at which held tissue slips; absent: it never slips.", "mm"},
    s.slip_mm, kPositive);
}
/// Describes the settings of the simulation's steps.
inline void describe_steps(Visitor& v, CutSettings& s) {
  v({"advance_per_step_mm",
     "Rules tets and lattice: tool travel in one simulation step, at most the tool's diameter or thickness.", "mm"},
    s.advance_per_step_mm, {0.01, 10.0});
  v({"reach_mm",
     "Rules tets and paper: a tetrahedron nearer to the tool's core than the tool's radius plus this is in contact.",
     "mm"},
    s.reach_mm, {0.0, 5.0});
  v({"bond_stiffness_kpa_mm2",
     "Rules tets and paper: pull of the tool on tissue that it holds, per volume and offset; 0: no drag.", "kPa/mm2"},
    s.bond_stiffness_kpa_mm2, {0.0, 1e6});
  v({"overlap_mm", "A ring is cut this far beyond its start, less than once round.", "mm"}, s.overlap_mm, {0.0, 50.0});
  v("residual_tolerance", s.residual_tolerance, "Tolerance of each step's linear solve, relative to the contact force.",
    {1e-6, 0.3});
  v.internal("max_step_mm", s.max_step_mm, "Greatest motion of a vertex in one step with the tool in.", kPositive);
  v("rule", s.rule, "What is cut: whole tetrahedra, the points of a lattice, or tetrahedra as the paper does it.");
  v("contact_count", s.contact_count,
    "Rule paper: what happens to a tetrahedron's count of steps when contact is lost.");
  v({"kernel_radius_mm", "Rule lattice: the tool acts within this distance of its core (a needle's axis).", "mm"},
    s.kernel_radius_mm, {0.5, 5.0});
  v({"dose_length_mm",
     "Rule lattice: value of speed times dullness times reference_step_s at which reference tissue that does not move "
     "is just cut.",
     "mm"},
    s.dose_length_mm, {0.1, 10.0});
  v({"hold_per_mm2",
     "Rule lattice: pull of the tool on tissue about it, per volume, offset and shear modulus; 0: no drag.", "1/mm2"},
    s.hold_per_mm2, {0.0, 1e4});
}
inline void describe(Visitor& v, CutSettings& s) {
  describe_effect(v, s);
  describe_steps(v, s);
}

/// Returns all violations; empty: the settings are valid. Also checks the tool's travel in one step, and that the
/// contact needed for a cut takes at most 600 s.
/// @param tool_diameter_mm  diameter or thickness of the tool.
[[nodiscard]] std::vector<Problem> validate(const CutSettings& settings, double tool_diameter_mm);

}  // namespace incise
