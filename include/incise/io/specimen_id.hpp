#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace incise {

/// What a specimen's id has to be, in words for a message.
inline constexpr std::string_view kSpecimenIdForm = "1 to 64 letters, digits, '.', '_' and '-', not beginning with '-'";

/// Which specimen a file is of travels with it, so that files of two specimens are not taken for those of one. An id is
/// what the case says (`specimen_id`), else it follows from the data: `ct-` or `mesh-` and the first 12 hex digits of
/// their SHA-256.
/// @returns whether a text may be one: 1 to 64 of letters, digits, '.', '_' and '-', not beginning with '-'.
[[nodiscard]] bool is_specimen_id(std::string_view text);

/// The id of a specimen that nobody named. @param sha256  of its scan or mesh, hexadecimal.
[[nodiscard]] std::string specimen_id_of_scan(std::string_view sha256);
[[nodiscard]] std::string specimen_id_of_mesh(std::string_view sha256);

/// Whether a manifest.json is one that incise wrote: an object with `version`, `commit` and `instruction_set`. Another
/// program's may have the same name.
[[nodiscard]] bool is_own_manifest(const std::filesystem::path& file);

/// The id that a file carries: JSON its key `specimen_id`, PLY a comment, a robot program its header; any other file,
/// and those that carry none, that of the manifest which lists them, in their folder or beside them. A folder: that of
/// its manifest. Empty: not stated.
/// @throws DataError for an id that is none, or JSON that is none.
[[nodiscard]] std::string specimen_id_of(const std::filesystem::path& path);

/// Whether two ids say different specimens. One that is not stated says nothing; neither do `ct-…` against `mesh-…`,
/// which may be scan and mesh of one.
[[nodiscard]] bool are_of_different_specimens(std::string_view one, std::string_view other);

/// @throws DataError for a file that carries another specimen's id than `id`. @param whose  of the id, for the message:
/// "the path's".
void require_same_specimen(const std::filesystem::path& file, std::string_view id, std::string_view whose);

/// What all files say that state one; empty: none does. @throws DataError for one that says another than those before
/// it.
[[nodiscard]] std::string common_specimen_id(std::span<const std::filesystem::path> files);

}  // namespace incise
