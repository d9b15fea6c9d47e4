#pragma once

#include <incise/geometry/picture.hpp>
#include <incise/virtual_bench/bench_cut.hpp>
#include <incise/virtual_bench/body.hpp>

#include <cstdint>
#include <vector>

namespace incise {

/// A pinhole without distortion; pixel (u, v) has its centre at (u, v).
struct Pinhole {
  int width = 1280;
  int height = 720;
  double focal_px = 650.0;  ///< of an Intel D405 at this size: 89 degrees across
  double cx = 639.5;
  double cy = 359.5;
};

/// One shot of the RGB-D camera, both pictures of the same pinhole.
struct FrameShot {
  Pinhole camera;
  ColorPicture color;
  DepthPicture depth;
  double depth_unit_mm = 0.1;
  std::vector<std::uint8_t> is_specimen;  ///< width * height: what a person would crop as the specimen
};

/// The stretched specimen as the camera sees it, tumour's edge marked in green; with the depth's noise, scale and
/// holes.
[[nodiscard]] FrameShot shoot_frame(const BenchBody& body, const Mat4& T_camera_specimen);

/// What the photograph shows.
struct PhotographSettings {
  double mm_per_pixel = 0.03;  ///< > 0
  double border_mm = 12.0;     ///< around inner edge and tumour, >= 6: room for the kerf and the ruler
  double line_mm = 0.35;       ///< of the red line, > 0
  double green_line_mm = 0.5;  ///< of the green line, > 0
};
/// The photograph of a cut specimen from straight above, tool out, still stretched: tissue with its grain, the kerf, a
/// red line drawn along the kerf's inner edge (open where the kerf is), a green one along the tumour's edge, a
/// ruler with millimetre ticks, and pale tissue where heat reached farther than the electrode's diameter.
[[nodiscard]] ColorPicture photograph(const BenchBody& body, const BenchCut& cut,
                                      const PhotographSettings& settings = {});

}  // namespace incise
