#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace incise {

/// SHA-256 (FIPS 180-4) of bytes that are added piece by piece. @throws Error if OpenSSL fails.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  void add(const void* data, std::size_t size);
  /// Returns the hash of all bytes added, as 64 lower-case hex digits. Call it once, after the last `add`.
  [[nodiscard]] std::string hex_digits();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Returns the SHA-256 of a text as 64 lower-case hex digits.
[[nodiscard]] std::string sha256_of_text(std::string_view text);

}  // namespace incise
