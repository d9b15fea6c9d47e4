#pragma once

#include <string>
#include <string_view>

namespace incise {

/// A measured number with the digits that it deserves in a table: two decimals, one from 100 on and none from 1000 on;
/// three for a share, ratio or score below 1, which has no unit. Whole numbers stand in full; what rounds to nothing is
/// "0". A true minus sign. @param unit  "mm", "s"; empty: none. @throws InvalidArgument for a number that is not
/// finite.
[[nodiscard]] std::string measure_text(double value, std::string_view unit);

}  // namespace incise
