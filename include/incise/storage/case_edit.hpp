#pragma once

#include <incise/core/error.hpp>
#include <incise/storage/case_file.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>
#include <string>

namespace incise {

/// New values of a case's fields as JSON, by dotted keys such as plan.depth_mm. Null removes the key, which restores
/// the field's default.
using CaseChanges = std::map<std::string, nlohmann::ordered_json>;

/// Thrown if a case file has changed since the revision that an edit was made for (field "revision").
class StaleRevision : public CaseError {
 public:
  explicit StaleRevision(const std::filesystem::path& file);
};

/// Returns the SHA-256 of a case file's bytes, by which an editor notices that somebody else has changed the file.
/// @throws DataError if it cannot be read.
[[nodiscard]] std::string case_revision(const std::filesystem::path& file);

/// Returns the text of a case file with some fields changed: YAML in block style, in the order of the old text, new
/// keys last in their group. Keeps the comments above the first key; other comments are lost.
/// @param text  a valid case file, or empty
/// @throws DataError if it is not YAML; CaseError for a key within a value that is no group.
[[nodiscard]] std::string changed_case(const std::string& text, const CaseChanges& changes);

/// Changes a case file, all or nothing; the result must be a valid case. If a comment would be lost, keeps a copy of
/// the old file beside it as `NAME.orig`, `NAME.orig.2`, …. Keeps the file's permissions.
/// @param revision  the case_revision that the changes were made for
/// @returns the changed case.
/// @throws StaleRevision if the file has changed since; as changed_case and parse_case for changes that do not fit;
///         DataError if the file cannot be read or written, or if another process holds a lock on its folder.
CaseFile change_case(const std::filesystem::path& file, const std::string& revision, const CaseChanges& changes);

}  // namespace incise
