#include "io/number_text.hpp"
#include "io/surface_readers.hpp"
#include "io/text_cursor.hpp"
#include "io/vtk_xml_reader.hpp"

#include <incise/io/atomic_file.hpp>

#include <fmt/format.h>

namespace incise::io_detail {
namespace {

/// The vertex of a face corner such as "7", "7/2", "7//3" or "-1" (counted back from the last vertex so far).
VertexId corner_vertex(TextCursor& cursor, std::string_view corner, std::size_t vertices) {
  const auto number = to_integer(corner.substr(0, corner.find('/')));
  const long long count = static_cast<long long>(vertices);
  if (!number || *number == 0 || *number > count || *number < -count) {
    cursor.fail(shown_word(corner), fmt::format("a vertex number from 1 to {}", count));
  }
  return VertexId(static_cast<std::size_t>(*number > 0 ? *number - 1 : count + *number));
}

}  // namespace

TriMesh read_obj(const std::filesystem::path& path) {
  const std::string text = read_text(path);
  TextCursor cursor(path, text, '#');
  TriMesh surface;
  while (!cursor.is_at_end()) {
    const std::string_view keyword = cursor.word("a keyword");
    if (keyword == "v") {
      surface.vertices.push_back(read_point(cursor, "coordinate"));
    } else if (keyword == "f") {
      std::vector<VertexId> corners;
      while (const auto corner = cursor.word_on_line()) {
        corners.push_back(corner_vertex(cursor, *corner, surface.vertices.size()));
      }
      if (corners.size() < 3) cursor.fail(fmt::format("a face with {} corners", corners.size()), "3 or more");
      add_polygon(surface, corners);
    } else {
      static constexpr std::string_view kOthers[] = {"vt", "vn", "vp", "g", "o", "s", "l", "p", "usemtl", "mtllib"};
      bool is_known = false;
      for (const auto other : kOthers) is_known = is_known || keyword == other;
      if (!is_known) cursor.fail(shown_word(keyword), "a line of a Wavefront .obj file");
    }
    cursor.line();
  }
  if (says_ras(text)) turn_over(surface.vertices);
  return surface;
}

}  // namespace incise::io_detail
