#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace incise::io_detail {

/// The shortest decimal text that reads back to the same double; independent of the locale.
[[nodiscard]] std::string number_text(double value);

/// The number that the whole of `text` spells (a leading + is fine; nan and inf are numbers here); nothing if it spells
/// none.
[[nodiscard]] std::optional<double> to_number(std::string_view text);

/// The integer that the whole of `text` spells.
[[nodiscard]] std::optional<long long> to_integer(std::string_view text);

/// The text with blanks and control characters removed at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// ASCII letters made small.
[[nodiscard]] std::string lower_case(std::string_view text);

}  // namespace incise::io_detail
