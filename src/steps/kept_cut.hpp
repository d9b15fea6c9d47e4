#pragma once

#include <incise/geometry/tool_path.hpp>
#include <incise/workflow/case.hpp>
#include <incise/workflow/products.hpp>

#include <filesystem>

namespace incise::steps {

/// Reads a simulated cut from its folder: incision.json, and the errors of both its lines, which are measured again.
/// Frames, log and final state are left out. @throws DataError for a damaged file.
[[nodiscard]] SimulatedCut read_kept_cut(const std::filesystem::path& folder, const Case& settings,
                                         const ToolPath& plan);

}  // namespace incise::steps
