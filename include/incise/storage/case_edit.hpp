#pragma once

#include <incise/core/error.hpp>
#include <incise/storage/case_file.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>
#include <string>

namespace incise {

/// New values of a case's fields by their dotted keys (plan.depth_mm), as JSON; null: the key is removed, and the field
/// has its default.
using CaseChanges = std::map<std::string, nlohmann::ordered_json>;

/// A case file is no longer the one that a change was made for (field "revision").
class StaleRevision : public CaseError {
 public:
  explicit StaleRevision(const std::filesystem::path& file);
};

/// Digest of a case file's bytes, by which an editor knows whether somebody else has changed it. @throws DataError
[[nodiscard]] std::string case_revision(const std::filesystem::path& file);

/// The text of a case file with some fields changed, block style, in the order of the old text; keys that are new come
/// last in their group. The comments above the first key stay; others are lost.
/// @param text  of a sound case file, or empty.  @throws DataError where it is not YAML; CaseError for a key that goes
/// through a value that is no group.
[[nodiscard]] std::string changed_case(const std::string& text, const CaseChanges& changes);

/// Changes a case file, all or nothing: what comes out has to be a sound case. Before a comment is lost, the file as
/// it was is kept beside it as `NAME.orig`, `NAME.orig.2`, …; its permissions stay.
/// @param revision  the case_revision that the changes were made for.
/// @returns the case as it is now.
/// @throws StaleRevision when the file was changed since; as read_case for values that do not fit; DataError where it
/// cannot be read or written, or another process is changing it.
CaseFile change_case(const std::filesystem::path& file, const std::string& revision, const CaseChanges& changes);

}  // namespace incise
