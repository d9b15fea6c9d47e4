#pragma once

#include "support/data_dir.hpp"
#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace incise::testing {

inline std::filesystem::path write_file(const std::filesystem::path& path, std::string_view content) {
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

}  // namespace incise::testing
