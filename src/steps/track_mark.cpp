#include "steps/camera_file.hpp"

#include <incise/core/error.hpp>
#include <incise/core/median.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/grid_cloud.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/picture_io.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/transform_json.hpp>
#include <incise/planning/plan_marked_path.hpp>
#include <incise/steps/camera_steps.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise::steps {
namespace {

struct Scene {
  ColorPicture picture;
  OrganizedCloud cloud;
  std::filesystem::path depth_name;
  std::vector<std::filesystem::path> inputs;
};

/// PCL writes `obj_info num_cols W`; with files of other programs, the user states it.
int columns_of(const GridCloud& grid, const TrackRequest& request) {
  const int given = request.ply_width;
  if (grid.columns == 0 && given == 0) {
    throw DataError(request.color, "header", "no obj_info num_cols",
                    "an organised cloud (rows and columns of a picture)", "Give its width with --ply-width.");
  }
  if (grid.columns > 0 && given > 0 && given != grid.columns) {
    throw CaseError("command line", "--ply-width", fmt::format("{}", given),
                    fmt::format("{}, as in {}", grid.columns, request.color.string()));
  }
  return given > 0 ? given : grid.columns;
}

/// Returns the number of rows. @throws DataError for an incomplete row, or for another number than the file states.
int rows_of(const GridCloud& grid, int columns, const std::filesystem::path& file) {
  const std::size_t count = grid.places.size(), width = static_cast<std::size_t>(columns);
  if (columns < 2 || count % width != 0)
    throw DataError(file, "vertices", fmt::format("{} places in rows of {}", count, columns), "whole rows");
  if (grid.rows > 0 && count / width != static_cast<std::size_t>(grid.rows)) {
    throw DataError(file, "vertices", fmt::format("{} rows of {} places", count / width, columns),
                    fmt::format("{} rows, as in num_rows", grid.rows));
  }
  return static_cast<int>(count / width);
}

Scene scene_from_ply(const TrackRequest& request) {
  const GridCloud grid = read_grid_cloud(request.color);
  const TriMesh& cloud = grid.cloud;
  const int width = columns_of(grid, request);
  const int height = rows_of(grid, width, request.color);
  Scene scene{{}, {}, request.color, {request.color}};
  scene.picture = {width, height, {}};
  scene.cloud = {width, height, {}, {}};
  const char* const names[] = {"red", "green", "blue"};
  for (const char* name : names) {
    if (!cloud.point_data.contains(name))
      throw DataError(request.color, "header", fmt::format("no property {}", name),
                      "a coloured cloud: red, green, blue");
  }
  constexpr std::uint8_t kNoColor = 128;  // of a hole: grey is no ink
  for (const std::optional<std::size_t>& place : grid.places) {
    for (const char* name : names) {
      scene.picture.rgb.push_back(
          place ? static_cast<std::uint8_t>(std::clamp(cloud.point_data.at(name).values[*place], 0.0, 255.0))
                : kNoColor);
    }
    const Vec3 p = place ? Vec3(request.ply_unit_mm * cloud.vertices[*place]) : Vec3::Zero();
    scene.cloud.points.push_back(p);
    scene.cloud.is_measured.push_back(p.z() != 0.0 ? 1 : 0);
  }
  require_camera_frame(scene.cloud, request.color);
  return scene;
}

Scene scene_from_pictures(const TrackRequest& request) {
  if (request.intrinsics.empty())
    throw CaseError("command line", "--intrinsics", "nothing", "the cameras' intrinsics (JSON)");
  const DepthCamera camera = read_depth_camera(request.intrinsics);
  Scene scene{decode_picture(read_text(request.color), request.color),
              {},
              request.depth,
              {request.color, request.depth, request.intrinsics}};
  if (scene.picture.width != camera.color.width || scene.picture.height != camera.color.height) {
    throw DataError(
        request.color, "", fmt::format("{} x {} pixels", scene.picture.width, scene.picture.height),
        fmt::format("{} x {}, as in {}", camera.color.width, camera.color.height, request.intrinsics.string()));
  }
  const DepthPicture depth = decode_depth(read_text(request.depth), request.depth);
  try {
    scene.cloud = cloud_seen_in_color(depth, camera);
  } catch (const InvalidArgument& error) {
    throw DataError(request.depth, "", error);
  }
  return scene;
}

/// Returns the median distance between neighbours in a row, in the middle of the picture: the width of a pixel on the
/// tissue.
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

/// Returns the points with depth, with the pixels' colours.
TriMesh colored_cloud(const Scene& scene) {
  TriMesh cloud;
  DataArray red{1, {}}, green{1, {}}, blue{1, {}};
  for (std::size_t i = 0; i < scene.cloud.points.size(); ++i) {
    if (scene.cloud.is_measured[i] == 0) continue;
    cloud.vertices.push_back(scene.cloud.points[i]);
    red.values.push_back(scene.picture.rgb[3 * i]);
    green.values.push_back(scene.picture.rgb[3 * i + 1]);
    blue.values.push_back(scene.picture.rgb[3 * i + 2]);
  }
  cloud.point_data = {{"red", red}, {"green", green}, {"blue", blue}};
  return cloud;
}

struct Tracked {
  MarkedLine line;
  LiftedLine lifted;
  TriMesh cloud;  ///< with the pixels' colours
  Vec3 approach = Vec3::UnitZ();
  Vec3 start = -Vec3::UnitY();  ///< the picture's top
};

Tracked tracked(const Scene& scene, const TrackRequest& request) {
  Tracked result;
  const LineSettings line{.edge = request.edge,
                          .mm_per_pixel = mm_per_pixel(scene.cloud, scene.depth_name),
                          .max_gap_mm = request.max_gap_mm};
  result.line = find_marked_line(scene.picture, *request.mark, line, request.color);
  result.lifted =
      lift_to_space(result.line.points_px, result.line.is_closed, scene.cloud, request.lift, scene.depth_name);
  result.cloud = colored_cloud(scene);
  if (result.line.is_closed)
    result.lifted.contour =
        start_farthest_along(counter_clockwise(result.lifted.contour, result.approach), result.start);
  return result;
}

/// Moves what was found to the robot's frame, if the request says where the camera is.
void move_to_robot(Tracked& tracked, Scene& scene, const TrackRequest& request) {
  if (request.camera.empty()) return;
  const Mat4 T_robot_camera = rigid_transform_in(read_json(request.camera), "T_robot_camera", request.camera);
  scene.inputs.push_back(request.camera);
  const Mat3 R = T_robot_camera.topLeftCorner<3, 3>();
  const Vec3 t = T_robot_camera.topRightCorner<3, 1>();
  for (Vec3& p : tracked.lifted.contour.points) p = R * p + t;
  for (Vec3& p : tracked.cloud.vertices) p = R * p + t;
  tracked.approach = R * tracked.approach;
  tracked.start = R * tracked.start;
}

ToolPath planned(const Tracked& tracked, const TrackRequest& request, const std::filesystem::path& name) {
  MarkedPlan plan;
  plan.settings = request.plan;
  plan.settings.approach = tracked.approach;
  plan.settings.start_direction = tracked.start;
  plan.margin_mm = request.margin_mm;
  try {
    return plan_marked_path(tracked.lifted.contour, tracked.cloud.vertices, plan);
  } catch (const CaseError& error) {
    // The error names a case file, but the user has none.
    throw DataError(name, error.problem());
  } catch (const InvalidArgument& error) {
    throw DataError(name, "", error);
  }
}

/// Says why the mark is not the requested one.
std::string complaint_about(const MarkedLine& line, const std::optional<Vec2>& end, const TrackRequest& request) {
  if (request.is_open) return "the mark is a closed ring, but an open line was requested";
  if (end) {
    return fmt::format("the mark leaves the picture at pixel {:.0f}, {:.0f}: whether it is closed is unknown", end->x(),
                       end->y());
  }
  return fmt::format("the mark is not closed: it has a gap of {:.2f} mm, but at most {} mm is bridged",
                     line.longest_unseen_mm, request.max_gap_mm);
}

/// Warns of a ring that is taken as closed although its gap may be longer than allowed.
std::optional<std::string> doubt_about(const MarkedLine& line, const TrackRequest& request) {
  const bool is_doubtful = line.is_closed && line.longest_unseen_mm > 0.0 &&
                           line.longest_unseen_mm + line.gap_tolerance_mm > request.max_gap_mm;
  if (!is_doubtful) return std::nullopt;
  return fmt::format(
      "the mark is taken as closed, with a gap of {:.2f} mm that is known to {:.2f} mm at this pixel size: "
      "it may be longer than --max-gap-mm {}",
      line.longest_unseen_mm, line.gap_tolerance_mm, request.max_gap_mm);
}

nlohmann::json settings_json(const TrackRequest& request) {
  return {{"mark", to_string(*request.mark)},
          {"edge", to_string(request.edge)},
          {"max_gap_mm", request.max_gap_mm},
          {"max_hole_mm", request.lift.max_hole_mm},
          {"open", request.is_open},
          {"margin_mm", request.margin_mm},
          {"depth_mm", request.plan.depth_mm},
          {"speed_mm_s", request.plan.speed_mm_s},
          {"waypoints", request.plan.waypoints},
          {"axis", request.plan.axis_mode == AxisMode::SurfaceNormal ? "normal" : "approach"}};
}

/// Writes a frame without a mark: only its cloud.
StepResult see_frame(Scene scene, const TrackRequest& request, const StepContext& context) {
  Tracked seen;
  seen.cloud = colored_cloud(scene);
  if (seen.cloud.vertices.empty()) throw DataError(scene.depth_name, "", "no pixel with depth", "some");
  move_to_robot(seen, scene, request);
  require_replaceable(request.output);
  AtomicFolder target(request.output);
  write_ply(target.path() / "cloud.ply", seen.cloud, common_specimen_id(scene.inputs));
  write_manifest(target.path(), manifest_of(context.run, R"({"mark": "none"})", scene.inputs, context.wall_s()));
  target.commit();
  StepResult result;
  result.json["outcome"] = to_string(Outcome::Success);
  result.json["frame"] = request.camera.empty() ? "camera" : "robot";
  result.json["mark"] = "none";
  result.json["cloud_points"] = seen.cloud.vertices.size();
  result.json["cloud"] = (request.output / "cloud.ply").string();
  return result;
}

}  // namespace

