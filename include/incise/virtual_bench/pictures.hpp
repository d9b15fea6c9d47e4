#pragma once

#include <incise/bench_kit/pictures.hpp>
#include <incise/virtual_bench/bench_cut.hpp>
#include <incise/virtual_bench/body.hpp>

namespace incise {

/// Returns the camera's colour and depth pictures of the stretched specimen.
[[nodiscard]] FrameShot shoot_frame(const BenchBody& body, const Mat4& T_camera_specimen);

/// Returns the photograph of a cut specimen.
/// @throws InvalidArgument for a cut of another body, or settings out of range.
[[nodiscard]] ColorPicture photograph(const BenchBody& body, const BenchCut& cut,
                                      const PhotographSettings& settings = {});

}  // namespace incise
