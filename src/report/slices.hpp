#pragma once

#include <incise/report/report_data.hpp>

#include <string>
#include <vector>

namespace incise {

/// One slice of the scan as a picture: x to the right and y downwards, in mm from its top left corner.
struct Slice {
  double position_mm = 0.0;  ///< of the slice along its normal's world axis
  std::string image_uri;     ///< PNG
  std::string outline;       ///< SVG path data, mm, of the border of the tissue; may be empty
};

/// Slices along one direction of the scan, shown the way radiologists do.
struct SlicePlane {
  std::string name;       ///< axial, coronal, sagittal
  std::string axis_name;  ///< x, y or z: what `position_mm` counts along
  double width_mm = 0.0, height_mm = 0.0;
  std::array<std::string, 4> ends;  ///< names of left, right, top, bottom
  std::vector<Slice> slices;        ///< ascending position
};

/// Axial (at most `max_axial` evenly spaced slices), coronal (the middle one) and sagittal (the middle one). Planes
/// follow the volume's own axes, named after the world axis they are nearest to.
[[nodiscard]] std::array<SlicePlane, 3> slice_planes(const CtPicture& picture,
                                                     const std::array<std::string, 6>& axis_names, int max_axial);

/// A complete SVG picture of one slice with outline, scale bar and the names of its sides.
[[nodiscard]] std::string slice_svg(const SlicePlane& plane, const Slice& slice);

}  // namespace incise
