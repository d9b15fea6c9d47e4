#pragma once

#include "options.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace incise::cli {

/// Keeps parts out of a folder that something else filled. @param signs  files or folders of which one is there as soon
/// as anything of ours is. @param what  the parts, for the message: "a series".
/// @throws DataError for a folder that is not empty and has none of them.
void require_own_or_empty(const std::filesystem::path& folder, const std::vector<std::string>& signs, const std::string& what);

/// Runs what fills an output folder part by part, and keeps other runs out of it meanwhile. Stopped on request, it says that finished parts are kept. A folder
/// that it made and that holds no file yet when it ends by an error is removed.
/// @throws StagesKept in place of Cancelled where something is kept; whatever `run` throws.
int with_parts_kept(const std::filesystem::path& output, const std::function<int()>& run);

}  // namespace incise::cli
