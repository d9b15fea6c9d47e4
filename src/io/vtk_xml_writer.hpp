#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace incise::io_detail {

/// Builds a VTK XML file with one piece: little endian, zlib-compressed base64, stamped SPACE = LPS, length_unit = mm.
class VtkXmlText {
 public:
  /// @param kind     "UnstructuredGrid" or "PolyData".
  /// @param counts   attributes of the piece, such as R"(NumberOfPoints="8")".
  VtkXmlText(std::string kind, const std::string& counts);

  void open(const std::string& section);
  void close(const std::string& section);
  void add(const std::string& name, const DataArray& array);
  void add(const std::string& name, const std::vector<std::int32_t>& values);
  void add(const std::string& name, const std::vector<std::uint8_t>& values);
  void add_points(std::span<const Vec3> points);
  void add_data(const std::string& section, const std::map<std::string, DataArray>& arrays);
  /// Returns the whole file. @pre called last, once.
  [[nodiscard]] std::string finish();

 private:
  void add_bytes(const std::string& name, const char* type, int components, std::string_view bytes);

  std::string kind_;
  std::string text_;
};

/// Check the preconditions of all mesh writers. @throws InvalidArgument naming the first offender.
void require_finite_points(std::span<const Vec3> points);
void require_data(const std::map<std::string, DataArray>& arrays, std::size_t items);

}  // namespace incise::io_detail
