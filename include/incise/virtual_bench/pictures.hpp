#pragma once

#include <incise/bench_kit/pictures.hpp>
#include <incise/virtual_bench/bench_cut.hpp>
#include <incise/virtual_bench/body.hpp>

namespace incise {

/// The stretched specimen as the camera sees it.
[[nodiscard]] FrameShot shoot_frame(const BenchBody& body, const Mat4& T_camera_specimen);

/// The photograph of a cut specimen.
[[nodiscard]] ColorPicture photograph(const BenchBody& body, const BenchCut& cut,
                                      const PhotographSettings& settings = {});

}  // namespace incise
