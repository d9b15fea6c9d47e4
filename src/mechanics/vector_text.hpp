#pragma once

#include <incise/geometry/types.hpp>

#include <fmt/format.h>

#include <string>

namespace incise {

/// "[1, 0, 0]", for messages.
inline std::string text_of(const Vec3& v) {
  return fmt::format("[{:g}, {:g}, {:g}]", v[0], v[1], v[2]);
}

}  // namespace incise
