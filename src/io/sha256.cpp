#include <incise/core/error.hpp>
#include <incise/io/input_file.hpp>
#include <incise/io/manifest.hpp>

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>

namespace incise {
namespace {

namespace fs = std::filesystem;

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
    if (!context_ || EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) != 1)
      throw Error("SHA-256 is not available");
  }
  void add(const void* data, std::size_t size) {
    if (EVP_DigestUpdate(context_.get(), data, size) != 1) throw Error("SHA-256 failed");
  }
  std::string hex_digits() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    if (EVP_DigestFinal_ex(context_.get(), digest.data(), &size) != 1) throw Error("SHA-256 failed");
    std::string text;
    for (unsigned i = 0; i < size; ++i) text += fmt::format("{:02x}", digest[i]);
    return text;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

std::string sha256_of_text(std::string_view text) {
  Sha256 hash;
  hash.add(text.data(), text.size());
  return hash.hex_digits();
}

std::string sha256_of_file(const fs::path& path) {
  require_regular_file(path);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw DataError(path, "", "a file that cannot be opened", "a readable file");
  Sha256 hash;
  std::vector<char> block(1 << 16);
  while (stream.read(block.data(), static_cast<std::streamsize>(block.size())) || stream.gcount() > 0) {
    hash.add(block.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) throw DataError(path, "", "a read error", "a readable file");
  return hash.hex_digits();
}

std::string sha256_of_folder(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) throw DataError(folder, "", "no such folder", "a readable folder");
  std::vector<std::string> names;
  fs::recursive_directory_iterator entry(folder, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (entry->is_regular_file()) names.push_back(entry->path().lexically_relative(folder).generic_string());
  }
  if (error) throw DataError(folder, "", error.message(), "a readable folder");
  std::sort(names.begin(), names.end());
  std::string lines;
  for (const auto& name : names) lines += fmt::format("{}  {}\n", sha256_of_file(folder / name), name);
  return sha256_of_text(lines);
}

}  // namespace incise
