#pragma once

#include <incise/core/defaults.hpp>
#include <incise/geometry/point_cloud.hpp>
#include <incise/geometry/visible_surface.hpp>
#include <incise/imaging/segmentation.hpp>
#include <incise/io/volume_io.hpp>
#include <incise/steps/step.hpp>

#include <filesystem>
#include <optional>

namespace incise::steps {

/// Input of segment_scan: a CT.
struct SegmentRequest {
  std::filesystem::path ct;  ///< DICOM folder, volume or folder of PNG slices
  CtReadSettings reading;
  SegmentationSettings settings;
  std::filesystem::path output;  ///< label volume; its manifest is written beside it
};
/// Finds the tissue in a CT and writes its labels. @throws DataError, CaseError as read_ct and segment.
[[nodiscard]] StepResult segment_scan(const SegmentRequest& request, const StepContext& context);

/// Input of mesh_body: labels or a closed surface.
struct MeshRequest {
  std::filesystem::path input;
  std::filesystem::path around;       ///< planned cut around which the mesh is fine; empty: uniform
  std::optional<double> fine_mm;      ///< edge length near the cut, > 0; only with `around`
  std::optional<double> coarse_mm;    ///< edge length far from the cut, > 0
  double depth_mm = kPlannedDepthMm;  ///< depth of the cut
  int tets = 0;                       ///< target number of tets; 0: as the lengths give
  std::filesystem::path output;       ///< .vtu; its manifest is written beside it
};
/// Makes a tetrahedral mesh. Not acceptable: a mesh that misses its quality or volume. @throws DataError; CaseError
/// where fine_mm > coarse_mm.
[[nodiscard]] StepResult mesh_body(const MeshRequest& request, const StepContext& context);

/// Input of see_surface: a specimen, or a camera's cloud.
struct SurfaceRequest {
  std::filesystem::path input;   ///< case, tet mesh, surface or cloud
  std::optional<Vec3> approach;  ///< direction of view; absent: the case's, else -z
  VisibleSurfaceSettings view;
  CleaningSettings cleaning;
  std::filesystem::path camera;      ///< JSON with T_robot_camera; only with plane_z_mm
  std::optional<double> plane_z_mm;  ///< height of the largest plane, in the robot's frame; absent: not known
  std::filesystem::path output;      ///< .ply or .vtp
};
/// Writes the surface that an observer sees of a specimen, or a camera's cloud without clutter. @throws DataError,
/// CaseError; InvalidArgument for settings that validate(CleaningSettings) refuses.
[[nodiscard]] StepResult see_surface(const SurfaceRequest& request, const StepContext& context);

}  // namespace incise::steps
