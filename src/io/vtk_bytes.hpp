#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace incise::io_detail {

/// Reads bytes from the front of raw or base64 text. Base64 may be a chain of separately padded pieces, as VTK writes.
class ByteSource {
 public:
  ByteSource(std::string_view text, bool is_base64) : text_(text), is_base64_(is_base64) {}
  /// Returns the next `size` bytes; nothing if there are fewer, or at a character that is not base64.
  [[nodiscard]] std::optional<std::string> take(std::size_t size);
  /// Returns an upper bound of the bytes left.
  [[nodiscard]] std::size_t bytes_left() const { return text_.size() - at_ + pending_.size(); }

 private:
  bool decode_quad();

  std::string_view text_;
  bool is_base64_;
  std::size_t at_ = 0;
  std::string pending_;
};

/// Returns the number of bytes of a VTK type ("Float64", "Int32", …), 0 for any other name.
[[nodiscard]] std::size_t size_of_vtk_type(std::string_view type);
/// Returns bytes as numbers of a VTK type. @pre the size of the type divides the number of bytes.
[[nodiscard]] std::vector<double> numbers_from_bytes(std::string bytes, std::string_view type, bool is_big_endian);

/// Decompress and compress zlib streams. `inflated` returns nothing unless the result has exactly `size` bytes.
[[nodiscard]] std::optional<std::string> inflated(std::string_view bytes, std::size_t size);
[[nodiscard]] std::string deflated(std::string_view bytes);

}  // namespace incise::io_detail
