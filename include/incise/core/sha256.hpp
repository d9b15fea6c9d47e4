#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace incise {

/// SHA-256 (FIPS 180-4) of bytes that come piece by piece. @throws Error when the library that computes it fails.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;
  void add(const void* data, std::size_t size);
  /// Of all that was added, as 64 lower-case hex digits. To be asked for once.
  [[nodiscard]] std::string hex_digits();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// SHA-256 of a text as 64 lower-case hex digits.
[[nodiscard]] std::string sha256_of_text(std::string_view text);

}  // namespace incise
