#pragma once

#include <incise/report/report_data.hpp>

namespace incise {

/// Colours of the surfaces in a still picture; components in [0, 1].
namespace still {
inline const Vec3 kTissue(0.86, 0.60, 0.56);
inline const Vec3 kKerf(0.55, 0.13, 0.13);
inline const Vec3 kSteel(0.62, 0.66, 0.70);
}  // namespace still

/// Returns the scale of frame_png, px per mm, for lengths across the line of sight (the picture has no perspective).
/// @pre, @throws as frame_png.
[[nodiscard]] double frame_px_per_mm(const ReportAnimation& animation, std::size_t frame, const Vec3& approach,
                                     int width_px, int height_px);

}  // namespace incise
