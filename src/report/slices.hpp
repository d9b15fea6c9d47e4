#pragma once

#include <incise/report/report_data.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// One slice of the scan as a picture: x to the right and y downwards, in mm from its top left corner.
struct Slice {
  double position_mm = 0.0;  ///< along the world axis of the slice's normal
  std::string image_uri;     ///< PNG
  std::string outline;       ///< SVG path data, mm, of the border of the tissue; may be empty
  std::string tumor;         ///< the same of the tumour in this plane
  std::string planned_cut;   ///< and of the sheet that the planned path sweeps
};

/// Slices along one direction of the scan, shown the way radiologists do.
struct SlicePlane {
  std::string name;       ///< axial, coronal, sagittal
  std::string axis_name;  ///< world axis of `position_mm`: x, y or z
  double width_mm = 0.0, height_mm = 0.0;
  std::array<std::string, 4> ends;  ///< names of left, right, top, bottom
  std::vector<Slice> slices;        ///< ascending position
  std::size_t shown_first =
      0;  ///< index of the slice nearest to the middle of the planned cut, else of the tumour; else the middle slice
};

/// Returns axial slices (at most `max_axial`, evenly spaced), and one coronal and one sagittal slice (through the
/// middle of the planned cut, else of the tumour, else of the volume). Planes follow the volume's own axes and are
/// named after the nearest world axes.
[[nodiscard]] std::array<SlicePlane, 3> slice_planes(const CtPicture& picture,
                                                     const std::array<std::string, 6>& axis_names, int max_axial);

/// Colours of the curves on a slice.
namespace slice_ink {
inline constexpr std::string_view kTissue = "#ffb000";
inline constexpr std::string_view kTumor = "#2fe39f";
inline constexpr std::string_view kPlannedCut = "#6fc6ff";
}  // namespace slice_ink

/// A complete SVG picture of one slice with its curves, scale bar and the names of its sides.
[[nodiscard]] std::string slice_svg(const SlicePlane& plane, const Slice& slice);

}  // namespace incise
