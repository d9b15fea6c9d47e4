#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <pugixml.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace incise::io_detail {

/// Numbers of one <DataArray>, converted from their type in the file.
struct VtkArray {
  DataArray data;
  bool is_floating = false;
};
using VtkArrays = std::map<std::string, VtkArray>;

/// A VTK XML file (`.vtu`, `.vtp`) in memory: finds the piece and decodes its arrays.
/// Supports the formats ascii, binary (base64) and appended (raw or base64), zlib compression, both byte orders, and
/// 32- and 64-bit block headers.
class VtkXmlFile {
 public:
  /// @param kind  "UnstructuredGrid" or "PolyData".  @throws DataError if the file is no such thing, or has several
  /// pieces.
  VtkXmlFile(const std::filesystem::path& path, const std::string& kind);

  /// Returns a count stated by the piece, such as NumberOfPoints; 0 if not stated. @throws DataError if it is no count.
  [[nodiscard]] std::size_t count(const char* attribute) const;
  /// Returns the coordinates, converted to LPS if the file is stamped SPACE=RAS.
  /// @throws DataError naming the first vertex that is not finite.
  [[nodiscard]] Points points() const;
  /// Returns the array `name` in a section of the piece such as "Cells". @throws DataError if it is missing or damaged.
  [[nodiscard]] std::vector<double> array(const char* section, const char* name) const;
  /// Returns all numeric arrays of "PointData" or "CellData", with `items` entries each; vectors in LPS as the points.
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

/// Converts between RAS and LPS: negates x and y.
void turn_over(Points& points);
/// The same for 3-component arrays of floating-point numbers, which are taken for vectors (colours are integers).
void turn_over(VtkArrays& arrays);

[[nodiscard]] std::map<std::string, DataArray> without_types(VtkArrays arrays);

}  // namespace incise::io_detail
