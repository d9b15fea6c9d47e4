#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace incise::io_detail {

/// Returns the shortest decimal text that reads back to the same double, whatever the locale.
[[nodiscard]] std::string number_text(double value);

/// Parses the whole of `text` as a number; nothing if it is none. Accepts a leading +, nan and inf.
[[nodiscard]] std::optional<double> to_number(std::string_view text);

/// Parses the whole of `text` as an integer; nothing if it is none. Accepts a leading +.
[[nodiscard]] std::optional<long long> to_integer(std::string_view text);

/// Returns the text without blanks and control characters at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// Returns the text with ASCII letters in lower case.
[[nodiscard]] std::string lower_case(std::string_view text);

}  // namespace incise::io_detail
