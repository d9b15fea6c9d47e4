#include "io/mesh_readers.hpp"
#include "io/text_cursor.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>

#include <fmt/format.h>

namespace incise::io_detail {
namespace {

constexpr long long kMostTetrahedra = 0x7FFFFFFF;

/// Reads one value for each column and appends it.
void read_attributes(TextCursor& cursor, std::vector<DataArray>& columns) {
  for (DataArray& column : columns) column.values.push_back(cursor.number("attribute"));
}

void store(std::map<std::string, DataArray>& data, std::vector<DataArray>& columns) {
  for (std::size_t k = 0; k < columns.size(); ++k) data[fmt::format("attribute_{}", k)] = std::move(columns[k]);
}

/// Reads the points. @returns the number of the first one, 0 or 1.
long long read_nodes(TextCursor& cursor, TetMesh& mesh) {
  const std::size_t count = cursor.count("points");
  cursor.integer("dimension", 3, 3);
  const long long attributes = cursor.integer("number of point attributes", 0, 1000);
  const bool has_marker = cursor.integer("boundary marker flag", 0, 1) == 1;
  std::vector<DataArray> columns(static_cast<std::size_t>(attributes));
  DataArray markers;
  long long base = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const long long expected = base + static_cast<long long>(i);
    const long long number = cursor.integer("point number", i == 0 ? 0 : expected, i == 0 ? 1 : expected);
    if (i == 0) base = number;
    mesh.vertices.push_back(read_point(cursor, "coordinate"));
    read_attributes(cursor, columns);
    if (has_marker) markers.values.push_back(cursor.number("boundary marker"));
  }
  store(mesh.point_data, columns);
  if (has_marker) mesh.point_data["boundary_marker"] = std::move(markers);
  return base;
}

void read_tets(TextCursor& cursor, TetMesh& mesh, long long base) {
  const std::size_t count = cursor.count("tetrahedra");
  cursor.integer("points per tetrahedron (4; 10-point tetrahedra are not read)", 4, 4);
  const long long attributes = cursor.integer("number of tetrahedron attributes", 0, 1000);
  std::vector<DataArray> columns(static_cast<std::size_t>(attributes));
  const long long last = base + static_cast<long long>(mesh.vertices.size()) - 1;
  for (std::size_t i = 0; i < count; ++i) {
    cursor.integer("tetrahedron number", 0, kMostTetrahedra);
    Tet tet;
    for (VertexId& id : tet) id = VertexId(static_cast<std::size_t>(cursor.integer("point number", base, last) - base));
    mesh.tets.push_back(tet);
    read_attributes(cursor, columns);
  }
  store(mesh.cell_data, columns);
}

}  // namespace

TetMesh read_tetgen(const std::filesystem::path& path) {
  const std::filesystem::path node_path = std::filesystem::path(path).replace_extension(".node");
  const std::filesystem::path ele_path = std::filesystem::path(path).replace_extension(".ele");
  const std::string nodes = read_text(node_path);
  const std::string elements = read_text(ele_path);
  TetMesh mesh;
  TextCursor node_cursor(node_path, nodes, '#');
  const long long base = read_nodes(node_cursor, mesh);
  if (mesh.vertices.empty()) node_cursor.fail("no points", "at least 4");
  TextCursor ele_cursor(ele_path, elements, '#');
  read_tets(ele_cursor, mesh, base);
  return mesh;
}

}  // namespace incise::io_detail
