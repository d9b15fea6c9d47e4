#pragma once

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace incise::studio {

/// Files and folders below some roots, by ids that a browser may be given: it names a file only by an id, and gets an
/// id only of what lies within a root, whatever links and `..` there are.
class FileIds {
 public:
  /// @param roots  folders; at least one.  @param salt  a secret, so that ids cannot be guessed.
  /// @throws DataError for a root that is no folder.
  FileIds(const std::vector<std::filesystem::path>& roots, std::string salt);

  /// A folder as the call `files` gives it (docs/decisions/0009-studio.md): folders first, then by name; hidden files
  /// and what leads out of the roots are left out, and so is what follows the first 5000 entries (`left_out` says how
  /// many).
  /// @param id  of the folder; empty: the first root.  @throws CaseError for an id that is of no folder; DataError
  /// where it cannot be read.
  [[nodiscard]] nlohmann::ordered_json list(const std::string& id);

  /// The path of an id. It is checked again: it must still exist and lie within a root.
  /// @throws CaseError (field `field`) for an unknown id; DataError for one whose file has gone or leads out now.
  [[nodiscard]] std::filesystem::path path_of(const std::string& id, const std::string& field) const;

  /// The id of a path. @throws DataError for one that is not there or lies outside the roots.
  [[nodiscard]] std::string id_of(const std::filesystem::path& path);

 private:
  [[nodiscard]] bool is_within(const std::filesystem::path& canonical) const;
  [[nodiscard]] std::string note(const std::filesystem::path& canonical);

  std::vector<std::filesystem::path> roots_;  ///< canonical
  std::string salt_;
  std::map<std::string, std::filesystem::path> paths_;  ///< canonical, by id
};

}  // namespace incise::studio
