#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/sha256.hpp>
#include <incise/core/verdict.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise {

/// A file or folder that a result was made from.
struct ManifestInput {
  std::string path;
  std::string sha256;
};
inline void describe(Visitor& v, ManifestInput& i) {
  v("path", i.path, "Path of the input, as given.");
  v("sha256", i.sha256, "SHA-256 of the input's contents.");
}

/// Content of `manifest.json` in an output folder: everything needed to repeat the run.
struct Manifest {
  std::string version;               ///< of incise
  std::string commit;                ///< of the sources; "unknown" outside a repository
  std::string command;               ///< the command line
  std::string settings_json = "{}";  ///< the settings in full, defaults included, as JSON text
  std::uint64_t seed = 0;
  int threads = 1;
  std::string instruction_set;  ///< portable, avx2 or avx512
  std::vector<ManifestInput> inputs;
  double wall_s = 0.0;
  std::string machine;  ///< see machine_description
  std::string specimen_id = {};  ///< the specimen of the folder's files (specimen_id.hpp); empty: none, or several
  std::optional<Verdict> verdict = {};  ///< of the run that filled the folder, if it has one
};
void describe(Visitor& v, Manifest& m);

/// Writes `folder/manifest.json`, all or nothing.
/// @pre settings_json is JSON; wall_s is finite and not negative (InvalidArgument).
/// @throws DataError if the file cannot be written.
void write_manifest(const std::filesystem::path& folder, const Manifest& manifest);

/// Returns the path of the manifest of a single-file result: `FILE.manifest.json`, where FILE includes its extension.
[[nodiscard]] std::filesystem::path manifest_beside(const std::filesystem::path& file);

/// Writes manifest_beside(file), with the file's SHA-256 under `result_sha256`. @pre, @throws as write_manifest; also
/// DataError if `file` does not exist yet.
void write_manifest_beside(const std::filesystem::path& file, const Manifest& manifest);

/// Reads `folder/manifest.json`; ignores keys that this version does not know. @throws DataError naming the place.
[[nodiscard]] Manifest read_manifest(const std::filesystem::path& folder);

/// Returns the SHA-256 of a file's bytes, as 64 hex digits (core/sha256.hpp hashes text).
/// @throws DataError if the file is missing, not regular, or unreadable.
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path& path);
/// Returns the SHA-256 of a folder: the hash of the lines "<sha256>  <relative/path>\n", sorted by path, over all
/// regular files below it. It depends on their names and contents only, not on the order in which the disk lists them.
/// @throws DataError if the folder is missing or unreadable.
[[nodiscard]] std::string sha256_of_folder(const std::filesystem::path& folder);

/// Returns the processor's model, its logical cores and the compiler in one line:
/// "Intel(R) Xeon(R) …, 2 logical cores, g++ 12.2.0".
[[nodiscard]] std::string machine_description();

}  // namespace incise
