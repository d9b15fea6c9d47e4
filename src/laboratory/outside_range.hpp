#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace incise::laboratory {

/// A specimen unlike those that an experiment calibrates on.
struct OutsideKind {
  std::string name;  ///< stiff_and_slipped, stiff, oedematous, scarred, soft
  std::vector<std::pair<std::string, double>>
      given;  ///< hidden parameters of the bench that are not drawn from the seed
};

/// The paper's failed specimen: stiff, and slipped out of its clamp.
[[nodiscard]] OutsideKind failed_specimen();

/// The index-th of a series: stiff, oedematous, scarred, oedematous, soft in turn; how far out is drawn from the seed.
/// They differ from the calibration's in the suture's pull, all but the stiffer half of the soft ones far. Stiff and
/// soft tissue is cut as other tissue is, and a correction helps it. Oedematous and scarred tissue hardly sticks to the
/// electrode and surrounds a hard, deep tumour, of which `assess` compares nothing: it is dragged less far than its
/// stiffness lets one expect. Oedematous tissue is harmed by that, scarred tissue at times.
[[nodiscard]] OutsideKind outside_specimen(std::uint64_t seed, std::uint64_t index);

}  // namespace incise::laboratory
