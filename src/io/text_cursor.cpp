#include "io/text_cursor.hpp"

#include "io/number_text.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise::io_detail {
std::string shown_word(std::string_view word) {
  std::string text(word.substr(0, 40));
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126) c = '?';
  }
  return fmt::format("'{}{}'", text, word.size() > 40 ? "…" : "");
}

void TextCursor::skip_blanks(bool over_line_ends) {
  while (at_ < text_.size()) {
    const char c = text_[at_];
    if (comment_ != 0 && c == comment_) {
      while (at_ < text_.size() && text_[at_] != '\n') ++at_;
    } else if (static_cast<unsigned char>(c) <= ' ' && (c != '\n' || over_line_ends)) {
      ++at_;
    } else {
      return;
    }
  }
}

bool TextCursor::is_at_end() {
  skip_blanks(true);
  return at_ == text_.size();
}

std::optional<std::string_view> TextCursor::word_on_line() {
  skip_blanks(false);
  const std::size_t begin = at_;
  while (at_ < text_.size() && static_cast<unsigned char>(text_[at_]) > ' ' &&
         (comment_ == 0 || text_[at_] != comment_)) {
    ++at_;
  }
  if (at_ == begin) return std::nullopt;
  word_at_ = begin;
  return text_.substr(begin, at_ - begin);
}

std::string_view TextCursor::word(std::string_view expected) {
  skip_blanks(true);
  const auto found = word_on_line();
  if (!found) {
    word_at_ = text_.size();
    fail("the end of the file", std::string(expected));
  }
  return *found;
}

std::string_view TextCursor::line() {
  word_at_ = at_;
  const std::size_t end = std::min(text_.find('\n', at_), text_.size());
  std::string_view result = text_.substr(at_, end - at_);
  at_ = std::min(end + 1, text_.size());
  if (!result.empty() && result.back() == '\r') result.remove_suffix(1);
  return result;
}

double TextCursor::number(std::string_view what) {
  const std::string_view text = word(what);
  const auto value = to_number(text);
  if (!value || !std::isfinite(*value)) fail(shown_word(text), fmt::format("{}: a finite number", what));
  return *value;
}

long long TextCursor::integer(std::string_view what, long long low, long long high) {
  const std::string_view text = word(what);
  const auto value = to_integer(text);
  if (!value || *value < low || *value > high) {
    fail(shown_word(text), fmt::format("{}: an integer from {} to {}", what, low, high));
  }
  return *value;
}

std::size_t TextCursor::count(std::string_view what) {
  const std::string_view text = word(what);
  const auto value = to_integer(text);
  if (!value || *value < 0) fail(shown_word(text), fmt::format("{}: a count", what));
  if (static_cast<unsigned long long>(*value) > bytes_left()) {
    fail(fmt::format("{} {} in the last {} bytes", *value, what, bytes_left()), "a complete file",
         "It looks truncated.");
  }
  return static_cast<std::size_t>(*value);
}

void TextCursor::require(std::string_view keyword) {
  const std::string expected = fmt::format("'{}'", keyword);
  const std::string_view text = word(expected);
  if (lower_case(text) != lower_case(keyword)) fail(shown_word(text), expected);
}

std::string_view TextCursor::bytes(std::size_t size, std::string_view what) {
  if (size > bytes_left()) {
    throw DataError(path_, fmt::format("byte {}", at_), fmt::format("{} bytes up to the end of the file", bytes_left()),
                    fmt::format("{} bytes of {}", size, what), "It looks truncated.");
  }
  const std::string_view result = text_.substr(at_, size);
  word_at_ = at_;
  at_ += size;
  return result;
}

void TextCursor::fail(std::string found, std::string expected, std::string hint) const {
  const auto end = text_.begin() + static_cast<std::ptrdiff_t>(std::min(word_at_, text_.size()));
  const auto line = 1 + std::count(text_.begin(), end, '\n');
  throw DataError(path_, fmt::format("line {}", line), std::move(found), std::move(expected), std::move(hint));
}

Vec3 read_point(TextCursor& cursor, std::string_view what) {
  const double x = cursor.number(what);
  const double y = cursor.number(what);
  const double z = cursor.number(what);
  return {x, y, z};
}

}  // namespace incise::io_detail
