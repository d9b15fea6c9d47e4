#include "io/number_text.hpp"
#include "io/surface_readers.hpp"
#include "io/vtk_xml_reader.hpp"
#include "io/vtk_xml_writer.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/surface_io.hpp>

#include <fmt/format.h>

#include <numeric>

namespace incise {
namespace io_detail {

void add_polygon(TriMesh& surface, const std::vector<VertexId>& corners) {
  for (std::size_t k = 2; k < corners.size(); ++k)
    surface.triangles.push_back({corners[0], corners[k - 1], corners[k]});
}

void require_writable(const TriMesh& surface) {
  require_finite_points(surface.vertices);
  require_data(surface.point_data, surface.vertices.size());
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    for (const VertexId id : surface.triangles[i]) {
      INCISE_REQUIRE(
          id.is_valid() && id.index() < surface.vertices.size(),
          fmt::format("expected indices below {}, found {} in triangle {}", surface.vertices.size(), id.value, i));
    }
  }
}

TriMesh read_vtp_surface(const std::filesystem::path& path) {
  const VtkXmlFile file(path, "PolyData");
  TriMesh surface;
  surface.vertices = file.points();
  surface.point_data = without_types(file.arrays("PointData", surface.vertices.size()));
  if (file.count("NumberOfStrips") > 0) {
    throw DataError(path, "<Strips>", "triangle strips", "triangles",
                    "In ParaView, apply the Triangulate filter first.");
  }
  const std::size_t polygons = file.count("NumberOfPolys");
  if (polygons == 0) return surface;
  const std::vector<double> connectivity = file.array("Polys", "connectivity");
  const std::vector<double> ends = file.array("Polys", "offsets");
  if (ends.size() != polygons)
    throw DataError(path, "<Polys>", fmt::format("{} offsets", ends.size()), fmt::format("{}", polygons));
  double begin = 0.0;
  for (std::size_t i = 0; i < polygons; begin = ends[i++]) {
    const auto fail = [&](std::string found, std::string expected) {
      throw DataError(path, fmt::format("polygon {}", i), std::move(found), std::move(expected));
    };
    if (!(ends[i] >= begin + 3.0 && ends[i] <= static_cast<double>(connectivity.size()))) {
      fail(fmt::format("points {} to {} of {}", begin, ends[i], connectivity.size()),
           "3 or more points inside the list");
    }
    std::vector<VertexId> corners;
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(ends[i]); ++k) {
      if (!(connectivity[k] >= 0.0 && connectivity[k] < static_cast<double>(surface.vertices.size()))) {
        fail(fmt::format("point index {}", connectivity[k]), fmt::format("an index below {}", surface.vertices.size()));
      }
      corners.push_back(VertexId(static_cast<std::size_t>(connectivity[k])));
    }
    add_polygon(surface, corners);
  }
  return surface;
}

}  // namespace io_detail

namespace {

std::string piece_counts(std::size_t points, std::size_t verts, std::size_t lines, std::size_t polys) {
  return fmt::format(
      "NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" NumberOfPolys=\"{}\"",
      points, verts, lines, polys);
}

void add_cells(io_detail::VtkXmlText& text, const char* section, const std::vector<std::int32_t>& connectivity,
               const std::vector<std::int32_t>& offsets) {
  text.open(section);
  text.add("connectivity", connectivity);
  text.add("offsets", offsets);
  text.close(section);
}

}  // namespace

bool is_surface_name(const std::filesystem::path& path) {
  const std::string ending = io_detail::lower_case(path.extension().string());
  return ending == ".ply" || ending == ".stl" || ending == ".obj" || ending == ".vtp";
}

TriMesh read_cloud(const std::filesystem::path& path) {
  const std::string ending = io_detail::lower_case(path.extension().string());
  TriMesh surface;
  if (ending == ".ply")
    surface = io_detail::read_ply(path);
  else if (ending == ".stl")
    surface = io_detail::read_stl(path);
  else if (ending == ".obj")
    surface = io_detail::read_obj(path);
  else if (ending == ".vtp")
    surface = io_detail::read_vtp_surface(path);
  else
    throw DataError(path, "", fmt::format("the ending '{}'", ending), kSurfaceFormats);
  if (surface.vertices.empty()) throw DataError(path, "", "no points", "at least one");
  return surface;
}

TriMesh read_surface(const std::filesystem::path& path) {
  TriMesh surface = read_cloud(path);
  if (surface.triangles.empty()) throw DataError(path, "", "no triangles", "a triangle surface");
  return surface;
}

void write_vtp(const std::filesystem::path& path, const TriMesh& surface) {
  io_detail::require_writable(surface);
  const std::size_t points = surface.vertices.size();
  const bool is_cloud = surface.triangles.empty();
  io_detail::VtkXmlText text("PolyData", piece_counts(points, is_cloud ? points : 0, 0, surface.triangles.size()));
  text.add_data("PointData", surface.point_data);
  text.add_points(surface.vertices);
  const std::size_t width = is_cloud ? 1 : 3;
  std::vector<std::int32_t> connectivity, offsets(is_cloud ? points : surface.triangles.size());
  for (const Triangle& triangle : surface.triangles) {
    for (const VertexId id : triangle) connectivity.push_back(id.value);
  }
  if (is_cloud) {
    connectivity.resize(points);
    std::iota(connectivity.begin(), connectivity.end(), 0);
  }
  for (std::size_t i = 0; i < offsets.size(); ++i) offsets[i] = static_cast<std::int32_t>((i + 1) * width);
  add_cells(text, is_cloud ? "Verts" : "Polys", connectivity, offsets);
  write_atomically(path, text.finish());
}

void write_vtp(const std::filesystem::path& path, std::span<const Contour> contours,
               const std::map<std::string, DataArray>& point_data) {
  Points points;
  std::vector<std::int32_t> connectivity, offsets;
  for (const Contour& contour : contours) {
    INCISE_REQUIRE(!contour.points.empty(), "expected contours with points, found an empty one");
    const auto first = static_cast<std::int32_t>(points.size());
    for (const Vec3& p : contour.points) {
      connectivity.push_back(static_cast<std::int32_t>(points.size()));
      points.push_back(p);
    }
    if (contour.is_closed) connectivity.push_back(first);
    offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
  }
  io_detail::require_finite_points(points);
  io_detail::require_data(point_data, points.size());
  io_detail::VtkXmlText text("PolyData", piece_counts(points.size(), 0, offsets.size(), 0));
  text.add_data("PointData", point_data);
  text.add_points(points);
  add_cells(text, "Lines", connectivity, offsets);
  write_atomically(path, text.finish());
}

}  // namespace incise
