#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/sha256.hpp>
#include <incise/core/verdict.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// A file or folder that a result was made from.
struct ManifestInput {
  std::string path;
  std::string sha256;
};
inline void describe(Visitor& v, ManifestInput& i) {
  v("path", i.path, "As it was given.");
  v("sha256", i.sha256, "Of its contents.");
}

/// All that is needed to repeat a run: `manifest.json` of an output folder.
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
  std::string specimen_id = {};  ///< whose the folder's files are (specimen_id.hpp); empty: nobody's, or several's
  std::optional<Verdict> verdict = {};  ///< of the run that filled the folder, where it has one
};
void describe(Visitor& v, Manifest& m);

/// Writes `folder/manifest.json`, all or nothing. @pre settings_json is JSON, wall_s is finite and not negative.
/// @throws DataError if the file cannot be written.
void write_manifest(const std::filesystem::path& folder, const Manifest& manifest);

/// Where the manifest of a result that is one file is: `FILE.manifest.json`, FILE with its ending.
[[nodiscard]] std::filesystem::path manifest_beside(const std::filesystem::path& file);

/// Writes it, with the digest of the file that it belongs to (`result_sha256`). @pre the file is written
void write_manifest_beside(const std::filesystem::path& file, const Manifest& manifest);

/// Reads `folder/manifest.json`; keys that this version does not know are ignored. @throws DataError naming the place.
[[nodiscard]] Manifest read_manifest(const std::filesystem::path& folder);

/// SHA-256 of a file's bytes (of a text: core/sha256.hpp). @throws DataError if it is missing, is a folder, or cannot be read.
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path& path);
/// Of a folder: the hash of the lines "<sha256>  <relative/path>\n", sorted by path, over all regular files below it.
/// So it changes with any content or name, and not with the order in which a disk lists them. @throws DataError if it
/// is missing or unreadable.
[[nodiscard]] std::string sha256_of_folder(const std::filesystem::path& folder);

/// The processor's model, logical cores and compiler in one line: "Intel(R) Xeon(R) …, 2 logical cores, g++ 12.2.0".
[[nodiscard]] std::string machine_description();

}  // namespace incise
