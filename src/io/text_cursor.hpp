#pragma once

#include <incise/geometry/types.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace incise::io_detail {

/// A word as it appears in a message: in quotes, cut to 40 bytes, unprintable bytes as '?'.
[[nodiscard]] std::string shown_word(std::string_view word);

/// Walks through the text of a file word by word or line by line and knows the line it is at, so that whatever is wrong
/// is reported with its place. Does not own the text.
class TextCursor {
 public:
  /// @param comment  from this character to the end of the line everything is skipped; 0 = no comments.
  TextCursor(const std::filesystem::path& path, std::string_view text, char comment = 0)
      : path_(path), text_(text), comment_(comment) {}

  /// Whether only blanks and comments are left.
  [[nodiscard]] bool is_at_end();
  /// Next word. @throws DataError at the end of the file, naming `expected`.
  std::string_view word(std::string_view expected);
  /// Next word if there is one on this line.
  std::optional<std::string_view> word_on_line();
  /// The rest of the current line, without its end; moves to the next line.
  std::string_view line();
  /// Next word as a finite number. @throws DataError naming the line and `what` otherwise.
  double number(std::string_view what);
  /// Next word as an integer in [low, high].
  long long integer(std::string_view what, long long low, long long high);
  /// Next word as a count that the rest of the file can hold (each item needs at least one byte).
  std::size_t count(std::string_view what);
  /// Next word, which must be this one (letters may differ in case).
  void require(std::string_view keyword);
  /// The next `size` bytes, as they are. @throws DataError if fewer are left.
  std::string_view bytes(std::size_t size, std::string_view what);

  [[nodiscard]] std::size_t position() const { return at_; }
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
  std::size_t word_at_ = 0;  ///< where the last word began: the place that `fail` names
};

/// Three finite coordinates.
Vec3 read_point(TextCursor& cursor, std::string_view what);

}  // namespace incise::io_detail
