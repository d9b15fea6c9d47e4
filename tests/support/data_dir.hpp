#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace incise::testing {

/// The folder of shared test data that INCISE_DATA_DIR names, if it names one that exists.
inline std::optional<std::filesystem::path> data_dir() {
  const char* folder = std::getenv("INCISE_DATA_DIR");
  if (folder == nullptr || !std::filesystem::is_directory(folder)) return std::nullopt;
  return std::filesystem::path(folder);
}

}  // namespace incise::testing

/// Skips the test, loudly, unless the shared data are there.
#define INCISE_NEEDS_DATA_DIR()                                                                       \
  if (!::incise::testing::data_dir()) GTEST_SKIP() << "INCISE_DATA_DIR does not name the folder of shared test data"
