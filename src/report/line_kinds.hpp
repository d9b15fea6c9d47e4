#pragma once

#include <incise/report/report_data.hpp>

#include <array>
#include <string_view>

namespace incise {

/// Name and colour of a kind of curve, the same in still pictures, in the 3D view and in its legend.
struct LineLook {
  std::string_view label;
  std::string_view color;  ///< #rrggbb
};

[[nodiscard]] constexpr LineLook look_of(LineKind kind) {
  constexpr std::array<LineLook, 4> kLooks{{{"tumour edge", "#00b386"},
                                            {"intended path", "#111111"},
                                            {"corrected path", "#1f8fe0"},
                                            {"kerf mid-line", "#ffb000"}}};
  return kLooks[static_cast<std::size_t>(kind)];
}

}  // namespace incise