StepResult track_mark(const TrackRequest& request, const StepContext& context) {
  Scene scene = request.depth.empty() ? scene_from_ply(request) : scene_from_pictures(request);
  if (!request.mark) return see_frame(std::move(scene), request, context);
  Tracked found = tracked(scene, request);
  move_to_robot(found, scene, request);
  const bool is_wanted = found.line.is_closed != request.is_open;
  const std::optional<Vec2> end = end_at_rim_px(found.line, scene.picture.width, scene.picture.height);
  std::optional<ToolPath> path;
  if (request.has_plan && is_wanted) path = planned(found, request, scene.depth_name);

  require_replaceable(request.output);
  const std::filesystem::path& folder = request.output;
  const std::string specimen_id = common_specimen_id(scene.inputs);
  AtomicFolder target(folder);
  write_contour_csv(target.path() / "contour.csv", found.lifted.contour);
  write_ply(target.path() / "cloud.ply", found.cloud, specimen_id);
  const std::string png = encode_png(draw_found(scene.picture, {&found.line}));
  write_atomically(target.path() / "found.png", png);
  StepResult result;
  nlohmann::ordered_json& json = result.json;
  json["outcome"] = to_string(is_wanted ? Outcome::Success : Outcome::OpenLoop);
  json["points"] = found.lifted.contour.points.size();
  json["length_mm"] = length_mm(found.lifted.contour);
  json["closed_loop"] = found.line.is_closed;
  json["frame"] = request.camera.empty() ? "camera" : "robot";
  json["mark"] = to_string(*request.mark);
  json["width_px"] = found.line.width_px;
  json["max_gap_mm"] = found.line.longest_unseen_mm;
  json["gap_tolerance_mm"] = found.line.gap_tolerance_mm;
  json["leaves_picture"] = end.has_value();
  json["max_hole_mm"] = found.lifted.max_hole_mm;
  json["bridged_points"] = found.lifted.bridged_points;
  json["cloud_points"] = found.cloud.vertices.size();
  json["contour"] = (folder / "contour.csv").string();
  json["cloud"] = (folder / "cloud.ply").string();
  json["figure"] = (folder / "found.png").string();
  json["path"] = nullptr;
  if (path) {
    path->specimen_id = specimen_id;
    path->source_sha256 = sha256_of_file(target.path() / "contour.csv");
    write_tool_path(target.path() / "path.json", *path);
    json["path"] = (folder / "path.json").string();
    json["waypoints"] = path->waypoints.size();
    json["path_length_mm"] = length_mm(entry_contour(*path));
    json["duration_s"] = duration_s(*path);
  }
  write_manifest(target.path(),
                 manifest_of(context.run, settings_json(request).dump(), scene.inputs, context.wall_s()));
  target.commit();
  if (!is_wanted) {
    context.monitor.message(Severity::Warning, complaint_about(found.line, end, request));
  } else if (end) {
    context.monitor.message(
        Severity::Warning,
        fmt::format("the mark leaves the picture at pixel {:.0f}, {:.0f}: it may be longer", end->x(), end->y()));
  }
  if (const auto doubt = doubt_about(found.line, request)) context.monitor.message(Severity::Warning, *doubt);
  result.is_acceptable = is_wanted;
  return result;
}

}  // namespace incise::steps
