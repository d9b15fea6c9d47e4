#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace incise::fuzz {

/// Stands between the files of an input that is made of several; see Reader::files.
inline constexpr std::string_view kNextFile = "\n=== next file ===\n";

/// One reader of untrusted files. It holds when reading any bytes at all returns, or throws CaseError or DataError.
struct Reader {
  std::string name;                ///< also that of its corpus/ folder
  std::string words;               ///< name of its dictionary in words/, without .dict
  std::vector<std::string> files;  ///< names under which the parts of an input are laid down; a missing part is empty
  std::function<void(const std::filesystem::path& first)> read;
  double share = 1.0;  ///< of the cases that each reader gets: less where a case starts a process of its own
};

/// Those of this program.
[[nodiscard]] const std::vector<Reader>& readers();

/// Lays the bytes down as the reader's files and reads them.
/// @throws whatever the reader threw, but for CaseError and DataError.
void read_bytes(const Reader& reader, std::string_view bytes);

}  // namespace incise::fuzz
