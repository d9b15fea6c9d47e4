#include "io/mesh_readers.hpp"
#include "io/number_text.hpp"
#include "io/vtk_xml_reader.hpp"
#include "io/vtk_xml_writer.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/mesh_io.hpp>

#include <fmt/format.h>

namespace incise {
namespace io_detail {
namespace {

constexpr std::uint8_t kVtkTet = 10;

/// Whether a VTK cell type bounds a body rather than fills it: points, lines, triangles, polygons, pixels and quads,
/// straight or curved.
bool is_lower_dimensional(double vtk_type) {
  return (vtk_type >= 0 && vtk_type <= 9) || (vtk_type >= 21 && vtk_type <= 23) || vtk_type == 28 || vtk_type == 34;
}

}  // namespace

std::pair<std::vector<Tet>, std::vector<std::size_t>> tets_among(const VtkCells& cells, std::size_t points,
                                                                 const std::filesystem::path& path) {
  std::vector<Tet> tets;
  std::vector<std::size_t> from;
  double begin = 0.0;
  for (std::size_t c = 0; c < cells.types.size(); begin = cells.ends[c++]) {
    const auto fail = [&](std::string found, std::string expected) {
      throw DataError(path, fmt::format("cell {}", c), std::move(found), std::move(expected));
    };
    const double end = cells.ends[c];
    if (!(end >= begin && end <= static_cast<double>(cells.connectivity.size()))) {
      fail(fmt::format("points {} to {} of {}", begin, end, cells.connectivity.size()), "a range inside the list");
    }
    if (cells.types[c] != kVtkTet) {
      if (!is_lower_dimensional(cells.types[c])) {
        fail(fmt::format("VTK cell type {}", cells.types[c]), "linear tetrahedra (type 10)");
      }
      continue;
    }
    if (end - begin != 4.0) fail(fmt::format("a tetrahedron of {} points", end - begin), "4 points");
    Tet tet;
    for (std::size_t k = 0; k < 4; ++k) {
      const double index = cells.connectivity[static_cast<std::size_t>(begin) + k];
      if (!(index >= 0.0 && index < static_cast<double>(points))) {
        fail(fmt::format("point index {}", index), fmt::format("0 to {}", static_cast<double>(points) - 1));
      }
      tet[k] = VertexId(static_cast<std::size_t>(index));
    }
    tets.push_back(tet);
    from.push_back(c);
  }
  return {std::move(tets), std::move(from)};
}

DataArray chosen(const DataArray& array, const std::vector<std::size_t>& cells) {
  DataArray result{array.components, {}};
  const std::size_t width = static_cast<std::size_t>(array.components);
  result.values.reserve(cells.size() * width);
  for (const std::size_t cell : cells) {
    for (std::size_t k = 0; k < width; ++k) result.values.push_back(array.values[cell * width + k]);
  }
  return result;
}

TetMesh read_vtu(const std::filesystem::path& path) {
  const VtkXmlFile file(path, "UnstructuredGrid");
  TetMesh mesh;
  mesh.vertices = file.points();
  const VtkCells cells{file.array("Cells", "connectivity"), file.array("Cells", "offsets"),
                       file.array("Cells", "types")};
  const std::size_t stated = file.count("NumberOfCells");
  if (cells.types.size() != stated || cells.ends.size() != stated) {
    throw DataError(path, "<Cells>", fmt::format("{} offsets and {} types", cells.ends.size(), cells.types.size()),
                    fmt::format("{} of each", stated));
  }
  auto [tets, from] = tets_among(cells, mesh.vertices.size(), path);
  mesh.tets = std::move(tets);
  mesh.point_data = without_types(file.arrays("PointData", mesh.vertices.size()));
  for (auto& [name, array] : file.arrays("CellData", stated)) mesh.cell_data[name] = chosen(array.data, from);
  return mesh;
}

}  // namespace io_detail

namespace {

double volume_of(const TetMesh& mesh, const Tet& tet) {
  return signed_volume(vertex(mesh.vertices, tet[0]), vertex(mesh.vertices, tet[1]), vertex(mesh.vertices, tet[2]),
                       vertex(mesh.vertices, tet[3]));
}

/// Turns all tets over if all are negative, with a notice; refuses mixed signs and flat tets.
void make_positive(TetMesh& mesh, const std::filesystem::path& path, Monitor& monitor) {
  std::size_t negative = 0, first_negative = 0;
  for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
    const double volume = volume_of(mesh, mesh.tets[i]);
    if (volume == 0.0) throw DataError(path, fmt::format("tetrahedron {}", i), "no volume", "a volume above 0");
    if (volume < 0.0 && negative++ == 0) first_negative = i;
  }
  if (negative == 0) return;
  if (negative != mesh.tets.size()) {
    throw DataError(path, fmt::format("tetrahedron {}", first_negative),
                    fmt::format("a negative volume ({} of {} tetrahedra)", negative, mesh.tets.size()),
                    "all volumes of the same sign");
  }
  for (Tet& tet : mesh.tets) std::swap(tet[2], tet[3]);
  monitor.message(Severity::Notice,
                  fmt::format("{}: every tet has a negative volume; all are turned over by exchanging their last two corners",
                              path.string()));
}

TetMesh read_by_ending(const std::filesystem::path& path) {
  const std::string ending = io_detail::lower_case(path.extension().string());
  if (ending == ".vtu") return io_detail::read_vtu(path);
  if (ending == ".vtk") return io_detail::read_legacy_vtk(path);
  if (ending == ".msh") return io_detail::read_gmsh(path);
  if (ending == ".node" || ending == ".ele") return io_detail::read_tetgen(path);
  throw DataError(path, "", fmt::format("the ending '{}'", ending), ".vtu, .vtk, .msh, .node or .ele");
}

}  // namespace

