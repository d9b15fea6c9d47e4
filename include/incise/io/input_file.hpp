#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace incise {

/// Largest file that is read at all: well above a whole-body CT, below what would fill a laboratory's machine.
inline constexpr std::uint64_t kLargestInputBytes = 8ULL << 30;
/// Largest case file: the longest sound one has some ten kilobytes.
inline constexpr std::uint64_t kLargestCaseBytes = 4ULL << 20;

/// What lies there, in words: "a file", "a folder", "a pipe" … (links are followed). @throws DataError where there is
/// nothing.
[[nodiscard]] std::string kind_of_file(const std::filesystem::path& path);

/// Every reader looks at a file through this before it opens it: a pipe, a device or a socket may never end or never begin.
/// @throws DataError where there is no such file, where it is a folder or anything but a regular file (links are followed), and where it is
///         larger than `most_bytes`.
void require_regular_file(const std::filesystem::path& path, std::uint64_t most_bytes = kLargestInputBytes);

/// The same for what may be a folder of files, too.
void require_file_or_folder(const std::filesystem::path& path);

/// Every file that reading `path` opens, in a fixed order: the file itself, and what its header names beside it (ElementDataFile of .mhd and
/// .mha; data file or datafile of .nhdr and .nrrd, in all three forms; the .ele of a .node and the reverse). A folder: every regular file
/// directly in it. A file that is named and not there is listed all the same. Of a header that cannot be read the file alone is listed:
/// whoever reads it says what is wrong.
/// @throws DataError as require_file_or_folder.
[[nodiscard]] std::vector<std::filesystem::path> input_files(const std::filesystem::path& path);

/// SHA-256 over the contents of input_files(path): of one file its own hash, else of the lines "<hash or missing>
/// <name>\n"; of a folder that of sha256_of_folder. It changes with any byte that reading `path` would see. @throws
/// DataError as input_files, or where a file cannot be read.
[[nodiscard]] std::string sha256_of_input(const std::filesystem::path& path);

}  // namespace incise
