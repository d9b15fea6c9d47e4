#pragma once

#include <incise/core/monitor.hpp>
#include <incise/geometry/volume.hpp>
#include <incise/io/volume_io.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace incise {

// Limits of a scan: from a micro-CT's voxel to more than any scanner's slice spacing, and positions within any
// scanner's own frame.
inline constexpr double kFinestVoxelMm = 1e-4;
inline constexpr double kCoarsestVoxelMm = 100.0;
inline constexpr double kFarthestPlaceOfScanMm = 1e5;
inline constexpr double kLongestVoxel = 50.0;  // longest side over shortest: a 10 mm slice with pixels of 0.2 mm

/// The size, pixel spacing and axes that all slices of a series share.
struct SliceFrame {
  int columns = 0;
  int rows = 0;
  double column_spacing_mm = 0;      ///< between neighbouring columns, along `row_axis`
  double row_spacing_mm = 0;         ///< between neighbouring rows, along `column_axis`
  Vec3 row_axis = Vec3::UnitX();     ///< unit; direction in which the column number grows
  Vec3 column_axis = Vec3::UnitY();  ///< unit; direction in which the row number grows
  [[nodiscard]] Vec3 normal() const { return row_axis.cross(column_axis); }
};

/// Position of one slice.
struct SlicePlace {
  std::string name;                 ///< for messages: the file's name
  Vec3 position_mm = Vec3::Zero();  ///< centre of its first pixel, LPS
};

/// Arrangement of the slices of a series, in order along the normal. Distances in mm, relative to the first slice.
struct StackLayout {
  std::vector<int> order;                 ///< order[k] = index of the k-th slice among those given
  Vec3 first_position_mm = Vec3::Zero();  ///< centre of the first slice's first pixel, LPS
  std::vector<double> height_mm;          ///< along the normal; strictly increasing from 0
  std::vector<Vec2> sideways_mm;          ///< along row_axis and column_axis
  double tilt_deg = 0;                    ///< between the stack's direction and the normal
  double min_step_mm = 0;
  double max_step_mm = 0;
  double common_step_mm = 0;   ///< median step
  bool is_sideways = false;    ///< some slice is off the normal through the first by more than the tolerance
  std::string sideways_words;  ///< "a gantry tilt of 18.5 deg", or another sideways shift, in words
  bool is_uneven = false;      ///< some slice is off its evenly spaced position by more than the tolerance
  int missing_slices = 0;      ///< holes in an otherwise regular series
  std::string first_hole;      ///< "between 'a' and 'b', 6 mm apart"
};

/// Sorts the slices and judges their regularity by the tolerances of read_ct.
/// @throws DataError for a single slice, or for two slices at one position along the normal.
[[nodiscard]] StackLayout lay_out_stack(const std::filesystem::path& path, const SliceFrame& frame,
                                        const std::vector<SlicePlace>& places);

/// Refuses a stack with irregularities that the settings do not allow. Call before reading pixels. @throws DataError
void judge_stack(const std::filesystem::path& path, const StackLayout& layout, const CtReadSettings& settings);

/// Returns the volume of the slices: unchanged if they are regular, otherwise interpolated linearly. Fills in
/// diagnostics, and notifies the monitor of resampling.
/// @param hu  HU, columns x rows x slices, columns fastest, slices in the order of the layout
[[nodiscard]] CtVolume assemble_stack(const std::filesystem::path& path, const SliceFrame& frame,
                                      const StackLayout& layout, std::vector<std::int16_t> hu,
                                      CtReadDiagnostics& diagnostics, Monitor& monitor);

/// Sends a notice to the monitor and keeps it in the diagnostics.
void notify(CtReadDiagnostics& diagnostics, Monitor& monitor, std::string notice);

}  // namespace incise
