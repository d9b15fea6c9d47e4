#pragma once

#include <incise/geometry/types.hpp>

namespace incise {

/// The approach of a test's tool: straight down.
inline const Vec3 kDown(0, 0, -1);

}  // namespace incise
