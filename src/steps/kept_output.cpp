#include <incise/core/error.hpp>
#include <incise/io/folder_lock.hpp>
#include <incise/steps/case_steps.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace incise::steps {
namespace {

bool holds_files(const std::filesystem::path& folder) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, ignored)) {
    if (entry.is_symlink(ignored) || !entry.is_directory(ignored)) return true;
  }
  return false;
}

}  // namespace

void require_own_or_empty(const std::filesystem::path& folder, const std::vector<std::string>& signs,
                          const std::string& what) {
  const bool is_own =
      std::ranges::any_of(signs, [&folder](const std::string& sign) { return std::filesystem::exists(folder / sign); });
  if (is_own || std::filesystem::is_empty(folder)) return;
  throw DataError(folder, "", fmt::format("a folder with files of another origin (no {})", fmt::join(signs, ", no ")),
                  fmt::format("a free name, an empty folder, or {} to continue", what),
                  "Choose another place for the output");
}

void with_parts_kept(const std::filesystem::path& output, const std::function<void()>& run) {
  std::error_code ignored;
  const bool was_there = std::filesystem::exists(output, ignored);
  const auto remove_if_new = [&] {
    if (!was_there) std::filesystem::remove_all(output, ignored);
  };
  const FolderLock lock(output);
  try {
    run();
  } catch (const Cancelled& error) {
    if (holds_files(output))
      throw StagesKept(error.what(), fmt::format("finished results are kept in {}", output.string()));
    remove_if_new();
    throw;
  } catch (...) {
    if (!holds_files(output)) remove_if_new();
    throw;
  }
}

}  // namespace incise::steps
