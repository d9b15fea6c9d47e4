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

/// Input of track_mark: a colour and a depth picture, or a coloured cloud.
struct TrackRequest {
  std::filesystem::path color;       ///< picture, or an organised coloured cloud (.ply)
  std::filesystem::path depth;       ///< picture; empty with a cloud
  std::filesystem::path intrinsics;  ///< JSON; empty with a cloud
  std::filesystem::path camera;      ///< JSON with T_robot_camera; empty: results are in the colour camera's frame
  std::optional<InkColor> mark = InkColor::Green;  ///< absent: no mark is looked for; the cloud is the only result
  LineEdge edge = LineEdge::Middle;
  double max_gap_mm = LineSettings{}.max_gap_mm;  ///< a ring with a longer gap is open
  LiftSettings lift;
  bool is_open = false;                                 ///< the mark should be an open line, not a ring
  int ply_width = 0;                                    ///< columns of a cloud; 0: as its header states
  double ply_unit_mm = 1.0;                             ///< length of one unit of a cloud's coordinates, mm
  bool has_plan = false;                                ///< also plan an incision; only with `camera`
  double margin_mm = PlanSettings{}.lateral_margin_mm;  ///< distance from the mark to the incision; 0: along the mark
  PlanSettings plan;                                    ///< depth, speed, waypoints and axis of the incision
  std::filesystem::path output;  ///< folder: contour.csv, cloud.ply, found.png, path.json; without a mark cloud.ply
};
/// Finds the marked line in the pictures, lifts it into space and, if `has_plan`, plans an incision along it. Not
/// acceptable: a mark that is closed where `is_open` expects an open line, or the other way round. @throws DataError,
/// CaseError
[[nodiscard]] StepResult track_mark(const TrackRequest& request, const StepContext& context);

/// Input of lay_clouds: two clouds, and how they are registered.
struct RegisterRequest {
  std::filesystem::path source;  ///< the cloud that moves
  std::filesystem::path target;  ///< the cloud that stays
  RegistrationSettings settings;
  std::optional<NonrigidSettings> nonrigid;  ///< absent: the source is not bent to the target
  double max_rmse_mm = 0.0;                  ///< greatest accepted residual (rms); 0: only `settings` limits it
  Vec3 approach = -Vec3::UnitZ();            ///< direction of view of the figure
  std::filesystem::path output;              ///< folder for registration.json, registration.svg, moved_source.ply
};
/// Registers the source to the target by a similarity transform. Not acceptable: a transform that cannot be relied
/// upon, or a bending that does not converge. @throws DataError; Cancelled.
[[nodiscard]] StepResult lay_clouds(const RegisterRequest& request, const StepContext& context);

/// Input of project_onto_tissue.
struct ProjectRequest {
  std::filesystem::path path;  ///< in the frame sim_stretched
  std::filesystem::path transform;  ///< registration.json
  std::filesystem::path surface;    ///< the measured tissue: cloud or surface, mm
  std::filesystem::path camera;     ///< JSON with T_robot_camera; empty: `surface` is in the robot's frame
  bool takes_camera_size = false;   ///< true: the camera's lengths are taken as true; false: the CT's
  std::optional<Vec3>
      scale_center_mm;  ///< fixed point of the scaling, robot's frame; absent: camera's origin, else path's middle
  ProjectSettings settings;
  std::filesystem::path output;  ///< folder for path.json and surface.ply, or the path's file, which ends in .json
};
/// Transfers a path from the stretched simulation to the measured tissue, in the robot's frame. @throws DataError for a
/// registration, path or surface that cannot be used.
[[nodiscard]] StepResult project_onto_tissue(const ProjectRequest& request, const StepContext& context);

}  // namespace incise::steps
