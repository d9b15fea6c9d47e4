#include "steps/camera_file.hpp"

#include <incise/core/error.hpp>
#include <incise/core/nearest_name.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/transform_json.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace incise::steps {
namespace {

using Json = nlohmann::ordered_json;

const Json& member(const Json& document, const std::string& key, const std::filesystem::path& file,
                   const std::string& at) {
  if (!document.is_object()) throw DataError(file, at, "no JSON object", "an object with " + key);
  const auto found = document.find(key);
  if (found == document.end()) throw DataError(file, at + "/" + key, "nothing", "this key");
  return *found;
}

double number(const Json& document, const std::string& key, const std::filesystem::path& file, const std::string& at,
              bool above_zero) {
  const Json& value = member(document, key, file, at);
  if (!value.is_number()) throw DataError(file, at + "/" + key, value.dump(), "a number");
  const double result = value.get<double>();
  if (!std::isfinite(result) || (above_zero && result <= 0.0))
    throw DataError(file, at + "/" + key, value.dump(), above_zero ? "a number above 0" : "a finite number");
  return result;
}

int pixels(const Json& document, const std::string& key, const std::filesystem::path& file, const std::string& at) {
  constexpr int kMost = 100000;
  const double value = number(document, key, file, at, true);
  if (value != std::floor(value) || value > kMost)
    throw DataError(file, at + "/" + key, document[key].dump(),
                    fmt::format("a whole number of pixels, at most {}", kMost));
  return static_cast<int>(value);
}

/// The principal point lies in the picture, or not far beside it where the picture was cropped.
double middle(const Json& document, const std::string& key, const std::filesystem::path& file, const std::string& at,
              int size) {
  const double value = number(document, key, file, at, false);
  if (!(value >= -size && value <= 2.0 * size))
    throw DataError(file, at + "/" + key, document[key].dump(), fmt::format("a place from {} to {}", -size, 2 * size));
  return value;
}

void require_known(const Json& document, const std::vector<std::string>& keys, const std::filesystem::path& file,
                   const std::string& at) {
  if (!document.is_object()) return;  // reported by its reader
  for (const auto& [key, value] : document.items()) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    throw DataError(file, at + "/" + key, "an unknown key", fmt::format("one of {}", fmt::join(keys, ", ")),
                    did_you_mean(key, keys));
  }
}

CameraIntrinsics intrinsics_in(const Json& document, const std::filesystem::path& file, const std::string& at) {
  CameraIntrinsics camera;
  camera.width = pixels(document, "width", file, at);
  camera.height = pixels(document, "height", file, at);
  camera.fx = number(document, "fx", file, at, true);
  camera.fy = number(document, "fy", file, at, true);
  camera.cx = middle(document, "cx", file, at, camera.width);
  camera.cy = middle(document, "cy", file, at, camera.height);
  const auto distortion = document.find("distortion");
  if (distortion == document.end()) return camera;
  const bool is_list = distortion->is_array() && distortion->size() == 5 &&
                       std::all_of(distortion->begin(), distortion->end(), [](const Json& k) { return k.is_number(); });
  if (!is_list) throw DataError(file, at + "/distortion", distortion->dump(), "[k1, k2, p1, p2, k3]");
  for (std::size_t i = 0; i < 5; ++i) camera.distortion[i] = (*distortion)[i].get<double>();
  return camera;
}

}  // namespace

DepthCamera read_depth_camera(const std::filesystem::path& file) {
  constexpr double kMmPerMetre = 1000.0;
  const Json document = read_json(file);
  const std::vector<std::string> of_camera{"width", "height", "fx", "fy", "cx", "cy", "distortion"};
  std::vector<std::string> all = of_camera;
  all.insert(all.end(), {"depth", "depth_scale", "T_color_depth", "T_robot_camera", "note"});
  require_known(document, all, file, "");
  if (document.contains("depth")) require_known(document["depth"], of_camera, file, "/depth");
  DepthCamera camera;
  camera.color = intrinsics_in(document, file, "");
  camera.depth = document.contains("depth") ? intrinsics_in(document["depth"], file, "/depth") : camera.color;
  camera.depth_unit_mm = kMmPerMetre * number(document, "depth_scale", file, "", true);
  if (document.contains("T_color_depth")) camera.T_color_depth = rigid_transform_in(document, "T_color_depth", file);
  return camera;
}

}  // namespace incise::steps
