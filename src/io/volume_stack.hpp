#pragma once

// What a scan may measure: from a micro-CT's voxel to a slice farther from the next than any scanner moves its table, and places that a
// scanner's own frame can have.
namespace incise {
inline constexpr double kFinestVoxelMm = 1e-4;
inline constexpr double kCoarsestVoxelMm = 100.0;
inline constexpr double kFarthestPlaceOfScanMm = 1e5;
inline constexpr double kLongestVoxel = 50.0;  // longest side over shortest: a slice 10 mm thick of pixels of 0.2 mm
}  // namespace incise

#include <incise/core/monitor.hpp>
#include <incise/geometry/volume.hpp>
#include <incise/io/volume_io.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace incise {

/// What all slices of a series share.
struct SliceFrame {
  int columns = 0;
  int rows = 0;
  double column_spacing_mm = 0;      ///< between neighbouring columns, along `row_axis`
  double row_spacing_mm = 0;         ///< between neighbouring rows, along `column_axis`
  Vec3 row_axis = Vec3::UnitX();     ///< unit; the way the column number grows
  Vec3 column_axis = Vec3::UnitY();  ///< unit; the way the row number grows
  [[nodiscard]] Vec3 normal() const { return row_axis.cross(column_axis); }
};

/// Where one slice lies.
struct SlicePlace {
  std::string name;                 ///< for messages: the file's name
  Vec3 position_mm = Vec3::Zero();  ///< centre of its first pixel, LPS
};

/// How a series stacks up, slices in order along the normal. All distances mm, relative to the first slice.
struct StackLayout {
  std::vector<int> order;                 ///< order[k] = which of the given slices is the k-th
  Vec3 first_position_mm = Vec3::Zero();  ///< centre of the first slice's first pixel, LPS
  std::vector<double> height_mm;          ///< along the normal; strictly increasing from 0
  std::vector<Vec2> sideways_mm;          ///< along row_axis and column_axis
  double tilt_deg = 0;                    ///< between the stack's direction and the normal
  double min_step_mm = 0;
  double max_step_mm = 0;
  double common_step_mm = 0;   ///< median step
  bool is_sideways = false;    ///< some slice is off the first one's normal by more than the tolerance
  std::string sideways_words;  ///< "a gantry tilt of 18.5 deg", or what else it is that moves the slices sideways
  bool is_uneven = false;      ///< some slice is off its even place by more than the tolerance
  int missing_slices = 0;      ///< holes in an otherwise regular series
  std::string first_hole;      ///< "between 'a' and 'b', 6 mm apart"
};

/// Sorts the slices and judges their regularity by the tolerances that read_ct states.
/// @throws DataError for a single slice or two slices at one place.
[[nodiscard]] StackLayout lay_out_stack(const std::filesystem::path& path, const SliceFrame& frame,
                                        const std::vector<SlicePlace>& places);

/// Says what is irregular, or throws DataError if the settings refuse it. Call before the pixels are read.
void judge_stack(const std::filesystem::path& path, const StackLayout& layout, const CtReadSettings& settings);

/// The volume of slices given in the order of the layout: as they are if regular, otherwise interpolated linearly.
/// @param hu  columns x rows x slices, columns fastest.  @returns the volume; fills in diagnostics and tells the
/// monitor.
[[nodiscard]] CtVolume assemble_stack(const std::filesystem::path& path, const SliceFrame& frame,
                                      const StackLayout& layout, std::vector<std::int16_t> hu,
                                      CtReadDiagnostics& diagnostics, Monitor& monitor);

/// Tells a notice to the monitor and keeps it.
void notify(CtReadDiagnostics& diagnostics, Monitor& monitor, std::string notice);

}  // namespace incise
