// The entry of libFuzzer and of our own driver: `--reader=NAME` says which reader the bytes are for, `--list` names
// all.

#include "reader.hpp"

#include <incise/core/error.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace incise::fuzz {
namespace {

namespace fs = std::filesystem;

/// A folder of this process in memory, gone when the process ends by itself.
class OwnFolder {
 public:
  OwnFolder() : owner_(::getpid()) {
    const fs::path root = fs::is_directory("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path();
    path_ = root / ("incise_fuzz_" + std::to_string(owner_));
    fs::create_directories(path_);
  }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;
  ~OwnFolder() {
    std::error_code ignored;
    if (::getpid() == owner_) fs::remove_all(path_, ignored);
  }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  pid_t owner_;
  fs::path path_;
};

void lay_down(const fs::path& file, std::string_view bytes) {
  const int to = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (to < 0) std::abort();
  while (!bytes.empty()) {
    const ssize_t written = ::write(to, bytes.data(), bytes.size());
    if (written <= 0) std::abort();
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  ::close(to);
}

const Reader* chosen = nullptr;

/// One line for each reader that reads in this process: its name and that of its dictionary.
[[noreturn]] void list_readers() {
  for (const Reader& reader : readers()) {
    if (reader.share == 1.0) std::printf("%s %s\n", reader.name.c_str(), reader.words.c_str());
  }
  std::exit(0);
}

}  // namespace

void read_bytes(const Reader& reader, std::string_view bytes) {
  static const OwnFolder folder;
  const fs::path place = folder.path() / reader.name;
  if (!fs::is_directory(place)) fs::create_directory(place);
  for (const std::string& name : reader.files) {
    const std::size_t end = bytes.find(kNextFile);
    lay_down(place / name, bytes.substr(0, end));
    bytes = end == std::string_view::npos ? std::string_view() : bytes.substr(end + kNextFile.size());
  }
  try {
    reader.read(place / reader.files.front());
  } catch (const CaseError&) {
  } catch (const DataError&) {
  }
}

}  // namespace incise::fuzz

extern "C" int LLVMFuzzerInitialize(int* count, char*** words) {
  const char* name = nullptr;
  for (int i = 1; i < *count; ++i) {
    if (std::strncmp((*words)[i], "--reader=", 9) == 0) name = (*words)[i] + 9;
    if (std::strcmp((*words)[i], "--list") == 0) incise::fuzz::list_readers();
  }
  for (const incise::fuzz::Reader& reader : incise::fuzz::readers()) {
    if (name != nullptr && reader.name == name) incise::fuzz::chosen = &reader;
  }
  if (incise::fuzz::chosen == nullptr) {
    std::fprintf(stderr, "--reader=NAME: found %s, expected one of", name == nullptr ? "nothing" : name);
    for (const incise::fuzz::Reader& reader : incise::fuzz::readers()) std::fprintf(stderr, " %s", reader.name.c_str());
    std::fprintf(stderr, "\n");
    std::exit(2);
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  incise::fuzz::read_bytes(*incise::fuzz::chosen, std::string_view(reinterpret_cast<const char*>(data), size));
  return 0;
}
