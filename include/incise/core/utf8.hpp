#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace incise {

/// Returns the offset of the first byte that is not part of well-formed UTF-8 (no overlong forms, no surrogates, at
/// most U+10FFFF); nullopt if there is none. Names and titles are written to JSON files, which must be UTF-8.
[[nodiscard]] std::optional<std::size_t> first_not_utf8(std::string_view text);

/// Returns the beginning of a text: at most `bytes` bytes, with no character cut in two.
[[nodiscard]] std::string_view utf8_prefix(std::string_view text, std::size_t bytes);

}  // namespace incise
