#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace incise {

/// Offset in bytes of the first byte that is not part of well-formed UTF-8 (no overlong forms, no surrogates, at most U+10FFFF); nothing where
/// all of it is. Names and titles are written into JSON files, which hold nothing else.
[[nodiscard]] std::optional<std::size_t> first_not_utf8(std::string_view text);

/// The beginning of a text: at most so many bytes, and no character cut in two.
[[nodiscard]] std::string_view utf8_prefix(std::string_view text, std::size_t bytes);

}  // namespace incise
