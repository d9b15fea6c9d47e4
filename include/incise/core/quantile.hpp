#pragma once

#include <span>

namespace incise {

/// Returns the value below which a share of a sample lies, in the sample's unit; linear between neighbouring values.
/// @param sorted  ascending, at least one value.  @param share  in [0, 1].
/// @throws InvalidArgument for an empty sample or a share outside its range.
[[nodiscard]] double quantile(std::span<const double> sorted, double share);

}  // namespace incise
