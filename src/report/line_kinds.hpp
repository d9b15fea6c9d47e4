#pragma once

#include <incise/report/report_data.hpp>

#include <string_view>

namespace incise {

/// Name and colour of a kind of curve, the same in still pictures, in the 3D view and in its legend.
struct LineLook {
  std::string_view label;
  std::string_view color;  ///< #rrggbb
};

[[nodiscard]] constexpr LineLook look_of(LineKind kind) {
  switch (kind) {
    case LineKind::TumorEdge:
      return {"tumour edge", "#00b386"};
    case LineKind::IntendedPath:
      return {"intended path", "#111111"};
    case LineKind::CorrectedPath:
      return {"corrected path", "#1f8fe0"};
    case LineKind::KerfMidLine:
      return {"kerf mid-line", "#ffb000"};
  }
  return {"line", "#111111"};
}

}  // namespace incise
