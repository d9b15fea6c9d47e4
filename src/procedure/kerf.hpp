#pragma once

#include <incise/procedure/incision.hpp>

namespace incise {

/// Measures what a cut left behind and enters it in `result`: mid-line of the kerf in the stretched reference, inner edge and tumour
/// edge in the final configuration, whether a ring closed. Uses result.record and result.final_state.
void measure_kerf(const TissueModel& model, const TissueState& stretched, const ToolPath& path, const IncisionSettings& settings,
                  IncisionResult& result);

}  // namespace incise
