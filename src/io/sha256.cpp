#include <incise/core/error.hpp>
#include <incise/core/sha256.hpp>
#include <incise/io/input_file.hpp>
#include <incise/io/manifest.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <vector>

namespace incise {
namespace fs = std::filesystem;

std::string sha256_of_file(const fs::path& path) {
  require_regular_file(path);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw DataError(path, "", "a file that cannot be opened", "a readable file");
  Sha256 hash;
  std::vector<char> block(1 << 16);
  while (stream.read(block.data(), static_cast<std::streamsize>(block.size())) || stream.gcount() > 0) {
    hash.add(block.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) throw DataError(path, "", "a read error", "a readable file");
  return hash.hex_digits();
}

std::string sha256_of_folder(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) throw DataError(folder, "", "no such folder", "a readable folder");
  std::vector<std::string> names;
  fs::recursive_directory_iterator entry(folder, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (entry->is_regular_file()) names.push_back(entry->path().lexically_relative(folder).generic_string());
  }
  if (error) throw DataError(folder, "", system_reason(error), "a readable folder");
  std::sort(names.begin(), names.end());
  std::string lines;
  for (const auto& name : names) lines += fmt::format("{}  {}\n", sha256_of_file(folder / name), name);
  return sha256_of_text(lines);
}

}  // namespace incise
