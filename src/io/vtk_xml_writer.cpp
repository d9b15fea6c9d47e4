#include "io/vtk_xml_writer.hpp"

#include "io/vtk_bytes.hpp"

#include <incise/core/error.hpp>
#include <incise/io/text_encoding.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace incise::io_detail {
namespace {

constexpr std::size_t kBlockSize = 1 << 20;  // bytes that are compressed together

template <class Number>
std::string_view bytes_of(const std::vector<Number>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number)};
}

/// Encodes text as VTK's ascii string arrays do: the codes of its characters, then 0.
std::string field_text(const std::string& name, std::string_view value) {
  std::string codes;
  for (const char c : value) codes += fmt::format("{} ", static_cast<int>(c));
  return fmt::format("<Array type=\"String\" Name=\"{}\" NumberOfTuples=\"1\" format=\"ascii\">{}0</Array>\n", name,
                     codes);
}

}  // namespace

VtkXmlText::VtkXmlText(std::string kind, const std::string& counts) : kind_(std::move(kind)) {
  // Slicer looks for SPACE in the field data of surfaces; meshio, which reads only volume meshes, fails on text there.
  const bool is_surface = kind_ == "PolyData";
  const std::string comment = is_surface ? "" : "<!-- SPACE=LPS, lengths in mm -->\n";
  const std::string field_data =
      is_surface ? "<FieldData>\n" + field_text("SPACE", "LPS") + field_text("length_unit", "mm") + "</FieldData>\n"
                 : "";
  text_ = fmt::format(
      "<?xml version=\"1.0\"?>\n{3}<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<{0}>\n{1}<Piece {2}>\n",
      kind_, field_data, counts, comment);
}

void VtkXmlText::open(const std::string& section) {
  text_ += fmt::format("<{}>\n", section);
}

void VtkXmlText::close(const std::string& section) {
  text_ += fmt::format("</{}>\n", section);
}

void VtkXmlText::add_bytes(const std::string& name, const char* type, int components, std::string_view bytes) {
  text_ += fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">\n", type,
                       escaped(name), components);
  // Header: number of blocks, size of a full block, size of the last block if it is not full, compressed size of each.
  const std::size_t blocks = (bytes.size() + kBlockSize - 1) / kBlockSize;
  std::vector<std::uint64_t> header{blocks, kBlockSize, bytes.size() % kBlockSize};
  std::string packed;
  for (std::size_t i = 0; i < blocks; ++i) {
    const std::string block = deflated(bytes.substr(i * kBlockSize, kBlockSize));
    header.push_back(block.size());
    packed += block;
  }
  text_ += base64(bytes_of(header)) + base64(packed) + "\n</DataArray>\n";
}

void VtkXmlText::add(const std::string& name, const DataArray& array) {
  add_bytes(name, "Float64", array.components, bytes_of(array.values));
}

void VtkXmlText::add(const std::string& name, const std::vector<std::int32_t>& values) {
  add_bytes(name, "Int32", 1, bytes_of(values));
}

void VtkXmlText::add(const std::string& name, const std::vector<std::uint8_t>& values) {
  add_bytes(name, "UInt8", 1, bytes_of(values));
}

void VtkXmlText::add_points(std::span<const Vec3> points) {
  DataArray coordinates{3, {}};
  coordinates.values.reserve(3 * points.size());
  for (const Vec3& p : points) coordinates.values.insert(coordinates.values.end(), {p.x(), p.y(), p.z()});
  open("Points");
  add("Points", coordinates);
  close("Points");
}

void VtkXmlText::add_data(const std::string& section, const std::map<std::string, DataArray>& arrays) {
  open(section);
  for (const auto& [name, array] : arrays) add(name, array);
  close(section);
}

std::string VtkXmlText::finish() {
  text_ += fmt::format("</Piece>\n</{}>\n</VTKFile>\n", kind_);
  return std::move(text_);
}

void require_finite_points(std::span<const Vec3> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    INCISE_REQUIRE(points[i].allFinite(), fmt::format("expected finite coordinates, found ({}, {}, {}) at vertex {}",
                                                      points[i].x(), points[i].y(), points[i].z(), i));
  }
}

void require_data(const std::map<std::string, DataArray>& arrays, std::size_t items) {
  for (const auto& [name, array] : arrays) {
    INCISE_REQUIRE(array.components >= 1 && array.values.size() == items * static_cast<std::size_t>(array.components),
                   fmt::format("expected {} numbers for each of {} items in '{}', found {}", array.components, items,
                               name, array.values.size()));
    const auto bad = std::find_if(array.values.begin(), array.values.end(), [](double v) { return !std::isfinite(v); });
    INCISE_REQUIRE(bad == array.values.end(),
                   fmt::format("expected finite numbers in '{}', found {} as value {}", name,
                               bad == array.values.end() ? 0.0 : *bad, bad - array.values.begin()));
  }
}

}  // namespace incise::io_detail
