#include "described_options.hpp"
#include "option_checks.hpp"
#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/steps/camera_steps.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace incise::cli {
namespace {

constexpr const char* kNoMark = "none";
constexpr double kLargestMarginMm = 50.0;  // a wider ring leaves the organ

struct TrackArguments : steps::TrackRequest {
  std::string mark_name = "green";
  std::string axis = "approach";
  std::vector<const CLI::Option*> of_mark;  ///< options without a meaning if there is no mark
};

int run_track(const TrackArguments& arguments, const CommonOptions& options) {
  steps::TrackRequest request = arguments;
  request.output = options.required_output("tracked");
  refuse_input_as_output("-o", request.output, {request.color, request.depth, request.intrinsics, request.camera});
  if (request.has_plan && request.camera.empty()) {
    throw CaseError("command line", "--plan", "no --camera",
                    "T_robot_camera: a path for the robot must be in the robot's frame");
  }
  if (request.is_open && request.has_plan && request.margin_mm > 0.0) {
    throw CaseError("command line", "--margin-mm", fmt::format("{} mm for an open mark", request.margin_mm),
                    "0: the cut follows an open mark");
  }
  request.mark.reset();
  if (arguments.mark_name != kNoMark) request.mark = value_named<InkColor>(arguments.mark_name);
  for (const CLI::Option* option : arguments.of_mark) {
    if (!request.mark && option->count() > 0)
      throw CaseError("command line", option->get_name(), "an option about the mark, with --mark none", "a mark");
  }
  if (arguments.axis == "normal") request.plan.axis_mode = AxisMode::SurfaceNormal;
  return run_step(options, [&](const auto& context) { return steps::track_mark(request, context); });
}

}  // namespace

void add_track(Application& application) {
  auto [verb, a] = application.add_verb<TrackArguments>(
      "track", "",
      "incise track color.png depth.png --intrinsics d405.json --mark green --camera "
      "robot_camera.json --plan -o tracked",
      run_track);
  verb->add_option("rgb", a.color, "Colour picture (.png, .jpg, .tif), or an organised coloured cloud (.ply)")
      ->required();
  verb->add_option("depth", a.depth, "Depth picture, 16 bits (.png, .tif); none with a cloud");
  verb->add_option("--intrinsics", a.intrinsics,
                   "JSON: width, height, fx, fy, cx, cy, depth_scale (m), distortion, depth {...}, T_color_depth");
  verb->add_option("--camera", a.camera,
                   "JSON with T_robot_camera, for results in the robot's frame; without it, they are in the colour "
                   "camera's");
  verb->add_option("--mark", a.mark_name, "Colour of the mark; none: the cloud alone")
      ->check(CLI::IsMember({"red", "green", kNoMark}));
  const std::vector<CLI::Option*> before = verb->get_options();
  add_choice(*verb, "--edge", a.edge, "Contour of the mark: its middle, or its inner border");
  verb->add_option(
          "--max-gap-mm", a.max_gap_mm,
          "A ring with a longer gap is open. A gap is known only to 0.18 mm and 2 pixels: a ring whose gap is longer "
          "by at most that is taken as closed, with a warning")
      ->check(zero_or_more("--max-gap-mm"));
  verb->add_option("--max-hole-mm", a.lift.max_hole_mm, "Longest stretch without depth that is bridged")
      ->check(zero_or_more("--max-hole-mm"));
  verb->add_flag("--open", a.is_open, "The mark is an open line");
  verb->add_flag("--plan", a.has_plan, "Plan an incision: path.json in the robot's frame");
  verb->add_option("--margin-mm", a.margin_mm, "Distance from the mark to the incision; 0: along the mark")
      ->check(between("--margin-mm", 0.0, kLargestMarginMm));
  add_options_of(*verb, a.plan, "depth_mm", "speed_mm_s", "waypoints");
  verb->add_option("--axis", a.axis, "Tool axis: along the camera's view, or against the surface's normal")
      ->check(CLI::IsMember({"approach", "normal"}));
  for (const CLI::Option* option : verb->get_options()) {
    if (std::ranges::find(before, option) == before.end()) a.of_mark.push_back(option);
  }
  verb->add_option("--ply-width", a.ply_width, "Columns of an organised cloud whose header does not state them")
      ->check(above_zero("--ply-width"));
  verb->add_option("--ply-unit-mm", a.ply_unit_mm, "Unit of the organised cloud, mm: 1000 for metres")
      ->check(above_zero("--ply-unit-mm"));
}

}  // namespace incise::cli
