#pragma once

#include <span>

namespace incise {

/// The value below which a share of a sample lies, linear between neighbours in order; in their unit.
/// @param sorted  ascending, at least one.  @param share  0 to 1.  @throws InvalidArgument otherwise.
[[nodiscard]] double quantile(std::span<const double> sorted, double share);

}  // namespace incise
