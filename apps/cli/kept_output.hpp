#pragma once

#include "options.hpp"

#include <filesystem>
#include <functional>

namespace incise::cli {

/// Runs what fills an output folder part by part. Stopped on request, it says that finished parts are kept. A folder
/// that it made and that holds no file yet when it ends by an error is removed.
/// @throws StagesKept in place of Cancelled where something is kept; whatever `run` throws.
int with_parts_kept(const std::filesystem::path& output, const std::function<int()>& run);

}  // namespace incise::cli
