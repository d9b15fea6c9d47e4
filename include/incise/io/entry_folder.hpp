#pragma once

#include <incise/core/cache.hpp>

#include <filesystem>

namespace incise {

/// Entries of a cache as files, one each: `FOLDER/NAME.bin`. The folder may be moved or copied.
class EntryFolder : public EntryStore {
 public:
  /// @param folder  is made when the first entry is saved. @throws DataError where it is a link or no folder, or holds
  /// a link, a folder or a file of another origin in place of an entry: nothing of anybody else's is replaced.
  explicit EntryFolder(std::filesystem::path folder);

  std::optional<std::string> load(const std::string& name) override;
  void save(const std::string& name, const std::string& bytes) override;
  void remove(const std::string& name) override;
  bool holds(const std::string& name) override { return std::filesystem::exists(place_of(name)); }

  /// Where an entry is or would be.
  [[nodiscard]] std::filesystem::path place_of(const std::string& name) const override {
    return folder_ / (name + ".bin");
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace incise
