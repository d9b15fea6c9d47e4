#pragma once

#include <incise/geometry/types.hpp>

#include <filesystem>

namespace incise::testing {

/// First and last positions of a SOFA state dump (gzip text: lines "T= t", "X= …", "V= …").
struct SofaState {
  Points first;
  Points last;
};
[[nodiscard]] SofaState read_sofa_state(const std::filesystem::path& path);

}  // namespace incise::testing
