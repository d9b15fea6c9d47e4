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

/// Returns the index-th specimen of a series: stiff, oedematous, scarred, oedematous, soft in turn. How far outside it
/// lies is drawn from the seed. The pull of the suture differs from the calibration's: far for all kinds but the
/// stiffer half of the soft ones. Stiff and soft tissue is cut like other tissue, and a correction helps. Oedematous
/// and scarred tissue hardly sticks to the electrode and surrounds a hard, deep tumour, which `assess` does not
/// compare. It is dragged less far than its stiffness suggests. So a correction harms oedematous tissue, and scarred
/// tissue at times.
[[nodiscard]] OutsideKind outside_specimen(std::uint64_t seed, std::uint64_t index);

}  // namespace incise::laboratory
