#pragma once

#include <incise/geometry/tool_path.hpp>
#include <incise/workflow/case.hpp>
#include <incise/workflow/products.hpp>

#include <filesystem>

namespace incise::steps {

/// A simulated cut as its folder keeps it: incision.json, and the errors of both its lines, measured again. Frames, log
/// and final state are left out. @throws DataError for a damaged file.
[[nodiscard]] SimulatedCut read_kept_cut(const std::filesystem::path& folder, const Case& settings,
                                         const ToolPath& plan);

}  // namespace incise::steps
