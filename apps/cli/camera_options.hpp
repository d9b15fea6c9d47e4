#pragma once

#include <incise/geometry/types.hpp>
#include <incise/imaging/depth_camera.hpp>
#include <incise/imaging/photo_scale.hpp>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace incise::cli {

/// Intrinsics as JSON: width, height, fx, fy, cx, cy, depth_scale (metres for one count, as librealsense has it);
/// optional: distortion [k1, k2, p1, p2, k3], depth {the same without depth_scale} and T_color_depth where the depth
/// picture is not laid onto the colour picture. @throws DataError naming the key.
[[nodiscard]] DepthCamera read_depth_camera(const std::filesystem::path& file);

/// How a photograph's scale is given: exactly one way.
struct ScaleOptions {
  double mm_per_pixel = 0.0;
  std::string ruler;
  std::optional<double> ruler_mm;
  std::vector<double> two_points;
  std::vector<double> rectangle;
  std::vector<double> rectangle_mm;
  [[nodiscard]] int ways() const;
  [[nodiscard]] bool is_given() const { return ways() > 0; }
};
void add_scale_options(CLI::App& verb, ScaleOptions& options);
struct FoundScale {
  PhotoScale scale;
  nlohmann::ordered_json summary;
  std::vector<Vec2> marks_px;
  std::optional<Ruler> ruler;  ///< that the scale was read from
};
/// @throws CaseError unless exactly one way is given; DataError where the ruler is not found.
[[nodiscard]] FoundScale scale_of(const ScaleOptions& options, const ColorPicture& picture,
                                  const std::filesystem::path& name);

}  // namespace incise::cli
