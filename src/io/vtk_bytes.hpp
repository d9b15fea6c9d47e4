#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace incise::io_detail {

/// Bytes behind raw or base64 text, taken from the front. Base64 may be a chain of separately padded pieces, as VTK
/// writes.
class ByteSource {
 public:
  ByteSource(std::string_view text, bool is_base64) : text_(text), is_base64_(is_base64) {}
  /// The next `size` bytes; nothing if there are fewer, or at a character that is not base64.
  [[nodiscard]] std::optional<std::string> take(std::size_t size);
  /// An upper bound of the bytes left.
  [[nodiscard]] std::size_t bytes_left() const { return text_.size() - at_ + pending_.size(); }

 private:
  bool decode_quad();

  std::string_view text_;
  bool is_base64_;
  std::size_t at_ = 0;
  std::string pending_;
};

/// Number of bytes of a VTK type name ("Float64", "Int32", …), 0 for anything else.
[[nodiscard]] std::size_t size_of_vtk_type(std::string_view type);
/// Bytes as numbers of a VTK type. @pre the size divides.
[[nodiscard]] std::vector<double> numbers_from_bytes(std::string bytes, std::string_view type, bool is_big_endian);

/// zlib streams. Inflating gives nothing unless exactly `size` bytes come out.
[[nodiscard]] std::optional<std::string> inflated(std::string_view bytes, std::size_t size);
[[nodiscard]] std::string deflated(std::string_view bytes);

}  // namespace incise::io_detail
