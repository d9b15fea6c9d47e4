#pragma once

namespace incise {

/// Returns whether a factorisation that ended with this status of CHOLMOD found the matrix positive definite.
/// @throws InvalidArgument for a status that does not tell: memory ran out, or CHOLMOD failed.
[[nodiscard]] bool is_positive_definite(int cholmod_status);

}  // namespace incise
