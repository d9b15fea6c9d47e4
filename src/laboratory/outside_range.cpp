#include "laboratory/outside_range.hpp"

#include <incise/core/random.hpp>

namespace incise::laboratory {
namespace {

/// Tissue to which the electrode hardly sticks, around a hard, deep tumour: it is dragged less far than its stiffness
/// suggests, and a correction overshoots.
OutsideKind hardly_dragged(const char* name, double youngs_modulus_kpa, double toughness_j_m2, Random& random) {
  OutsideKind kind{name, {{"youngs_modulus_kpa", youngs_modulus_kpa}, {"toughness_j_m2", toughness_j_m2}}};
  kind.given.emplace_back("rupture_percent", random.uniform(0.7, 0.8));
  kind.given.emplace_back("adhesion_kpa_s_mm2", random.uniform(1.0, 3.0));
  kind.given.emplace_back("inclusion_ratio", random.uniform(10.0, 15.0));
  kind.given.emplace_back("tumor_depth_mm", random.uniform(6.0, 8.0));
  return kind;
}

}  // namespace

OutsideKind failed_specimen() {
  return {"stiff_and_slipped", {{"youngs_modulus_kpa", 48.0}, {"clamp_slip_mm", 9.0}}};
}

OutsideKind outside_specimen(std::uint64_t seed, std::uint64_t index) {
  constexpr std::uint64_t kStream = 0x6f75747369646573ULL;  // separate from the streams from which specimens are drawn
  Random random(seed ^ kStream);
  switch (index % 5) {
    case 0:
      return {"stiff", {{"youngs_modulus_kpa", random.uniform(25.0, 60.0)}}};
    case 2: {
      const double youngs_modulus_kpa = random.uniform(28.0, 38.0);
      return hardly_dragged("scarred", youngs_modulus_kpa, random.uniform(850.0, 1050.0), random);
    }
    case 4:
      return {"soft", {{"youngs_modulus_kpa", random.uniform(4.5, 7.0)}}};
    default: {
      const double youngs_modulus_kpa = random.uniform(3.0, 3.7);
      return hardly_dragged("oedematous", youngs_modulus_kpa, random.uniform(500.0, 650.0), random);
    }
  }
}

}  // namespace incise::laboratory
