#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace incise {

/// The form of a specimen id, in words for a message.
inline constexpr std::string_view kSpecimenIdForm = "1 to 64 letters, digits, '.', '_' and '-', not beginning with '-'";

/// Whether a text is a valid specimen id: 1 to 64 letters, digits, '.', '_' and '-', not beginning with '-'.
/// Every result carries the id of its specimen, to keep files of different specimens apart. The id is the case's
/// `specimen_id` or, without one, `ct-` or `mesh-` and the first 12 hex digits of the SHA-256 of the scan or mesh.
[[nodiscard]] bool is_specimen_id(std::string_view text);

/// Returns the id of a specimen whose case gives none. @param sha256  of its scan or mesh, hexadecimal
[[nodiscard]] std::string specimen_id_of_scan(std::string_view sha256);
[[nodiscard]] std::string specimen_id_of_mesh(std::string_view sha256);

/// Whether incise wrote this manifest.json: it is a JSON object with `version`, `commit` and `instruction_set`. Other
/// programs use the same file name.
[[nodiscard]] bool is_own_manifest(const std::filesystem::path& file);

/// Returns the specimen id of a file: of JSON, its key `specimen_id`; of a `.ply`, a comment; of a robot program
/// (`.script`), its header. Any other file, or one of these without an id, has the id in the manifest that belongs to
/// it: the one beside it, or the one that lists it, in its folder or the folder above. A folder has the id in its
/// manifest. Empty: not stated, or no such file.
/// @throws DataError if the id is not valid, or the file is not valid JSON.
[[nodiscard]] std::string specimen_id_of(const std::filesystem::path& path);

/// Whether two ids are of different specimens. False if one is empty, and for `ct-…` with `mesh-…`, which may be the
/// scan and the mesh of one specimen.
[[nodiscard]] bool are_of_different_specimens(std::string_view one, std::string_view other);

/// Checks that a file is not of another specimen than `id`. @param whose  owner of `id`, for the message: "the path's"
/// @throws DataError if are_of_different_specimens is true for the file's id and `id`, or as specimen_id_of.
void require_same_specimen(const std::filesystem::path& file, std::string_view id, std::string_view whose);

/// Returns the specimen id that the files share; empty if none states one.
/// @throws DataError for the first file of another specimen than the files before it, or as specimen_id_of.
[[nodiscard]] std::string common_specimen_id(std::span<const std::filesystem::path> files);

}  // namespace incise
