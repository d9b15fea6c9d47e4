#pragma once

#include <incise/geometry/contour.hpp>
#include <incise/geometry/tet_mesh.hpp>
#include <incise/io/table_io.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace incise {

/// Reads a contour, mm, LPS.
///
///   .csv       header with the columns x_mm, y_mm and z_mm, in any order and among others; one point per row.
///              A byte order mark, CRLF and blank lines are accepted. Open or closed as `is_closed` says, because the
///              format does not record it.
///   .vtp       one polyline; closed if its last index repeats the first, otherwise as `is_closed` says
///   .mrk.json  one 3D Slicer curve (ClosedCurve or Curve) in mm, LPS or RAS. Only its control points are read: if
///              they are few and joined by a spline, resample the curve in Slicer first.
///
/// If the last point of a closed contour repeats the first, it is dropped.
/// @param is_closed  the kind that the caller needs. A file that records the other kind is refused.
/// @throws DataError naming line and column, or the place in the JSON: missing column, bad or non-finite value, fewer
///         than 3 points (2 if open), more than one curve; a `.csv` or `.vtp` to be read as closed that does not repeat
///         its first point and whose ends are more than 4 times as far apart as any two neighbouring points.
[[nodiscard]] Contour read_contour(const std::filesystem::path& path, bool is_closed = true);

/// Writes the columns x_mm,y_mm,z_mm and then `columns` (names with their unit, such as `signed_error_mm`), LF line
/// ends. Each number is the shortest text that reads back to the same double.
/// @pre all numbers finite; each column as long as the contour; names without comma, quote or line end
///      (InvalidArgument).
/// @throws DataError if the file cannot be written.
void write_contour_csv(const std::filesystem::path& path, const Contour& contour,
                       const std::vector<NamedColumn>& columns = {});

/// Writes one polyline with point data for ParaView; write_vtp writes several. @pre, @throws as write_vtp.
void write_contour_vtp(const std::filesystem::path& path, const Contour& contour,
                       const std::map<std::string, DataArray>& point_data = {});

}  // namespace incise
