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
///   .csv       header with the columns x_mm, y_mm and z_mm, in any order and among others; one point a row. A byte
///   order mark, CRLF and
///              blank lines are fine. Open or closed as `is_closed` says: the format does not record it.
///   .vtp       one polyline. It is closed when its last index repeats the first, else as `is_closed` says.
///   .mrk.json  one 3D Slicer curve (ClosedCurve or Curve), LPS or RAS. The control points are taken as they are: where
///   few points and a
///              spline were used, resample the curve in Slicer first.
///
/// A last point that repeats the first of a closed contour is dropped, as Contour asks.
/// @param is_closed  what the caller needs. A file that records the other kind is refused.
/// @throws DataError naming line and column, or the JSON place: missing column, bad or not-a-number value, fewer than 3
/// points (2 for an
///         open contour), more than one curve.
[[nodiscard]] Contour read_contour(const std::filesystem::path& path, bool is_closed = true);

/// Writes x_mm,y_mm,z_mm and the further columns (names with their unit, such as `signed_error_mm`), LF line ends.
/// Numbers are the shortest text that reads back to the same double.
/// @pre all numbers finite; each column as long as the contour; names without comma, quote or line end.
/// @throws DataError if the file cannot be written.
void write_contour_csv(const std::filesystem::path& path, const Contour& contour,
                       const std::vector<NamedColumn>& columns = {});

/// Writes one polyline with point data for ParaView; see write_vtp for several. @pre, @throws as write_contour_csv.
void write_contour_vtp(const std::filesystem::path& path, const Contour& contour,
                       const std::map<std::string, DataArray>& point_data = {});

}  // namespace incise
