#include "io/number_text.hpp"
#include "io/surface_readers.hpp"
#include "io/text_cursor.hpp"
#include "io/vtk_bytes.hpp"
#include "io/vtk_xml_reader.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/camera_scale.hpp>
#include <incise/io/grid_cloud.hpp>
#include <incise/io/surface_io.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <ostream>
#include <sstream>

namespace incise {
namespace io_detail {
namespace {

struct Property {
  std::string name;
  std::string type;        ///< VTK XML's name for it
  std::string count_type;  ///< of a list; empty: one number
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

class PlyReader {
 public:
  PlyReader(const std::filesystem::path& path, std::string_view text, bool keeps_holes = false)
      : cursor_(path, text), keeps_holes_(keeps_holes) {}

  TriMesh read() {
    read_header();
    for (const Element& element : elements_) {
      require_room(element);
      require_one_of_each(element);
      if (element.name == "vertex")
        read_vertices(element);
      else
        read_others(element);
    }
    for (std::size_t i = 0; i < polygons_.size(); ++i) add_face(i);
    if (is_ras_) {
      turn_over(surface_.vertices);
      turn_over(data_);
    }
    surface_.point_data = without_types(std::move(data_));
    return std::move(surface_);
  }

  /// Reads a cloud with holes.
  GridCloud read_grid() {
    GridCloud grid;
    grid.cloud = read();
    grid.columns = columns_;
    grid.rows = rows_;
    const std::size_t count = grid.cloud.vertices.size();
    if (!has_grid_) {
      for (std::size_t i = 0; i < count; ++i) grid_.push_back({static_cast<double>(i)});
    }
    for (std::size_t i = 0; i < grid_.size(); ++i) {
      const auto fail = [&](const std::string& found) {
        throw DataError(cursor_.path(), fmt::format("range_grid {}", i), found,
                        fmt::format("no vertex, or one below {}", count));
      };
      if (grid_[i].size() > 1) fail(fmt::format("{} vertices", grid_[i].size()));
      grid.places.emplace_back();
      if (grid_[i].empty()) continue;
      if (!(grid_[i][0] >= 0.0 && grid_[i][0] < static_cast<double>(count))) fail(fmt::format("vertex {}", grid_[i][0]));
      const auto vertex = static_cast<std::size_t>(grid_[i][0]);
      if (grid.cloud.vertices[vertex].allFinite()) grid.places.back() = vertex;
    }
    return grid;
  }

 private:
  void read_header() {
    if (cursor_.line() != "ply") cursor_.fail("another first line", "'ply'");
    while (true) {
      const std::string keyword(cursor_.word("a header line"));
      if (keyword == "end_header") break;
      if (keyword == "format") {
        const std::string format(cursor_.word("ascii or binary_little_endian"));
        is_binary_ = format == "binary_little_endian";
        if (!is_binary_ && format != "ascii") cursor_.fail(shown_word(format), "ascii or binary_little_endian");
      } else if (keyword == "element") {
        Element element;
        element.name = cursor_.word("an element's name");
        element.count = cursor_.count(element.name);
        elements_.push_back(element);
      } else if (keyword == "property") {
        read_property();
      } else if (keyword == "comment" || keyword == "obj_info") {
        const std::string_view line = cursor_.line();
        is_ras_ = is_ras_ || says_ras(line);
        if (keeps_holes_) read_size(line);
        continue;
      } else {
        cursor_.fail(shown_word(keyword), "a PLY header line");
      }
      cursor_.line();
    }
    cursor_.line();
  }

  /// `num_cols W` or `num_rows H` of an obj_info line.
  void read_size(std::string_view line) {
    constexpr int kMost = 100000;
    std::istringstream words{std::string(line)};
    std::string key, value;
    if (!(words >> key >> value) || (key != "num_cols" && key != "num_rows")) return;
    const auto number = to_number(value);
    if (!number || !(*number >= 1.0 && *number <= kMost) || *number != std::floor(*number)) {
      throw DataError(cursor_.path(), "header, " + key, shown_word(value), fmt::format("a whole number from 1 to {}", kMost));
    }
    (key == "num_cols" ? columns_ : rows_) = static_cast<int>(*number);
  }

