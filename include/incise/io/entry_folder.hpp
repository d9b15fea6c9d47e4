#pragma once

#include <incise/core/cache.hpp>

#include <filesystem>

namespace incise {

/// Stores each entry of a cache as a file, `FOLDER/NAME.bin`. The folder may be moved or copied.
class EntryFolder : public EntryStore {
 public:
  /// @param folder  created when the first entry is saved
  /// @throws DataError if it is a link or no folder, or if anything in it whose name ends in `.bin` is a link, a folder
  ///         or a file from another program: only entries of a cache may be replaced.
  explicit EntryFolder(std::filesystem::path folder);

  std::optional<std::string> load(const std::string& name) override;
  void save(const std::string& name, const std::string& bytes) override;
  void remove(const std::string& name) override;
  bool holds(const std::string& name) override { return std::filesystem::exists(place_of(name)); }

  /// Returns the file of an entry, whether or not it exists.
  [[nodiscard]] std::filesystem::path place_of(const std::string& name) const override {
    return folder_ / (name + ".bin");
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace incise
