#pragma once

#include <incise/mechanics/tissue.hpp>
#include <incise/procedure/incision_progress.hpp>

#include <filesystem>
#include <string>

namespace incise {

/// Writes the progress of an incision to a file, all or nothing.
/// @param key   of the product that the incision will be: the hash of all that it depends on.
/// @param maker which program made it, for a person.
/// @throws DataError if the file cannot be written.
void write_checkpoint(const std::filesystem::path& file, const std::string& key, const std::string& maker,
                      const IncisionProgress& progress);

/// A checkpoint as read and found whole: an incision that can go on.
///
/// The file, little-endian: "INCISECP", version (4 bytes), length of the whole file (8), key and maker (each its length in 8 bytes, then
/// the text), the fields of IncisionProgress in the order of its declaration (numbers as 8 bytes, IEEE 754 or two's complement; flags,
/// causes and marks of live tets as 1; before each list its count), and the SHA-256 of all that as 64 hex digits.
class CheckpointFile {
 public:
  /// @throws DataError naming the byte: no checkpoint, of another version, cut short, or damaged (the SHA-256 does not fit).
  explicit CheckpointFile(const std::filesystem::path& file);

  [[nodiscard]] const std::string& key() const { return key_; }
  [[nodiscard]] const std::string& maker() const { return maker_; }
  /// @param model  that the incision was begun on.
  /// @throws DataError naming byte and field where the content does not fit the model.
  [[nodiscard]] IncisionProgress progress(const TissueModel& model) const;

 private:
  std::filesystem::path file_;
  std::string bytes_;
  std::string key_;
  std::string maker_;
  std::size_t fields_start_ = 0;  ///< in bytes_
};

}  // namespace incise
