#include "io/surface_readers.hpp"
#include "io/text_cursor.hpp"
#include "io/vtk_xml_reader.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <map>

namespace incise::io_detail {
namespace {

constexpr std::size_t kHeaderSize = 80;
constexpr std::size_t kRecordSize = 50;  // normal and three corners as 32-bit floats, and two bytes

/// Makes one vertex of corners with equal coordinates, because STL repeats a corner in every triangle.
class Merger {
 public:
  explicit Merger(TriMesh& surface) : surface_(surface) {}
  VertexId vertex_at(const Vec3& p) {
    const auto [item, is_new] = ids_.emplace(std::array<double, 3>{p.x(), p.y(), p.z()}, surface_.vertices.size());
    if (is_new) surface_.vertices.push_back(p);
    return VertexId(item->second);
  }

 private:
  TriMesh& surface_;
  std::map<std::array<double, 3>, std::size_t> ids_;
};

TriMesh read_binary(const std::filesystem::path& path, std::string_view data, std::size_t count) {
  TriMesh surface;
  Merger merger(surface);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<float, 9> numbers;
    std::memcpy(numbers.data(), data.data() + kHeaderSize + 4 + i * kRecordSize + 12, sizeof numbers);
    Triangle triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p(numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]);
      if (!p.allFinite()) {
        throw DataError(path, fmt::format("triangle {}, corner {}", i, k), "not-a-number coordinates",
                        "finite coordinates");
      }
      triangle[k] = merger.vertex_at(p);
    }
    surface.triangles.push_back(triangle);
  }
  return surface;
}

TriMesh read_ascii(const std::filesystem::path& path, std::string_view text) {
  TriMesh surface;
  Merger merger(surface);
  TextCursor cursor(path, text);
  cursor.require("solid");
  cursor.line();
  while (true) {
    const std::string_view keyword = cursor.word("'facet' or 'endsolid'");
    if (keyword == "endsolid") break;
    if (keyword != "facet") cursor.fail(shown_word(keyword), "'facet' or 'endsolid'");
    cursor.line();  // the normal, which follows from the order of the corners
    cursor.require("outer");
    cursor.require("loop");
    Triangle triangle;
    for (VertexId& id : triangle) {
      cursor.require("vertex");
      id = merger.vertex_at(read_point(cursor, "coordinate"));
    }
    cursor.require("endloop");
    cursor.require("endfacet");
    surface.triangles.push_back(triangle);
  }
  return surface;
}

}  // namespace

TriMesh read_stl(const std::filesystem::path& path) {
  const std::string data = read_text(path);
  std::uint32_t count = 0;
  if (data.size() >= kHeaderSize + 4) std::memcpy(&count, data.data() + kHeaderSize, 4);
  const std::size_t binary_size = kHeaderSize + 4 + count * kRecordSize;
  const bool is_binary = data.size() >= kHeaderSize + 4 && data.size() == binary_size;
  // "solid" also begins the header of some binary files, so the size decides first.
  const bool is_ascii = !is_binary && data.rfind("solid", 0) == 0 && data.find('\0') == std::string::npos;
  if (!is_binary && !is_ascii) {
    throw DataError(
        path, "", fmt::format("{} bytes", data.size()),
        data.size() < kHeaderSize + 4
            ? "an STL file"
            : fmt::format("{} bytes for the {} triangles that a binary STL header states", binary_size, count),
        "It looks truncated or is not an STL file.");
  }
  TriMesh surface = is_binary ? read_binary(path, data, count) : read_ascii(path, data);
  const std::string_view heading = std::string_view(data).substr(0, is_binary ? kHeaderSize : data.find('\n'));
  if (says_ras(heading)) turn_over(surface.vertices);
  return surface;
}

}  // namespace incise::io_detail
