#pragma once

#include <incise/geometry/types.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace incise::io_detail {

/// Returns a word as messages show it: in quotes, cut to 40 bytes, unprintable bytes as '?'.
[[nodiscard]] std::string shown_word(std::string_view word);

/// Reads the text of a file word by word or line by line, and names the line in errors. Owns neither text nor path.
class TextCursor {
 public:
  /// @param comment  character that begins a comment, which ends with the line; 0: no comments
  TextCursor(const std::filesystem::path& path, std::string_view text, char comment = 0)
      : path_(path), text_(text), comment_(comment) {}

  /// Whether only blanks and comments remain; skips them.
  [[nodiscard]] bool is_at_end();
  /// Returns the next word. @throws DataError at the end of the file, naming `expected`.
  std::string_view word(std::string_view expected);
  /// Returns the next word on this line; nothing if there is none.
  std::optional<std::string_view> word_on_line();
  /// Returns the rest of the current line without its end, and moves to the next line.
  std::string_view line();
  /// Returns the next word as a finite number. @throws DataError naming the line and `what` otherwise.
  double number(std::string_view what);
  /// Returns the next word as an integer in [low, high]. @throws DataError otherwise.
  long long integer(std::string_view what, long long low, long long high);
  /// Returns the next word as a count, at most the number of bytes left, since each item needs at least one byte.
  /// @throws DataError otherwise.
  std::size_t count(std::string_view what);
  /// Reads the next word, which must be `keyword` in upper or lower case. @throws DataError otherwise.
  void require(std::string_view keyword);
  /// Returns the next `size` bytes unchanged. @throws DataError if fewer are left.
  std::string_view bytes(std::size_t size, std::string_view what);

  [[nodiscard]] std::size_t bytes_left() const { return text_.size() - at_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// @throws DataError "path: line n: found …, expected …"
  [[noreturn]] void fail(std::string found, std::string expected, std::string hint = "") const;

 private:
  void skip_blanks(bool over_line_ends);

  const std::filesystem::path& path_;
  std::string_view text_;
  char comment_;
  std::size_t at_ = 0;
  std::size_t word_at_ = 0;  ///< start of the last word; `fail` names its line
};

/// Reads three finite coordinates.
Vec3 read_point(TextCursor& cursor, std::string_view what);

}  // namespace incise::io_detail