  void read_property() {
    if (elements_.empty()) cursor_.fail("a property", "an element first");
    Property property;
    std::string_view type = cursor_.word("a number type");
    if (type == "list") {
      property.count_type = vtk_type(cursor_.word("a number type"));
      type = cursor_.word("a number type");
    }
    property.type = vtk_type(type);
    property.name = cursor_.word("a property's name");
    elements_.back().properties.push_back(property);
  }

  [[nodiscard]] std::string vtk_type(std::string_view word) const {
    if (word == "double" || word == "float64") return "Float64";
    if (word == "float" || word == "float32") return "Float32";
    if (word == "int" || word == "int32") return "Int32";
    if (word == "uint" || word == "uint32") return "UInt32";
    if (word == "short" || word == "int16") return "Int16";
    if (word == "ushort" || word == "uint16") return "UInt16";
    if (word == "char" || word == "int8") return "Int8";
    if (word == "uchar" || word == "uint8") return "UInt8";
    cursor_.fail(shown_word(word), "a PLY number type");
  }

  double number(const std::string& type, std::string_view what) {
    if (!is_binary_) return keeps_holes_ ? number_or_none(what) : cursor_.number(what);
    return numbers_from_bytes(std::string(cursor_.bytes(size_of_vtk_type(type), what)), type, false).front();
  }

  /// Reads a number, or `nan` where nothing was measured.
  double number_or_none(std::string_view what) {
    const std::string_view word = cursor_.word(what);
    const std::string text = lower_case(std::string(word));
    if (text == "nan" || text == "-nan") return std::numeric_limits<double>::quiet_NaN();
    const auto value = to_number(word);
    if (!value || !std::isfinite(*value)) cursor_.fail(shown_word(word), fmt::format("{}: a finite number, or nan", what));
    return *value;
  }

  /// Returns the fewest bytes that one item of an element takes; an ascii number has at least a digit and a blank.
  [[nodiscard]] std::size_t least_bytes(const Element& element) const {
    std::size_t bytes = 0;
    for (const Property& property : element.properties) {
      const std::string& type = property.count_type.empty() ? property.type : property.count_type;
      bytes += is_binary_ ? size_of_vtk_type(type) : 2;
    }
    return bytes;
  }

  /// Checks, before allocating memory, that the rest of the file can hold the number of items that the header states.
  void require_room(const Element& element) const {
    const std::size_t last_blank = is_binary_ ? 0 : 1;  // the last number of a file may end it
    if (element.count <= (cursor_.bytes_left() + last_blank) / std::max<std::size_t>(1, least_bytes(element))) return;
    throw DataError(cursor_.path(), "header", fmt::format("{} items of '{}' in the last {} bytes", element.count, element.name, cursor_.bytes_left()),
                    "a complete file", "It looks truncated.");
  }

  void require_one_of_each(const Element& element) const {
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        if (element.properties[i].name != element.properties[k].name) continue;
        throw DataError(cursor_.path(), "header", fmt::format("the property '{}' of '{}' twice", shown_word(element.properties[i].name), element.name), "each property once");
      }
    }
  }

  void read_vertices(const Element& element) {
    if (has_vertices_) throw DataError(cursor_.path(), "header", "a second element vertex", "one");
    has_vertices_ = true;
    for (const char* axis : {"x", "y", "z"}) {
      const bool is_there = std::any_of(element.properties.begin(), element.properties.end(), [axis](const Property& p) { return p.name == axis; });
      if (!is_there) throw DataError(cursor_.path(), "header", fmt::format("no vertex property {}", axis), "x, y and z");
    }
    surface_.vertices.resize(element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
      for (const Property& property : element.properties) {
        if (!property.count_type.empty()) cursor_.fail("a list of the vertices", "plain numbers");
        const double value = number(property.type, property.name);
        if (!std::isfinite(value) && !(keeps_holes_ && std::isnan(value))) {
          throw DataError(cursor_.path(), fmt::format("vertex {}", i), fmt::format("{} = {}", property.name, value),
                          "a finite number");
        }
        store(i, element.count, property, value);
      }
    }
  }

