#include "io/mesh_readers.hpp"
#include "io/number_text.hpp"
#include "io/text_cursor.hpp"
#include "io/vtk_bytes.hpp"
#include "io/vtk_xml_reader.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise::io_detail {
namespace {

/// Returns the XML format's name for a legacy number type; empty for any other word.
std::string xml_type(std::string_view legacy) {
  const std::string type = lower_case(legacy);
  if (type == "double") return "Float64";
  if (type == "float") return "Float32";
  if (type == "int") return "Int32";
  if (type == "unsigned_int") return "UInt32";
  if (type == "long" || type == "vtktypeint64" || type == "vtkidtype") return "Int64";
  if (type == "unsigned_long" || type == "vtktypeuint64") return "UInt64";
  if (type == "short") return "Int16";
  if (type == "unsigned_short") return "UInt16";
  if (type == "char") return "Int8";
  if (type == "unsigned_char") return "UInt8";
  return "";
}

class LegacyReader {
 public:
  LegacyReader(const std::filesystem::path& path, std::string_view text) : cursor_(path, text) {}

  TetMesh read() {
    read_header();
    while (!cursor_.is_at_end()) read_section();
    if (cells_.types.size() != cells_.ends.size()) {
      cursor_.fail(fmt::format("{} cell types for {} cells", cells_.types.size(), cells_.ends.size()), "one for each");
    }
    auto [tets, from] = tets_among(cells_, mesh_.vertices.size(), cursor_.path());
    mesh_.tets = std::move(tets);
    if (is_ras_) {
      turn_over(mesh_.vertices);
      turn_over(point_data_);
      turn_over(cell_data_);
    }
    mesh_.point_data = without_types(std::move(point_data_));
    for (auto& [name, array] : cell_data_) mesh_.cell_data[name] = chosen(array.data, from);
    return std::move(mesh_);
  }

 private:
  void read_header() {
    const std::string first(cursor_.line());
    constexpr std::string_view kBegin = "# vtk DataFile Version ";
    if (first.rfind(kBegin, 0) != 0) cursor_.fail("another first line", "'# vtk DataFile Version …'");
    const auto version = to_number(trimmed(std::string_view(first).substr(kBegin.size())));
    if (!version || *version < 1.0 || *version >= 6.0) cursor_.fail(shown_word(first), "version 1 to 5");
    has_offset_arrays_ = *version >= 5.0;
    is_ras_ = says_ras(cursor_.line());
    const std::string encoding = lower_case(cursor_.word("ASCII or BINARY"));
    if (encoding != "ascii" && encoding != "binary") cursor_.fail(shown_word(encoding), "ASCII or BINARY");
    is_binary_ = encoding == "binary";
    cursor_.require("DATASET");
    const std::string kind(cursor_.word("UNSTRUCTURED_GRID"));
    if (lower_case(kind) != "unstructured_grid") cursor_.fail(kind, "UNSTRUCTURED_GRID");
  }

  void read_section() {
    const std::string section = lower_case(cursor_.word("a section"));
    if (section == "points")
      read_points();
    else if (section == "cells")
      read_cells();
    else if (section == "cell_types")
      cells_.types = numbers(cursor_.count("cell types"), "Int32");
    else if (section == "point_data")
      begin_data(point_data_, mesh_.vertices.size());
    else if (section == "cell_data")
      begin_data(cell_data_, cells_.ends.size());
    else if (section == "field")
      read_field(data_, items_);
    else if (section == "metadata")
      skip_metadata();
    else if (data_ != nullptr)
      read_attribute(section);
    else
      cursor_.fail(shown_word(section), "POINTS, CELLS, CELL_TYPES, POINT_DATA, CELL_DATA or FIELD");
  }

  std::string type_word() {
    const std::string word(cursor_.word("a number type"));
    const std::string type = xml_type(word);
    if (type.empty()) cursor_.fail(fmt::format("type {}", shown_word(word)), "a number type");
    return type;
  }

  /// Binary numbers are big endian and begin after the line that announces them.
  std::vector<double> numbers(std::size_t count, const std::string& type) {
    if (count > cursor_.bytes_left()) cursor_.fail(fmt::format("{} numbers in the last {} bytes", count, cursor_.bytes_left()), "a complete file", "It looks truncated.");
    if (is_binary_) {
      cursor_.line();
      return numbers_from_bytes(std::string(cursor_.bytes(count * size_of_vtk_type(type), "numbers")), type, true);
    }
    std::vector<double> values(count);
    for (double& value : values) value = cursor_.number("value");
    return values;
  }

  void read_points() {
    const std::size_t count = cursor_.count("points");
    const std::string type = type_word();
    const std::vector<double> values = numbers(3 * count, type);
    mesh_.vertices.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      mesh_.vertices[i] = Vec3(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
      if (!mesh_.vertices[i].allFinite()) {
        throw DataError(cursor_.path(), fmt::format("vertex {}", i), "not-a-number coordinates", "finite coordinates");
      }
    }
  }

