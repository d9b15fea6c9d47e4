#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <pugixml.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace incise::io_detail {

/// Numbers of one <DataArray>, whatever their type in the file.
struct VtkArray {
  DataArray data;
  bool is_floating = false;
};
using VtkArrays = std::map<std::string, VtkArray>;

/// A VTK XML file (`.vtu`, `.vtp`) in memory: finds the piece, decodes its arrays.
/// Formats ascii, binary (base64), appended (raw or base64); zlib compression; both byte orders; 32- and 64-bit block
/// headers.
class VtkXmlFile {
 public:
  /// @param kind  "UnstructuredGrid" or "PolyData".  @throws DataError if the file is no such thing, or has several
  /// pieces.
  VtkXmlFile(const std::filesystem::path& path, const std::string& kind);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// A count stated by the piece, such as NumberOfPoints; 0 if it is not stated. @throws DataError if it is no count.
  [[nodiscard]] std::size_t count(const char* attribute) const;
  /// The coordinates, finite, turned to LPS if the file is stamped SPACE=RAS. @throws DataError naming the vertex.
  [[nodiscard]] Points points() const;
  /// The array called `name` in a section of the piece such as "Cells". @throws DataError if it is missing or damaged.
  [[nodiscard]] std::vector<double> array(const char* section, const char* name) const;
  /// All numeric arrays of "PointData" or "CellData", with `items` entries each; vectors turned to LPS like the points.
  [[nodiscard]] VtkArrays arrays(const char* section, std::size_t items) const;

 private:
  [[nodiscard]] VtkArray decode(const pugi::xml_node& node) const;
  [[nodiscard]] std::string payload(const pugi::xml_node& node) const;
  void take_from_budget(const pugi::xml_node& node, std::size_t bytes) const;
  mutable std::size_t unpacked_bytes_ = 0;  ///< of all arrays so far
  [[noreturn]] void fail(const pugi::xml_node& node, std::string found, std::string expected,
                         std::string hint = "") const;

  std::filesystem::path path_;
  std::string text_;
  pugi::xml_document document_;
  pugi::xml_node piece_;
  std::string_view appended_;
  bool appended_is_base64_ = false;
  bool is_big_endian_ = false;
  bool has_long_headers_ = false;
  bool is_compressed_ = false;
  bool is_ras_ = false;
};

/// Whether a comment or stamp says that coordinates are RAS ("SPACE=RAS").
[[nodiscard]] bool says_ras(std::string_view text);

/// RAS <-> LPS: x and y change sign.
void turn_over(Points& points);
/// The same for the 3-component arrays of floating point numbers: these are taken for vectors (colours are integers).
void turn_over(VtkArrays& arrays);

[[nodiscard]] std::map<std::string, DataArray> without_types(VtkArrays arrays);

}  // namespace incise::io_detail
