#include "camera_options.hpp"
#include "option_checks.hpp"
#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/core/isa.hpp>
#include <incise/core/median.hpp>
#include <incise/core/problem_text.hpp>
#include <incise/core/version.hpp>
#include <incise/imaging/photo_contours.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/grid_cloud.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/transform_json.hpp>
#include <incise/planning/plan_marked_path.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace incise::cli {
namespace {

constexpr double kLargestMarginMm = 50.0;  // a wider ring leaves the organ

struct TrackArguments {
  std::filesystem::path color;
  std::filesystem::path depth;
  std::filesystem::path intrinsics;
  std::filesystem::path camera;
  std::string mark = "green";
  std::string edge = "middle";
  std::string axis = "approach";
  int ply_width = 0;
  double ply_unit_mm = 1.0;
  double max_gap_mm = LineSettings{}.max_gap_mm;
  double margin_mm = PlanSettings{}.lateral_margin_mm;
  LiftSettings lift;
  PlanSettings plan;
  bool is_open = false;
  bool has_plan = false;
};

struct Scene {
  ColorPicture picture;
  OrganizedCloud cloud;
  std::filesystem::path depth_name;
  std::vector<std::filesystem::path> inputs;
};

/// PCL writes `obj_info num_cols W`; other programs leave it to the user.
int columns_of(const GridCloud& grid, const TrackArguments& arguments) {
  const int given = arguments.ply_width;
  if (grid.columns == 0 && given == 0) {
    throw DataError(arguments.color, "header", "no obj_info num_cols",
                    "an organised cloud (rows and columns of a picture)", "Give its width with --ply-width.");
  }
  if (grid.columns > 0 && given > 0 && given != grid.columns) {
    throw CaseError("command line", "--ply-width", fmt::format("{}", given),
                    fmt::format("{}, as {} says itself", grid.columns, arguments.color.string()));
  }
  return given > 0 ? given : grid.columns;
}

/// Rows of that many places: as many as the file says, all of them whole.
int rows_of(const GridCloud& grid, int columns, const std::filesystem::path& file) {
  const std::size_t count = grid.places.size(), width = static_cast<std::size_t>(columns);
  if (columns < 2 || count % width != 0)
    throw DataError(file, "vertices", fmt::format("{} places in rows of {}", count, columns), "whole rows");
  if (grid.rows > 0 && count / width != static_cast<std::size_t>(grid.rows)) {
    throw DataError(file, "vertices", fmt::format("{} rows of {} places", count / width, columns),
                    fmt::format("{} rows, as num_rows says", grid.rows));
  }
  return static_cast<int>(count / width);
}

Scene scene_from_ply(const TrackArguments& arguments) {
  const GridCloud grid = read_grid_cloud(arguments.color);
  const TriMesh& cloud = grid.cloud;
  const int width = columns_of(grid, arguments);
  const int height = rows_of(grid, width, arguments.color);
  Scene scene{{}, {}, arguments.color, {arguments.color}};
  scene.picture = {width, height, {}};
  scene.cloud = {width, height, {}, {}};
  const char* const names[] = {"red", "green", "blue"};
  for (const char* name : names) {
    if (!cloud.point_data.contains(name))
      throw DataError(arguments.color, "header", fmt::format("no property {}", name),
                      "a coloured cloud: red, green, blue");
  }
  constexpr std::uint8_t kNoColor = 128;  // of a hole: grey is no ink
  for (const std::optional<std::size_t>& place : grid.places) {
    for (const char* name : names) {
      scene.picture.rgb.push_back(
          place ? static_cast<std::uint8_t>(std::clamp(cloud.point_data.at(name).values[*place], 0.0, 255.0))
                : kNoColor);
    }
    const Vec3 p = place ? Vec3(arguments.ply_unit_mm * cloud.vertices[*place]) : Vec3::Zero();
    scene.cloud.points.push_back(p);
    scene.cloud.is_measured.push_back(p.z() != 0.0 ? 1 : 0);
  }
  require_camera_frame(scene.cloud, arguments.color);
  return scene;
}

Scene scene_from_pictures(const TrackArguments& arguments) {
  if (arguments.intrinsics.empty())
    throw CaseError("command line", "--intrinsics", "nothing", "the cameras' intrinsics (JSON)");
  const DepthCamera camera = read_depth_camera(arguments.intrinsics);
  Scene scene{decode_picture(read_text(arguments.color), arguments.color),
              {},
              arguments.depth,
              {arguments.color, arguments.depth, arguments.intrinsics}};
  if (scene.picture.width != camera.color.width || scene.picture.height != camera.color.height) {
    throw DataError(
        arguments.color, "", fmt::format("{} x {} pixels", scene.picture.width, scene.picture.height),
        fmt::format("{} x {}, as {} says", camera.color.width, camera.color.height, arguments.intrinsics.string()));
  }
  const DepthPicture depth = decode_depth(read_text(arguments.depth), arguments.depth);
  try {
    scene.cloud = cloud_seen_in_color(depth, camera);
  } catch (const InvalidArgument& error) {
    throw fault_of_file(arguments.depth, "", error, "a depth picture that fits " + arguments.intrinsics.string());
  }
  return scene;
}

/// Median distance between neighbours in a row, in the middle of the picture: what one pixel covers of the tissue.
double mm_per_pixel(const OrganizedCloud& cloud, const std::filesystem::path& name) {
  std::vector<double> steps;
  for (int v = cloud.height / 5; v < cloud.height - cloud.height / 5; v += 3) {
    for (int u = cloud.width / 5; u + 1 < cloud.width - cloud.width / 5; u += 3) {
      const std::size_t i = cloud.index(u, v);
      if (cloud.is_measured[i] != 0 && cloud.is_measured[i + 1] != 0)
        steps.push_back((cloud.points[i + 1] - cloud.points[i]).head<2>().norm());
    }
  }
  if (steps.size() < 100)
    throw DataError(name, "", fmt::format("{} pixels with depth", cloud.measured()),
                    "depth over most of the picture's middle");
  const double middle = median(steps);
  constexpr double kFinestMm = 0.005, kCoarsestMm = 1.5;
  if (middle < kFinestMm || middle > kCoarsestMm) {
    throw DataError(name, "", fmt::format("pixels {:.4g} mm wide on the tissue", middle),
                    fmt::format("{} to {} mm", kFinestMm, kCoarsestMm), "Is depth_scale (metres for one count) right?");
  }
  return middle;
}

struct Tracked {
  MarkedLine line;
  LiftedLine lifted;
  TriMesh cloud;  ///< with the pixels' colours
  Vec3 approach = Vec3::UnitZ();
  Vec3 start = -Vec3::UnitY();  ///< the picture's top
};

Tracked tracked(const Scene& scene, const TrackArguments& arguments) {
  Tracked result;
  const LineSettings line{.edge = value_named<LineEdge>(arguments.edge),
                          .mm_per_pixel = mm_per_pixel(scene.cloud, scene.depth_name),
                          .max_gap_mm = arguments.max_gap_mm};
  result.line = find_marked_line(scene.picture, value_named<InkColor>(arguments.mark), line, arguments.color);
  result.lifted =
      lift_to_space(result.line.points_px, result.line.is_closed, scene.cloud, arguments.lift, scene.depth_name);
  DataArray red{1, {}}, green{1, {}}, blue{1, {}};
  for (std::size_t i = 0; i < scene.cloud.points.size(); ++i) {
    if (scene.cloud.is_measured[i] == 0) continue;
    result.cloud.vertices.push_back(scene.cloud.points[i]);
    red.values.push_back(scene.picture.rgb[3 * i]);
    green.values.push_back(scene.picture.rgb[3 * i + 1]);
    blue.values.push_back(scene.picture.rgb[3 * i + 2]);
  }
  result.cloud.point_data = {{"red", red}, {"green", green}, {"blue", blue}};
  if (result.line.is_closed)
    result.lifted.contour =
        start_farthest_along(counter_clockwise(result.lifted.contour, result.approach), result.start);
  return result;
}

void move_to_robot(Tracked& tracked, const Mat4& T_robot_camera) {
  const Mat3 R = T_robot_camera.topLeftCorner<3, 3>();
  const Vec3 t = T_robot_camera.topRightCorner<3, 1>();
  for (Vec3& p : tracked.lifted.contour.points) p = R * p + t;
  for (Vec3& p : tracked.cloud.vertices) p = R * p + t;
  tracked.approach = R * tracked.approach;
  tracked.start = R * tracked.start;
}

ToolPath planned(const Tracked& tracked, const TrackArguments& arguments, const std::filesystem::path& name) {
  MarkedPlan plan;
  plan.settings = arguments.plan;
  plan.settings.axis_mode = arguments.axis == "normal" ? AxisMode::SurfaceNormal : AxisMode::Approach;
  plan.settings.approach = tracked.approach;
  plan.settings.start_direction = tracked.start;
  plan.margin_mm = arguments.margin_mm;
  try {
    return plan_marked_path(tracked.lifted.contour, tracked.cloud.vertices, plan);
  } catch (const CaseError& error) {
    // The case file that it names is not the user's.
    const Complaint complaint = complaint_of(error.what(), "a measured surface all round the path");
    throw DataError(name, "", complaint.found, complaint.expected);
  } catch (const InvalidArgument& error) {
    throw fault_of_file(name, "", error, "a measured surface all round the path");
  }
}

/// Why the mark is not what was asked for.
std::string complaint_about(const MarkedLine& line, const ColorPicture& picture, const TrackArguments& arguments) {
  if (arguments.is_open) return "the mark is a closed ring, an open line was asked for";
  if (const std::optional<Vec2> end = end_at_rim_px(line, picture.width, picture.height)) {
    return fmt::format("the mark leaves the picture at pixel {:.0f}, {:.0f}: whether it is closed is not to be seen",
                       end->x(), end->y());
  }
  return fmt::format("the mark is not closed: a gap of {:.2f} mm, at most {} mm is bridged", line.longest_unseen_mm,
                     arguments.max_gap_mm);
}

/// A ring that was taken as closed although nobody knows that its gap is as short as was asked for.
std::optional<std::string> doubt_about(const MarkedLine& line, const TrackArguments& arguments) {
  const bool is_doubtful = line.is_closed && line.longest_unseen_mm > 0.0 &&
                           line.longest_unseen_mm + line.gap_tolerance_mm > arguments.max_gap_mm;
  if (!is_doubtful) return std::nullopt;
  return fmt::format(
      "the mark is taken as closed, with a gap of {:.2f} mm that is known to {:.2f} mm at this pixel size: "
      "it may be longer than --max-gap-mm {}",
      line.longest_unseen_mm, line.gap_tolerance_mm, arguments.max_gap_mm);
}

int run(const TrackArguments& arguments, const CommonOptions& options) {
  Console console(options.level());
  const std::filesystem::path folder = options.required_output("tracked");
  refuse_input_as_output("-o", folder, {arguments.color, arguments.depth, arguments.intrinsics, arguments.camera});
  if (arguments.has_plan && arguments.camera.empty()) {
    throw CaseError("command line", "--plan", "no --camera",
                    "T_robot_camera: a path for the robot must be in the robot's frame");
  }
  if (arguments.is_open && arguments.has_plan && arguments.margin_mm > 0.0) {
    throw CaseError("command line", "--margin-mm", fmt::format("{} mm for an open mark", arguments.margin_mm),
                    "0: an open mark is cut along");
  }
  Scene scene = arguments.depth.empty() ? scene_from_ply(arguments) : scene_from_pictures(arguments);
  Tracked found = tracked(scene, arguments);
  if (!arguments.camera.empty()) {
    move_to_robot(found, rigid_transform_in(read_json(arguments.camera), "T_robot_camera", arguments.camera));
    scene.inputs.push_back(arguments.camera);
  }
  const bool is_wanted = found.line.is_closed != arguments.is_open;
  std::optional<ToolPath> path;
  if (arguments.has_plan && is_wanted) path = planned(found, arguments, scene.depth_name);

  require_replaceable(folder);
  const std::string specimen_id = common_specimen_id(scene.inputs);
  AtomicFolder target(folder);
  write_contour_csv(target.path() / "contour.csv", found.lifted.contour);
  write_ply(target.path() / "cloud.ply", found.cloud, specimen_id);
  const std::string png = encode_png(draw_found(scene.picture, {&found.line}));
  write_atomically(target.path() / "found.png", png);
  nlohmann::ordered_json result;
  result["outcome"] = to_string(is_wanted ? Outcome::Success : Outcome::OpenLoop);
  result["points"] = found.lifted.contour.points.size();
  result["length_mm"] = length_mm(found.lifted.contour);
  result["closed_loop"] = found.line.is_closed;
  result["frame"] = arguments.camera.empty() ? "camera" : "robot";
  result["mark"] = arguments.mark;
  result["width_px"] = found.line.width_px;
  result["max_gap_mm"] = found.line.longest_unseen_mm;
  result["gap_tolerance_mm"] = found.line.gap_tolerance_mm;
  result["leaves_picture"] = end_at_rim_px(found.line, scene.picture.width, scene.picture.height).has_value();
  result["max_hole_mm"] = found.lifted.max_hole_mm;
  result["bridged_points"] = found.lifted.bridged_points;
  result["cloud_points"] = found.cloud.vertices.size();
  result["contour"] = (folder / "contour.csv").string();
  result["cloud"] = (folder / "cloud.ply").string();
  result["figure"] = (folder / "found.png").string();
  result["path"] = nullptr;
  if (path) {
    path->specimen_id = specimen_id;
    path->source_sha256 = sha256_of_file(target.path() / "contour.csv");
    write_tool_path(target.path() / "path.json", *path);
    result["path"] = (folder / "path.json").string();
    result["waypoints"] = path->waypoints.size();
    result["path_length_mm"] = length_mm(entry_contour(*path));
    result["duration_s"] = duration_s(*path);
  }
  const std::string settings = nlohmann::json{
      {"mark", arguments.mark},
      {"edge", arguments.edge},
      {"max_gap_mm", arguments.max_gap_mm},
      {"max_hole_mm", arguments.lift.max_hole_mm},
      {"open", arguments.is_open},
      {"margin_mm", arguments.margin_mm},
      {"depth_mm", arguments.plan.depth_mm},
      {"speed_mm_s", arguments.plan.speed_mm_s},
      {"waypoints", arguments.plan.waypoints},
      {"axis", arguments.axis}}.dump();
  write_manifest(target.path(), manifest_of(options, settings, scene.inputs, options.wall_s()));
  target.commit();
  if (!is_wanted) {
    console.message(Severity::Warning, complaint_about(found.line, scene.picture, arguments));
  } else if (const auto end = end_at_rim_px(found.line, scene.picture.width, scene.picture.height)) {
    console.message(
        Severity::Warning,
        fmt::format("the mark leaves the picture at pixel {:.0f}, {:.0f}: it may be longer", end->x(), end->y()));
  }
  if (const auto doubt = doubt_about(found.line, arguments)) console.message(Severity::Warning, *doubt);
  print_result(options, result);
  return is_wanted ? kDone : kNotAcceptable;
}

}  // namespace