  void read_cells() {
    const std::size_t first = cursor_.count("cells");
    const std::size_t second = cursor_.count("numbers in the cell list");
    if (has_offset_arrays_) {
      cursor_.require("OFFSETS");
      std::vector<double> offsets = numbers(first, type_word());
      cursor_.require("CONNECTIVITY");
      cells_.connectivity = numbers(second, type_word());
      if (!offsets.empty()) cells_.ends.assign(offsets.begin() + 1, offsets.end());
      return;
    }
    const std::vector<double> list = numbers(second, "Int32");
    for (std::size_t at = 0, c = 0; c < first; ++c) {
      const double size = at < list.size() ? list[at] : -1.0;
      if (size < 0.0 || size > static_cast<double>(list.size() - at - 1)) {
        throw DataError(cursor_.path(), fmt::format("cell {}", c), fmt::format("{} points", size),
                        "a size inside the list");
      }
      const auto begin = list.begin() + static_cast<std::ptrdiff_t>(at) + 1;
      cells_.connectivity.insert(cells_.connectivity.end(), begin, begin + static_cast<std::ptrdiff_t>(size));
      cells_.ends.push_back(static_cast<double>(cells_.connectivity.size()));
      at += 1 + static_cast<std::size_t>(size);
    }
  }

  void begin_data(VtkArrays& data, std::size_t items) {
    const long long stated = cursor_.integer("items", 0, 0x7FFFFFFF);
    if (static_cast<std::size_t>(stated) != items)
      cursor_.fail(fmt::format("{} items", stated), fmt::format("{}", items));
    data_ = &data;
    items_ = items;
  }

  void store(VtkArrays* data, const std::string& name, const std::string& type, int components,
             std::vector<double> values) {
    for (const double value : values) {
      if (!std::isfinite(value)) cursor_.fail(fmt::format("{} in '{}'", value, name), "finite numbers");
    }
    if (data != nullptr) (*data)[name] = {{components, std::move(values)}, type.rfind("Float", 0) == 0};
  }

  void read_attribute(const std::string& section) {
    const std::string name(cursor_.word("a name"));
    int components = 3;
    if (section == "scalars") {
      const std::string type = type_word();
      components = 1;
      if (const auto word = cursor_.word_on_line()) {
        const auto value = to_integer(*word);
        if (!value || *value < 1 || *value > 9) cursor_.fail(shown_word(*word), "1 to 9 components");
        components = static_cast<int>(*value);
      }
      cursor_.require("LOOKUP_TABLE");
      cursor_.word("a table's name");
      store(data_, name, type, components, numbers(items_ * static_cast<std::size_t>(components), type));
      return;
    }
    if (section == "lookup_table") {  // colours of a scale, not needed
      const std::size_t entries = cursor_.count("table entries");
      numbers(4 * entries, "UInt8");
      return;
    }
    if (section == "tensors")
      components = 9;
    else if (section == "texture_coordinates")
      components = static_cast<int>(cursor_.integer("components", 1, 3));
    else if (section == "global_ids" || section == "pedigree_ids")
      components = 1;
    else if (section != "vectors" && section != "normals") {
      cursor_.fail(shown_word(section), "SCALARS, VECTORS, NORMALS, TENSORS or FIELD");
    }
    const std::string type = type_word();
    store(data_, name, type, components, numbers(items_ * static_cast<std::size_t>(components), type));
  }

  /// @param data  receives the arrays, which must have `items` entries each; nullptr for field data of the whole file:
  /// drops them, except SPACE
  void read_field(VtkArrays* data, std::size_t items) {
    cursor_.word("a name");
    const std::size_t arrays = cursor_.count("arrays");
    for (std::size_t i = 0; i < arrays; ++i) {
      std::string name(cursor_.word("an array's name"));
      if (lower_case(name) == "metadata") {
        skip_metadata();
        name = cursor_.word("an array's name");
      }
      const int components = static_cast<int>(cursor_.integer("components", 1, 1000));
      const std::size_t tuples = cursor_.count("tuples");
      const std::string type_name(cursor_.word("a number type"));
      if (lower_case(type_name) == "string") {
        cursor_.line();
        for (std::size_t k = 0; k < tuples; ++k) {
          const std::string_view text = cursor_.line();
          if (data == nullptr && name == "SPACE") is_ras_ = is_ras_ || trimmed(text) == "RAS" || says_ras(text);
        }
        continue;
      }
      const std::string type = xml_type(type_name);
      if (type.empty()) cursor_.fail(fmt::format("type {}", shown_word(type_name)), "a number type");
      if (data != nullptr && tuples != items)
        cursor_.fail(fmt::format("{} tuples in '{}'", tuples, name), fmt::format("{}", items));
      store(data, name, type, components, numbers(tuples * static_cast<std::size_t>(components), type));
    }
  }

  /// Skips to the line after the next empty one.
  void skip_metadata() {
    cursor_.line();
    while (cursor_.bytes_left() > 0 && !trimmed(cursor_.line()).empty()) continue;
  }

  TextCursor cursor_;
  bool has_offset_arrays_ = false;
  bool is_binary_ = false;
  bool is_ras_ = false;
  TetMesh mesh_;
  VtkCells cells_;
  VtkArrays point_data_, cell_data_;
  VtkArrays* data_ = nullptr;
  std::size_t items_ = 0;
};

}  // namespace

TetMesh read_legacy_vtk(const std::filesystem::path& path) {
  const std::string text = read_text(path);
  return LegacyReader(path, text).read();
}

}  // namespace incise::io_detail
