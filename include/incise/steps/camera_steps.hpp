#pragma once

#include <incise/geometry/tool_path.hpp>
#include <incise/imaging/depth_camera.hpp>
#include <incise/imaging/marked_line.hpp>
#include <incise/imaging/photo_contours.hpp>
#include <incise/planning/plan_path.hpp>
#include <incise/planning/project_path.hpp>
#include <incise/registration/nonrigid_drift.hpp>
#include <incise/registration/register_clouds.hpp>
#include <incise/steps/step.hpp>

#include <filesystem>
#include <optional>

namespace incise::steps {

/// From a colour and a depth picture to the marked line in space.
struct TrackRequest {
  std::filesystem::path color;       ///< picture, or an organised coloured cloud (.ply)
  std::filesystem::path depth;       ///< picture; empty with a cloud
  std::filesystem::path intrinsics;  ///< JSON; empty with a cloud
  std::filesystem::path camera;      ///< JSON with T_robot_camera; empty: results in the colour camera's frame
  std::optional<InkColor> mark = InkColor::Green;  ///< absent: none is looked for, and the cloud is all
  LineEdge edge = LineEdge::Middle;
  double max_gap_mm = LineSettings{}.max_gap_mm;  ///< a ring with a longer gap is open
  LiftSettings lift;
  bool is_open = false;                                 ///< the mark is an open line
  int ply_width = 0;                                    ///< columns of a cloud whose header does not tell; 0: it does
  double ply_unit_mm = 1.0;                             ///< of a cloud
  bool has_plan = false;                                ///< also plan an incision; only with `camera`
  double margin_mm = PlanSettings{}.lateral_margin_mm;  ///< from the mark to the incision; 0: along the mark
  PlanSettings plan;                                    ///< depth, speed, waypoints and axis of the incision
  std::filesystem::path output;  ///< folder: contour.csv, cloud.ply, found.png, path.json; without a mark cloud.ply
};
/// Not acceptable: a mark that is closed where an open one was asked for, or the other way round. @throws DataError,
/// CaseError
[[nodiscard]] StepResult track_mark(const TrackRequest& request, const StepContext& context);

/// From two clouds to the similarity between them.
struct RegisterRequest {
  std::filesystem::path source;  ///< is moved
  std::filesystem::path target;  ///< stays
  RegistrationSettings settings;
  std::optional<NonrigidSettings> nonrigid;  ///< also bend the source to the target
  double max_rmse_mm = 0.0;                  ///< of the residual; 0: as `settings` says
  Vec3 approach = -Vec3::UnitZ();            ///< from which the figure is seen
  std::filesystem::path output;              ///< folder: registration.json, registration.svg, moved_source.ply
};
/// Not acceptable: no similarity that can be relied upon. @throws DataError; Cancelled.
[[nodiscard]] StepResult lay_clouds(const RegisterRequest& request, const StepContext& context);

/// From a path in the stretched simulation to one on the measured tissue, in the robot's frame.
struct ProjectRequest {
  std::filesystem::path path;
  std::filesystem::path transform;  ///< registration.json
  std::filesystem::path surface;    ///< the measured tissue
  std::filesystem::path camera;     ///< JSON with T_robot_camera; empty: the surface is in the robot's frame
  bool takes_camera_size = false;   ///< whose lengths are true: the camera's, or the CT's
  std::optional<Vec3>
      scale_center_mm;  ///< where the cloud is right; absent: the camera's origin, else the path's middle
  ProjectSettings settings;
  std::filesystem::path output;  ///< folder (path.json, surface.ply), or a file that ends in .json
};
/// @throws DataError for a registration, path or surface that cannot be used.
[[nodiscard]] StepResult project_onto_tissue(const ProjectRequest& request, const StepContext& context);

}  // namespace incise::steps