void add_track(Application& application) {
  auto [verb, a] = application.add_verb<TrackArguments>(
      "track", "",
      "incise track color.png depth.png --intrinsics d405.json --mark green --camera "
      "robot_camera.json --plan -o tracked",
      run);
  verb->add_option("rgb", a.color, "Colour picture (.png, .jpg, .tif), or an organised coloured cloud (.ply)")
      ->required();
  verb->add_option("depth", a.depth, "Depth picture, 16 bits (.png, .tif); none with a cloud");
  verb->add_option("--intrinsics", a.intrinsics,
                   "JSON: width, height, fx, fy, cx, cy, depth_scale (m), distortion, depth {...}, T_color_depth");
  verb->add_option("--camera", a.camera,
                   "JSON with T_robot_camera: results in the robot's frame; without it: in the colour camera's");
  verb->add_option("--mark", a.mark, "Colour of the mark")->check(name_of_any<InkColor>());
  verb->add_option("--edge", a.edge, "Contour of the mark: its middle, or its inner border")
      ->check(name_of_any<LineEdge>());
  verb->add_option(
          "--max-gap-mm", a.max_gap_mm,
          "A ring with a longer gap is open. A gap is known to 0.18 mm and 2 pixels: a ring is taken as closed up "
          "to that much more, and a warning says so")
      ->check(zero_or_more("--max-gap-mm"));
  verb->add_option("--max-hole-mm", a.lift.max_hole_mm, "Longest stretch without depth that is bridged")
      ->check(zero_or_more("--max-hole-mm"));
  verb->add_flag("--open", a.is_open, "The mark is an open line");
  verb->add_flag("--plan", a.has_plan, "Plan an incision: path.json in the robot's frame");
  verb->add_option("--margin-mm", a.margin_mm, "From the mark to the incision; 0: along the mark")
      ->check(between("--margin-mm", 0.0, kLargestMarginMm));
  verb->add_option("--depth-mm", a.plan.depth_mm, "Of the incision")->check(above_zero("--depth-mm"));
  verb->add_option("--speed-mm-s", a.plan.speed_mm_s, "Of the tip")->check(above_zero("--speed-mm-s"));
  verb->add_option("--waypoints", a.plan.waypoints, "Of the path")->check(CLI::Range(8, 100000));
  verb->add_option("--axis", a.axis, "Tool axis: along the camera's view, or against the surface's normal")
      ->check(CLI::IsMember({"approach", "normal"}));
  verb->add_option("--ply-width", a.ply_width, "Columns of an organised cloud whose header does not tell")
      ->check(above_zero("--ply-width"));
  verb->add_option("--ply-unit-mm", a.ply_unit_mm, "Its unit: 1000 for metres")->check(above_zero("--ply-unit-mm"));
}

}  // namespace incise::cli