  void store(std::size_t i, std::size_t count, const Property& property, double value) {
    const std::string& name = property.name;
    if (name.size() == 1 && name[0] >= 'x' && name[0] <= 'z') {
      surface_.vertices[i][name[0] - 'x'] = value;
      return;
    }
    std::string array_name = name;
    std::size_t component = 0;
    int components = 1;
    if (name.size() == 2 && name[0] == 'n' && name[1] >= 'x' && name[1] <= 'z') {
      array_name = "normals";
      component = static_cast<std::size_t>(name[1] - 'x');
      components = 3;
    }
    VtkArray& array = data_[array_name];
    if (array.data.values.empty()) {
      array.data = {components, std::vector<double>(count * static_cast<std::size_t>(components), 0.0)};
      array.is_floating = property.type.rfind("Float", 0) == 0;
    }
    if (array.data.components != components) {
      throw DataError(cursor_.path(), "header", fmt::format("the vertex properties '{}' and 'nx', 'ny', 'nz'", array_name), "one or the other");
    }
    array.data.values[i * static_cast<std::size_t>(components) + component] = value;
  }

  void read_others(const Element& element) {
    for (std::size_t i = 0; i < element.count; ++i) {
      for (const Property& property : element.properties) {
        const bool is_list = !property.count_type.empty();
        const double length = is_list ? number(property.count_type, "list length") : 1.0;
        if (!(length >= 0.0 && length <= static_cast<double>(cursor_.bytes_left()))) {
          throw DataError(cursor_.path(), fmt::format("{} {}", element.name, i), fmt::format("a list of {}", length),
                          "a shorter list");
        }
        std::vector<double> values;
        for (std::size_t k = 0; k < static_cast<std::size_t>(length); ++k)
          values.push_back(number(property.type, property.name));
        if (element.name == "range_grid" && is_list) {
          has_grid_ = true;
          grid_.push_back(values);
        }
        const bool is_corners = property.name == "vertex_indices" || property.name == "vertex_index";
        if (element.name != "face" || !is_list || !is_corners) continue;
        if (values.size() < 3) throw DataError(cursor_.path(), fmt::format("face {}", polygons_.size()), fmt::format("{} corners", values.size()), "3 or more");
        polygons_.push_back(std::move(values));
      }
    }
  }

  void add_face(std::size_t face) {
    std::vector<VertexId> corners;
    const auto place = [&] { return fmt::format("face {}", face); };
    for (const double index : polygons_[face]) {
      if (!(index >= 0.0 && index < static_cast<double>(surface_.vertices.size()))) {
        throw DataError(cursor_.path(), place(), fmt::format("vertex {}", index),
                        fmt::format("a vertex below {}", surface_.vertices.size()));
      }
      corners.push_back(VertexId(static_cast<std::size_t>(index)));
    }
    add_polygon(surface_, corners);
  }

