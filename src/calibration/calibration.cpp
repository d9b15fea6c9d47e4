#include <incise/calibration/calibration.hpp>

#include <algorithm>

namespace incise {

bool is_usable(const Calibration& calibration) {
  if (!calibration.fit) return calibration.score_percent.value_or(0.0) > 0.0;
  const std::vector<SpecimenFit>& specimens = calibration.fit->specimens;
  const auto closed =
      std::count_if(specimens.begin(), specimens.end(), [](const SpecimenFit& s) { return !s.simulated_mm.empty(); });
  return 2 * closed > static_cast<std::ptrdiff_t>(specimens.size() + calibration.left_out.size());
}

}  // namespace incise
