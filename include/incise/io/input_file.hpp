#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace incise {

/// Largest file that is read: well above a whole-body CT, but too small to fill the memory of a laboratory's machine.
inline constexpr std::uint64_t kLargestInputBytes = 8ULL << 30;
/// Largest case file; real ones have at most some ten kilobytes.
inline constexpr std::uint64_t kLargestCaseBytes = 4ULL << 20;

/// Returns the kind of thing at `path`, in words: "a file", "a folder", "a pipe" … Follows links.
/// @throws DataError if there is nothing.
[[nodiscard]] std::string kind_of_file(const std::filesystem::path& path);

/// Checks that `path` is a regular file of at most `most_bytes`. Every reader calls this before it opens a file,
/// because reading a pipe, device or socket may block or never end. Follows links.
/// @throws DataError if the file is missing, not regular, or too large.
void require_regular_file(const std::filesystem::path& path, std::uint64_t most_bytes = kLargestInputBytes);

/// As require_regular_file, but a folder passes too.
void require_file_or_folder(const std::filesystem::path& path);

/// Returns the first `most_bytes` bytes of a file, or all of a shorter one; nothing if it cannot be read.
[[nodiscard]] std::string beginning_of(const std::filesystem::path& path, std::size_t most_bytes);

/// Returns every file that reading `path` opens, in a fixed order. For a file: the file itself, then the data files
/// that its header names (ElementDataFile of .mhd and .mha; `data file` or `datafile` of .nhdr and .nrrd, in all three
/// forms; the .ele of a .node and vice versa), whether or not they exist. If the header cannot be read, only the file
/// itself: its reader reports the error. For a folder: the regular files directly in it, sorted.
/// @throws DataError as require_file_or_folder.
[[nodiscard]] std::vector<std::filesystem::path> input_files(const std::filesystem::path& path);

/// Returns the SHA-256 of an input as 64 hex digits; it changes with any byte that reading `path` would see. For a
/// folder: sha256_of_folder. For a file that opens no other: sha256_of_file. Otherwise: the hash of the lines
/// "<hash or missing>  <name>\n" over input_files(path).
/// @throws DataError as input_files, or if a file cannot be read.
[[nodiscard]] std::string sha256_of_input(const std::filesystem::path& path);

}  // namespace incise