  TextCursor cursor_;
  bool keeps_holes_ = false;
  int columns_ = 0, rows_ = 0;
  bool has_grid_ = false;
  std::vector<std::vector<double>> grid_;
  bool is_binary_ = false;
  bool has_vertices_ = false;
  bool is_ras_ = false;
  std::vector<Element> elements_;
  TriMesh surface_;
  VtkArrays data_;
  std::vector<std::vector<double>> polygons_;
};

/// Returns the names of the PLY properties that hold an array's columns.
std::vector<std::string> column_names(const std::string& name, int components) {
  if (name == "normals" && components == 3) return {"nx", "ny", "nz"};
  if (components == 1) return {name};
  std::vector<std::string> names;
  for (int k = 0; k < components; ++k) names.push_back(fmt::format("{}_{}", name, k));
  return names;
}

template <class Number>
void put(std::ostream& stream, Number value) {
  stream.write(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

TriMesh read_ply(const std::filesystem::path& path) {
  const std::string text = read_text(path);
  return PlyReader(path, text).read();
}

}  // namespace io_detail

namespace {

constexpr const char* kScaleMark = "comment incise.camera_scale ";

std::string id_comment(std::string_view specimen_id) {
  return specimen_id.empty() ? std::string() : fmt::format("comment incise.specimen_id {}\n", specimen_id);
}

void write_ply_with(const std::string& comments, const std::filesystem::path& path, const TriMesh& surface) {
  io_detail::require_writable(surface);
  std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment SPACE=LPS\ncomment length unit mm\n{}element vertex {}\n", comments,
      surface.vertices.size());
  for (const char* axis : {"x", "y", "z"}) header += fmt::format("property double {}\n", axis);
  for (const auto& [name, array] : surface.point_data) {
    for (const auto& column : io_detail::column_names(name, array.components)) {
      INCISE_REQUIRE(column.find_first_of(" \t\r\n") == std::string::npos && !column.empty(),
                     fmt::format("expected array names without blanks, found '{}'", column));
      header += fmt::format("property double {}\n", column);
    }
  }
  header +=
      fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n", surface.triangles.size());
  write_atomically(path, [&](std::ostream& stream) {
    stream << header;
    for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
      for (int k = 0; k < 3; ++k) io_detail::put(stream, surface.vertices[i][k]);
      for (const auto& [name, array] : surface.point_data) {
        const std::size_t width = static_cast<std::size_t>(array.components);
        for (std::size_t k = 0; k < width; ++k) io_detail::put(stream, array.values[i * width + k]);
      }
    }
    for (const Triangle& triangle : surface.triangles) {
      io_detail::put(stream, std::uint8_t{3});
      for (const VertexId id : triangle) io_detail::put(stream, id.value);
    }
  });
}

}  // namespace

GridCloud read_grid_cloud(const std::filesystem::path& path) {
  if (io_detail::lower_case(path.extension().string()) != ".ply")
    throw DataError(path, "", fmt::format("the ending '{}'", path.extension().string()), ".ply, for an organised cloud");
  const std::string text = read_text(path);
  return io_detail::PlyReader(path, text, true).read_grid();
}

void write_ply(const std::filesystem::path& path, const TriMesh& surface, std::string_view specimen_id) {
  write_ply_with(id_comment(specimen_id), path, surface);
}

void write_ply_at_true_size(const std::filesystem::path& path, const TriMesh& cloud, double camera_scale,
                            std::string_view specimen_id) {
  INCISE_REQUIRE(camera_scale >= kLeastCameraScale && camera_scale <= kMostCameraScale,
                 fmt::format("expected a camera's scale from {} to {}, found {}", kLeastCameraScale, kMostCameraScale,
                             camera_scale));
  write_ply_with(fmt::format("{}{}\n", kScaleMark, camera_scale) + id_comment(specimen_id), path, cloud);
}

double camera_scale_of(const std::filesystem::path& path) {
  if (io_detail::lower_case(path.extension().string()) != ".ply") return 1.0;
  const std::string text = read_text(path);
  const std::string_view header = std::string_view(text).substr(0, text.find("\nend_header"));
  const std::size_t place = header.find(kScaleMark);
  if (place == std::string_view::npos) return 1.0;
  const std::size_t begin = place + std::string_view(kScaleMark).size();
  const std::string value(header.substr(begin, header.find_first_of("\r\n", begin) - begin));
  char* end = nullptr;
  const double scale = std::strtod(value.c_str(), &end);
  if (end == value.c_str() || *end != '\0' || !(scale >= kLeastCameraScale && scale <= kMostCameraScale)) {
    throw DataError(path, "header, incise.camera_scale", fmt::format("'{}'", value),
                    fmt::format("a number from {} to {}", kLeastCameraScale, kMostCameraScale));
  }
  return scale;
}

}  // namespace incise
