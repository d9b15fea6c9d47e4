#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/entry_folder.hpp>
#include <incise/io/input_file.hpp>

namespace incise {

namespace {

bool begins_as_an_entry(const std::filesystem::path& file) {
  return kCacheMagic.starts_with(beginning_of(file, kCacheMagic.size()));  // a truncated entry is damaged, not foreign
}

}  // namespace

EntryFolder::EntryFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status own = fs::symlink_status(folder_, error);
  if (!fs::exists(own)) return;
  if (!fs::is_directory(own)) {
    throw DataError(folder_, "", fs::is_symlink(own) ? "a link" : "no folder", "a folder for the cache, or nothing");
  }
  for (fs::recursive_directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
    if (at->path().extension() != ".bin") continue;
    const fs::file_status status = at->symlink_status();
    const char* found = fs::is_symlink(status)                ? "a link"
                        : !fs::is_regular_file(status)        ? "no regular file"
                        : !begins_as_an_entry(at->path())     ? "a file of another origin"
                                                              : nullptr;
    if (found != nullptr) throw DataError(at->path(), "", found, "an entry of the cache", "Move it elsewhere");
  }
}

std::optional<std::string> EntryFolder::load(const std::string& name) {
  const std::filesystem::path file = place_of(name);
  if (!std::filesystem::exists(file)) return std::nullopt;
  return read_text(file);
}

void EntryFolder::save(const std::string& name, const std::string& bytes) {
  make_folder(place_of(name).parent_path());
  write_atomically(place_of(name), bytes);
}

void EntryFolder::remove(const std::string& name) {
  std::error_code error;
  std::filesystem::remove(place_of(name), error);
  if (error) throw DataError(place_of(name), "", system_reason(error), "an entry that can be removed");
}

}  // namespace incise
