#pragma once

#include <incise/core/defaults.hpp>
#include <incise/core/describe.hpp>
#include <incise/core/names.hpp>
#include <incise/core/problem.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise {

/// What carries a cut.
enum class CutRule {
  Tets,     ///< whole tets have a dose, are held by the tool, and go
  Lattice,  ///< so have points of a fixed lattice; a tet has the stiffness of what is left of it
  Paper,    ///< whole tets as the paper removes them (II-C.2): from the surface inwards, after a count of steps
};
inline constexpr std::array<std::string_view, 3> kCutRuleNames{"tets", "lattice", "paper"};
[[nodiscard]] constexpr Names names_of(CutRule) {
  return kCutRuleNames;
}

/// What becomes of a tet's count of steps when contact is lost. The paper does not say.
enum class ContactCount {
  Keep,   ///< it goes on from there when the tet is touched again
  Reset,  ///< it begins anew
};
inline constexpr std::array<std::string_view, 2> kContactCountNames{"keep", "reset"};
[[nodiscard]] constexpr Names names_of(ContactCount) {
  return kContactCountNames;
}

/// How the simulated tool cuts. Speed and dullness are the two numbers that calibration finds (paper II-C.4); the
/// defaults are the paper's chosen pair, the rest is described in docs/models/cutting.md.
struct CutSettings {
  double speed_mm_s = 13.0;           ///< of the simulated tool, > 0
  double dullness = 9.0;              ///< contact needed before a tet goes, counted in reference steps, > 0
  double reference_step_s = 0.02;     ///< the time that one unit of dullness stands for, > 0
  double power_w = 35.0;              ///< of the electrode, > 0; a study takes that of its plan
  double reference_power_w = 35.0;    ///< power at which dullness is the required contact, > 0; the paper's (II-B.3)
  double reference_real_speed_mm_s = 7.0;  ///< speed of the real tool at which it is, > 0; the paper's (II-B.1)
  double reference_depth_mm = 5.0;         ///< and depth of its tip, > 0; the paper's
  double power_exponent = 1.0;  ///< contact cuts (energy per area of the cut / that of the reference) to this times as
                                ///< fast, [0, 10]; 0: power, real speed and depth have no effect
  std::optional<double> tear_energy_kpa;  ///< work per rest volume at which held tissue tears, kPa (= µJ/mm³), > 0; none: it does not
  std::optional<double> slip_mm;      ///< tissue that the tool has left this far behind slips, > 0; none: never
  /// Of the real tool, > 0; a study takes that of its path. Absent: the reference, and viscous tissue relaxes at the
  /// pace of the simulated tool.
  std::optional<double> real_speed_mm_s;
  std::optional<double> depth_mm;     ///< of the tip, > 0; a study takes that of its path. Absent: the reference
  double advance_per_step_mm = 0.26;  ///< tool travel in one simulation step; (0, the tool's diameter or thickness]
  double reach_mm = 0.25;             ///< a tet is in contact within the tool's radius + reach of its core, >= 0
  double bond_stiffness_kpa_mm2 = 1500.0;  ///< pull on bonded tissue per volume and offset, kPa/mm² (= mN/mm⁴), >= 0; 0: no drag; finite meshes hold with less
  double overlap_mm = kRingOverlapMm;      ///< a ring is cut this far beyond its start, >= 0 and less than once round
  double residual_tolerance = 0.15;   ///< each step's linear solve: |r| <= this · |contact force|, [1e-6, 0.3]; the next step puts the rest right
  double max_step_mm =
      1.0;  ///< farthest that a vertex moves in one step with the tool in (loose bits are held back; counted), > 0
  CutRule rule = CutRule::Tets;
  ContactCount contact_count = ContactCount::Keep;  ///< Paper: what becomes of a tet's count when contact is lost
  // Lattice: in place of reach, bond stiffness and tear energy; not calibrated (docs/decisions/0010-cutting-law.md).
  double kernel_radius_mm = 1.25;           ///< how far from its core the tool acts, [0.5, 5]
  double dose_length_mm = 3.0;              ///< a point that does not move just parts where v d τ0 is this, [0.1, 10]
  double hold_per_mm2 = 50.0;  ///< pull on a point per volume, offset and shear modulus, 1/mm², >= 0: the layer that
                               ///< moves with the tool is 1/√ of it thick; 0: no drag