TetMesh read_tet_mesh(const std::filesystem::path& path) {
  Monitor silent;
  return read_tet_mesh(path, silent);
}

TetMesh read_tet_mesh(const std::filesystem::path& path, Monitor& monitor) {
  TetMesh mesh = read_deformed_tet_mesh(path);
  make_positive(mesh, path, monitor);
  return mesh;
}

TetMesh read_deformed_tet_mesh(const std::filesystem::path& path) {
  TetMesh mesh = read_by_ending(path);
  if (mesh.tets.empty()) throw DataError(path, "", "no tetrahedra", "a tetrahedral mesh");
  return mesh;
}

void write_vtu(const std::filesystem::path& path, const TetMesh& mesh) {
  io_detail::require_finite_points(mesh.vertices);
  io_detail::require_data(mesh.point_data, mesh.vertices.size());
  io_detail::require_data(mesh.cell_data, mesh.tets.size());
  std::vector<std::int32_t> connectivity, offsets;
  connectivity.reserve(4 * mesh.tets.size());
  offsets.reserve(mesh.tets.size());
  for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
    for (const VertexId id : mesh.tets[i]) {
      INCISE_REQUIRE(id.is_valid() && id.index() < mesh.vertices.size(),
                     fmt::format("expected indices below {}, found {} in tet {}", mesh.vertices.size(), id.value, i));
      connectivity.push_back(id.value);
    }
    offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
  }
  io_detail::VtkXmlText text("UnstructuredGrid", fmt::format("NumberOfPoints=\"{}\" NumberOfCells=\"{}\"",
                                                             mesh.vertices.size(), mesh.tets.size()));
  text.add_data("PointData", mesh.point_data);
  text.add_data("CellData", mesh.cell_data);
  text.add_points(mesh.vertices);
  text.open("Cells");
  text.add("connectivity", connectivity);
  text.add("offsets", offsets);
  text.add("types", std::vector<std::uint8_t>(mesh.tets.size(), io_detail::kVtkTet));
  text.close("Cells");
  write_atomically(path, text.finish());
}

void require_body_size(const Box3& box, const std::filesystem::path& path) {
  const double longest_mm = box.isEmpty() ? 0.0 : box.sizes().maxCoeff();
  if (longest_mm >= kSmallestBodyMm && longest_mm <= kLargestBodyMm) return;
  throw DataError(path, "size", fmt::format("a body of {:.4g} mm along its longest side", longest_mm),
                  fmt::format("{} to {} mm", kSmallestBodyMm, kLargestBodyMm), "Lengths are mm: a mesh in metres has to be scaled by 1000");
}

}  // namespace incise
