#pragma once

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace incise::studio {

/// Ids of the files and folders below some roots, for a browser. The browser can name a file only by its id, and
/// receives ids only of files within a root, whatever links and `..` there are.
class FileIds {
 public:
  /// @param roots  folders; at least one.  @param salt  a secret, so that ids cannot be guessed.
  /// @throws DataError for a root that is not a folder.
  FileIds(const std::vector<std::filesystem::path>& roots, std::string salt);

  /// Returns a folder in the form of the call `files` (docs/decisions/0009-studio.md): folders first, then by name.
  /// Hidden files and links that lead out of the roots are left out, and so are all entries after the first 5000
  /// (`left_out` says how many).
  /// @param id  of the folder; empty: the first root. @throws CaseError for an id that is not a folder's; DataError for
  /// a folder that cannot be read.
  [[nodiscard]] nlohmann::ordered_json list(const std::string& id);

  /// Returns the path of an id, after checking that it still exists and lies within a root.
  /// @throws CaseError (field `field`) for an unknown id; DataError if the file is gone or now leads out of the roots.
  [[nodiscard]] std::filesystem::path path_of(const std::string& id, const std::string& field) const;

  /// Returns the id of a path. @throws DataError for a path that does not exist or lies outside the roots.
  [[nodiscard]] std::string id_of(const std::filesystem::path& path);

 private:
  [[nodiscard]] bool is_within(const std::filesystem::path& canonical) const;
  [[nodiscard]] std::string note(const std::filesystem::path& canonical);

  std::vector<std::filesystem::path> roots_;  ///< canonical
  std::string salt_;
  std::map<std::string, std::filesystem::path> paths_;  ///< canonical, by id
};

}  // namespace incise::studio