  /// Contact time that removes a tet of the reference tissue at the reference energy, s.
  [[nodiscard]] double dwell_s() const { return dullness * reference_step_s; }
  /// Energy per area of the cut over that of the references: (P / P_ref) (u_ref h_ref) / (u h).
  [[nodiscard]] double relative_energy() const;
  /// Dose per second of contact with the reference tissue, 1/s: relative_energy()^m / (d τ₀).
  [[nodiscard]] double dwell_rate_per_s() const;
  /// How long a step of the simulated tool takes for the tissue, s.
  [[nodiscard]] double tissue_s(double step_s) const {
    return step_s * speed_mm_s / real_speed_mm_s.value_or(speed_mm_s);
  }
  /// Duration of one simulation step, s. The paper's rule counts steps, and those of SOFA take the same time at every
  /// speed: in steps of the same travel, speed would have no effect.
  [[nodiscard]] double step_s() const {
    return rule == CutRule::Paper ? reference_step_s : advance_per_step_mm / speed_mm_s;
  }
  /// Tool travel in one simulation step, mm.
  [[nodiscard]] double advance_mm() const {
    return rule == CutRule::Paper ? speed_mm_s * reference_step_s : advance_per_step_mm;
  }
};
/// What decides when tissue is cut; a case file puts the tissue's toughness behind it.
inline void describe_effect(Visitor& v, CutSettings& s) {
  v({"speed_mm_s", "Of the simulated tool.", "mm/s"}, s.speed_mm_s, {0.01, 100.0});
  v({"dullness", "Contact needed before a tetrahedron is removed, in reference steps.", "steps"}, s.dullness,
    {0.0, 1000.0, true});
  v({"reference_step_s", "The time that one unit of dullness represents.", "s"}, s.reference_step_s, {0.0, 1.0, true});
  v.internal("power_w", s.power_w, "Of the electrode.", {0.0, 120.0, true});
  v({"reference_power_w", "Power for which dullness holds.", "W"}, s.reference_power_w, {0.0, 120.0, true});
  v({"reference_real_speed_mm_s", "Speed of the real tool for which dullness holds.", "mm/s"},
    s.reference_real_speed_mm_s, {0.1, 50.0});
  v({"reference_depth_mm", "Depth of its tip for which dullness holds.", "mm"}, s.reference_depth_mm, {0.5, 50.0});
  v("power_exponent", s.power_exponent,
    "Contact cuts (energy per area of the cut, plan.power_w / (plan.speed_mm_s plan.depth_mm), relative to that of the "
    "references) to this times as fast; 0: none of them has an effect.",
    {0.0, 10.0});
  v.internal("real_speed_mm_s", s.real_speed_mm_s, "Of the real tool.", kPositive);
  v.internal("depth_mm", s.depth_mm, "Of the real tool's tip.", kPositive);
  v({"tear_energy_kpa", "Work of the tool per volume at which held tissue tears; absent: it does not.", "kPa"},
    s.tear_energy_kpa, {1e-3, 1e6});
  v({"slip_mm", "Tissue that the tool has left this far behind slips; absent: never.", "mm"}, s.slip_mm, kPositive);
}
/// How the cut is simulated, step by step.
inline void describe_steps(Visitor& v, CutSettings& s) {
  v({"advance_per_step_mm",
     "Not with the rule paper: tool travel in one simulation step, at most the tool's diameter or thickness.", "mm"},
    s.advance_per_step_mm, {0.01, 10.0});
  v({"reach_mm", "Not with the rule lattice: tissue is in contact within the tool's radius plus this of its core.",
     "mm"},
    s.reach_mm, {0.0, 5.0});
  v({"bond_stiffness_kpa_mm2",
     "Not with the rule lattice: pull of the tool on tissue that it holds, per volume and offset; 0: no drag.",
     "kPa/mm2"},
    s.bond_stiffness_kpa_mm2, {0.0, 1e6});
  v({"overlap_mm", "A ring is cut this far beyond its start, less than once round.", "mm"}, s.overlap_mm, {0.0, 50.0});
  v("residual_tolerance", s.residual_tolerance, "Of each step's linear solve, relative to the contact force.",
    {1e-6, 0.3});
  v.internal("max_step_mm", s.max_step_mm, "Farthest that a vertex moves in one step with the tool in.", kPositive);
  v("rule", s.rule, "What is cut: whole tetrahedra, the points of a lattice, or tetrahedra as the paper does it.");
  v("contact_count", s.contact_count,
    "Rule paper: what becomes of a tetrahedron's count of steps when contact is lost.");
  v({"kernel_radius_mm", "Rule lattice: how far from its core (a needle's axis) the tool acts.", "mm"},
    s.kernel_radius_mm, {0.5, 5.0});
  v({"dose_length_mm",
     "Rule lattice: where speed times dullness times reference_step_s is this, reference tissue that does not move is "
     "just cut.",
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

/// Every violation; empty: valid. The step is checked against the tool's diameter or thickness.
[[nodiscard]] std::vector<Problem> validate(const CutSettings& settings, double tool_diameter_mm);

}  // namespace incise
