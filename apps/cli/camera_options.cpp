#include "camera_options.hpp"

#include "option_checks.hpp"

#include <incise/core/error.hpp>
#include <incise/core/problem_text.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/nearest_name.hpp>
#include <incise/io/transform_json.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace incise::cli {
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
  if (!document.is_object()) return;  // told by whoever reads it
  for (const auto& [key, value] : document.items()) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    throw DataError(file, at + "/" + key, "an unknown key", fmt::format("one of {}", fmt::join(keys, ", ")),
                    fmt::format("Did you mean '{}'?", nearest_name(key, keys)));
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

Json shape_json(const RulerShape& shape) {
  const auto figure = [](const RulerFigure& f) { return Json{{"value", f.value}, {"standard_error", f.error}}; };
  return {{"spacing_change", figure(shape.spacing_change)},
          {"convergence_deg", figure(shape.convergence_deg)},
          {"skew_deg", figure(shape.skew_deg)},
          {"end_stretch", figure(shape.end_stretch)},
          {"bow", figure(shape.bow)}};
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

void add_scale_options(CLI::App& verb, ScaleOptions& options) {
  verb.add_option("--mm-per-pixel", options.mm_per_pixel, "Scale of the photograph")
      ->check(above_zero("--mm-per-pixel"));
  verb.add_option("--ruler", options.ruler, "Find the scale in the photograph: a ruler's ticks, or a solid scale bar")
      ->check(name_of_any<RulerKind>());
  verb.add_option("--ruler-mm", options.ruler_mm,
                  "From one of the ruler's finest ticks to the next, by default 1 mm; of a bar: its length")
      ->check(above_zero("--ruler-mm"));
  verb.add_option("--two-points", options.two_points, "Scale from two pixels and their distance: U V U V MM")
      ->expected(5);
  verb.add_option("--rectangle", options.rectangle,
                  "Scale and perspective from the corners of a rectangle: lower left, lower right, upper right, upper "
                  "left, as U V pairs")
      ->expected(8);
  verb.add_option("--rectangle-mm", options.rectangle_mm, "Its width and height")->expected(2);
}

int ScaleOptions::ways() const {
  return (mm_per_pixel > 0.0) + !ruler.empty() + !two_points.empty() + !rectangle.empty();
}

FoundScale scale_of(const ScaleOptions& options, const ColorPicture& picture, const std::filesystem::path& name) {
  const int ways = options.ways();
  if (ways != 1) {
    throw CaseError("command line", "scale", ways == 0 ? "no scale" : fmt::format("{} scales", ways),
                    "one of --mm-per-pixel, --ruler, --two-points, --rectangle");
  }
  if (options.ruler == to_string(RulerKind::Bar) && !options.ruler_mm)
    throw CaseError("command line", "--ruler bar", "no length", "the bar's length: --ruler-mm");
  FoundScale found;
  try {
    if (options.mm_per_pixel > 0.0) {
      found.scale = scale_from_mm_per_pixel(options.mm_per_pixel, picture.height);
      found.summary["source"] = "mm_per_pixel";
    } else if (!options.two_points.empty()) {
      const auto& p = options.two_points;
      found.marks_px = {{p[0], p[1]}, {p[2], p[3]}};
      found.scale = scale_from_two_points(found.marks_px[0], found.marks_px[1], p[4], picture.height);
      found.summary["source"] = "two_points";
    } else if (!options.rectangle.empty()) {
      if (options.rectangle_mm.size() != 2)
        throw CaseError("command line", "--rectangle-mm", "nothing", "the rectangle's width and height");
      for (std::size_t i = 0; i < 4; ++i)
        found.marks_px.emplace_back(options.rectangle[2 * i], options.rectangle[2 * i + 1]);
      found.scale = scale_from_rectangle({found.marks_px[0], found.marks_px[1], found.marks_px[2], found.marks_px[3]},
                                         options.rectangle_mm[0], options.rectangle_mm[1]);
      found.summary["source"] = "rectangle";
    }
  } catch (const InvalidArgument& error) {
    throw CaseError("command line", "scale", "points or lengths that give none", "ones that do", as_sentence(error));
  }
  if (options.ruler.empty()) return found;
  const Ruler ruler = find_ruler(picture, value_named<RulerKind>(options.ruler), options.ruler_mm, name);
  found.scale = scale_from_mm_per_pixel(ruler.mm_per_pixel, picture.height);
  found.marks_px = ruler.marks_px;
  found.summary = {{"source", "ruler"}, {"marks", ruler.marks_px.size()}, {"error_percent", ruler.error_percent}};
  found.summary["shape"] = ruler.shape ? shape_json(*ruler.shape) : Json(nullptr);
  found.ruler = ruler;
  return found;
}

}  // namespace incise::cli
