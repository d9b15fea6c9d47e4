#pragma once

#include <string>
#include <string_view>

namespace incise {

/// Returns a measured number with sensible digits for a table: two decimals, one from 100 on and none from 1000 on;
/// three for a share, ratio or score below 1, which has no unit. Whole numbers have no decimals, and a number that
/// rounds to zero is "0". The minus sign is a true one.
/// @param unit  "mm", "s"; empty: none. It only decides the digits; the text does not contain it.
/// @throws InvalidArgument for a number that is not finite.
[[nodiscard]] std::string measure_text(double value, std::string_view unit);

}  // namespace incise
