#include "io/vtk_xml_reader.hpp"

#include "io/number_text.hpp"
#include "io/vtk_bytes.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise::io_detail {
namespace {

// Limits on all arrays of a file together, unpacked, as doubles. Compression shrinks coordinates and connectivity to
// about a third, constant arrays to almost nothing.
constexpr std::size_t kFreeBytes = 64 << 20;
constexpr std::size_t kMostBytesPerByte = 64;
constexpr std::size_t kZlibLargestGain = 1032;  // deflate cannot shrink more than this, so larger claims are damage

std::uint64_t header_word(const std::string& bytes, std::size_t word, bool is_long, bool is_big_endian) {
  const std::size_t size = is_long ? 8 : 4;
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t from = is_big_endian ? i : size - 1 - i;
    value = value << 8 | static_cast<unsigned char>(bytes[word * size + from]);
  }
  return value;
}

/// Returns the text of a field array. Slicer stamps the array SPACE with "LPS" or "RAS"; VTK writes text arrays in
/// ascii as character codes.
std::string text_of_field(const pugi::xml_node& array) {
  std::string text;
  std::string_view rest = trimmed(array.text().get());
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find_first_of(" \t\r\n"), rest.size());
    const auto code = to_integer(rest.substr(0, end));
    if (!code) return std::string(trimmed(array.text().get()));  // plain text, as some programs write
    if (*code > 0) text += static_cast<char>(*code);
    rest = trimmed(rest.substr(end));
  }
  return text;
}

std::string describe(const pugi::xml_node& node) {
  const std::string name = node.attribute("Name").as_string();
  return name.empty() ? fmt::format("<{}> in <{}>", node.name(), node.parent().name())
                      : fmt::format("array '{}'", name);
}

}  // namespace

bool says_ras(std::string_view text) {
  return text.find("SPACE=RAS") != std::string_view::npos;
}

void turn_over(Points& points) {
  for (Vec3& p : points) p = Vec3(-p.x(), -p.y(), p.z());
}

void turn_over(VtkArrays& arrays) {
  for (auto& [name, array] : arrays) {
    if (!array.is_floating || array.data.components != 3) continue;
    for (std::size_t i = 0; i < array.data.values.size(); ++i) {
      if (i % 3 != 2) array.data.values[i] = -array.data.values[i];
    }
  }
}

std::map<std::string, DataArray> without_types(VtkArrays arrays) {
  std::map<std::string, DataArray> result;
  for (auto& [name, array] : arrays) result[name] = std::move(array.data);
  return result;
}

void VtkXmlFile::fail(const pugi::xml_node& node, std::string found, std::string expected, std::string hint) const {
  throw DataError(path_, describe(node), std::move(found), std::move(expected), std::move(hint));
}

VtkXmlFile::VtkXmlFile(const std::filesystem::path& path, const std::string& kind)
    : path_(path), text_(read_text(path)) {
  // Raw appended data are not XML, so they are removed before parsing.
  std::string xml = text_;
  const std::size_t tag = text_.find("<AppendedData");
  if (tag != std::string::npos) {
    const std::size_t mark = text_.find('_', text_.find('>', tag));
    const std::size_t end = text_.rfind("</AppendedData");
    if (mark == std::string::npos || end == std::string::npos || end < mark) {
      throw DataError(path_, "<AppendedData>", "no data or no end tag", "'_', the data and </AppendedData>",
                      "It looks truncated.");
    }
    appended_is_base64_ = text_.substr(tag, text_.find('>', tag) - tag).find("\"base64\"") != std::string::npos;
    appended_ = std::string_view(text_).substr(mark + 1, end - mark - 1);
    xml = text_.substr(0, tag) + "</VTKFile>";
  }
  const pugi::xml_parse_result parsed = document_.load_buffer(xml.data(), xml.size());
  if (!parsed) {
    const auto line = 1 + std::count(xml.begin(),
                                     xml.begin() + static_cast<std::ptrdiff_t>(
                                                       std::min(static_cast<std::size_t>(parsed.offset), xml.size())),
                                     '\n');
    throw DataError(path_, fmt::format("line {}", line), parsed.description(),
                    fmt::format("a VTK XML file ({})", kind));
  }
  const pugi::xml_node file = document_.child("VTKFile");
  const std::string found_kind = file.attribute("type").as_string();
  if (found_kind != kind) {
    throw DataError(path_, "<VTKFile>", found_kind.empty() ? "no type" : fmt::format("type '{}'", found_kind),
                    fmt::format("type '{}'", kind));
  }
  is_big_endian_ = std::string_view(file.attribute("byte_order").as_string()) == "BigEndian";
  has_long_headers_ = std::string_view(file.attribute("header_type").as_string()) == "UInt64";
  const std::string compressor = file.attribute("compressor").as_string();
  is_compressed_ = !compressor.empty();
  if (is_compressed_ && compressor != "vtkZLibDataCompressor") {
    throw DataError(path_, "<VTKFile>", compressor, "no compressor or vtkZLibDataCompressor",
                    "Save it with zlib compression.");
  }
  const pugi::xml_node data = file.child(kind.c_str());
  piece_ = data.child("Piece");
  if (!piece_) throw DataError(path_, fmt::format("<{}>", kind), "no <Piece>", "one piece");
  if (piece_.next_sibling("Piece")) throw DataError(path_, fmt::format("<{}>", kind), "several pieces", "one piece");
  for (const pugi::xml_node& array : data.child("FieldData").children()) {
    if (std::string_view(array.attribute("Name").as_string()) != "SPACE") continue;
    const std::string space = text_of_field(array);
    is_ras_ = space == "RAS" || says_ras(space);
  }
}

std::size_t VtkXmlFile::count(const char* attribute) const {
  const pugi::xml_attribute found = piece_.attribute(attribute);
  if (!found) return 0;
  const auto value = to_integer(trimmed(found.as_string()));
  if (!value || *value < 0 || *value > 0x7FFFFFFF) {
    throw DataError(path_, "<Piece>", fmt::format("{} '{}'", attribute, found.as_string()), "a count below 2^31");
  }
  return static_cast<std::size_t>(*value);
}

/// Refuses a small file that unpacks to very many bytes.
void VtkXmlFile::take_from_budget(const pugi::xml_node& node, std::size_t bytes) const {
  const std::size_t most = kFreeBytes + kMostBytesPerByte * text_.size();
  if (bytes <= most - std::min(most, unpacked_bytes_)) {
    unpacked_bytes_ += bytes;
    return;
  }
  fail(node, fmt::format("data that unpack to more than {} bytes, in a file of {}", most, text_.size()),
       "a file that is compressed less");
}

/// Returns the decoded, decompressed bytes of an array that is not ascii.
std::string VtkXmlFile::payload(const pugi::xml_node& node) const {
  const bool is_appended = std::string_view(node.attribute("format").as_string()) == "appended";
  const std::size_t offset = node.attribute("offset").as_ullong();
  if (is_appended && offset >= appended_.size()) {
    fail(node, fmt::format("offset {} into {} appended bytes", offset, appended_.size()), "an offset inside the data",
         "It looks truncated.");
  }
  ByteSource source = is_appended ? ByteSource(appended_.substr(offset), appended_is_base64_)
                                  : ByteSource(trimmed(node.text().get()), true);
  const auto take = [&](std::uint64_t size) {
    auto bytes = source.take(size);
    if (!bytes)
      fail(node, fmt::format("fewer than {} bytes", size), "the bytes that its header states", "It looks truncated.");
    return *std::move(bytes);
  };
  const std::size_t word_size = has_long_headers_ ? 8 : 4;
  const auto word = [&](const std::string& bytes, std::size_t i) {
    return header_word(bytes, i, has_long_headers_, is_big_endian_);
  };
  if (!is_compressed_) return take(word(take(word_size), 0));
  // Unpacked numbers become doubles: an 8-bit integer then takes eight bytes.
  const std::size_t value_gain = sizeof(double) / std::max<std::size_t>(1, size_of_vtk_type(node.attribute("type").as_string())) + 1;

  const std::string sizes = take(3 * word_size);
  const std::uint64_t blocks = word(sizes, 0), block_size = word(sizes, 1), last_size = word(sizes, 2);
  if (blocks > source.bytes_left() / word_size)
    fail(node, fmt::format("{} compressed blocks", blocks), "a smaller count");
  const std::string lengths = take(blocks * word_size);
  std::string result;
  for (std::uint64_t i = 0; i < blocks; ++i) {
    const std::string packed = take(word(lengths, i));
    const std::uint64_t size = i + 1 == blocks && last_size > 0 ? last_size : block_size;
    const bool is_possible = size <= (packed.size() + 16) * kZlibLargestGain;
    if (is_possible) take_from_budget(node, size * value_gain);
    const auto unpacked = is_possible ? inflated(packed, size) : std::nullopt;
    if (!unpacked) fail(node, fmt::format("damaged block {}", i), "zlib-compressed data");
    result += *unpacked;
  }
  return result;
}

VtkArray VtkXmlFile::decode(const pugi::xml_node& node) const {
  const std::string type = node.attribute("type").as_string();
  const std::size_t size = size_of_vtk_type(type);
  if (size == 0) fail(node, fmt::format("type '{}'", type), "a numeric type");
  VtkArray array;
  array.is_floating = type.rfind("Float", 0) == 0;
  array.data.components = node.attribute("NumberOfComponents").as_int(1);
  if (array.data.components < 1) fail(node, fmt::format("{} components", array.data.components), "1 or more");
  if (std::string_view(node.attribute("format").as_string("ascii")) != "ascii") {
    std::string bytes = payload(node);
    if (bytes.size() % size != 0)
      fail(node, fmt::format("{} bytes", bytes.size()), fmt::format("a multiple of {}", size));
    array.data.values = numbers_from_bytes(std::move(bytes), type, is_big_endian_);
    return array;
  }
  std::string_view rest = trimmed(node.text().get());
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find_first_of(" \t\r\n"), rest.size());
    const auto value = to_number(rest.substr(0, end));
    if (!value)
      fail(node,
           fmt::format("'{}' as value {}", rest.substr(0, std::min<std::size_t>(end, 40)), array.data.values.size()),
           "a number");
    array.data.values.push_back(*value);
    rest = trimmed(rest.substr(end));
  }
  return array;
}

Points VtkXmlFile::points() const {
  const pugi::xml_node node = piece_.child("Points").child("DataArray");
  const std::size_t expected = count("NumberOfPoints");
  if (!node && expected == 0) return {};
  if (!node) throw DataError(path_, "<Points>", "no DataArray", "the coordinates");
  const VtkArray array = decode(node);
  if (array.data.components != 3 || array.data.values.size() != 3 * expected) {
    fail(node, fmt::format("{} numbers in groups of {}", array.data.values.size(), array.data.components),
         fmt::format("3 coordinates for each of {} points", expected));
  }
  Points points(expected);
  for (std::size_t i = 0; i < expected; ++i) {
    points[i] = Vec3(array.data.values[3 * i], array.data.values[3 * i + 1], array.data.values[3 * i + 2]);
    if (!points[i].allFinite()) {
      throw DataError(path_, fmt::format("vertex {}", i),
                      fmt::format("({}, {}, {})", points[i].x(), points[i].y(), points[i].z()), "finite coordinates");
    }
  }
  if (is_ras_) turn_over(points);
  return points;
}

std::vector<double> VtkXmlFile::array(const char* section, const char* name) const {
  const pugi::xml_node node = piece_.child(section).find_child_by_attribute("DataArray", "Name", name);
  if (!node) throw DataError(path_, fmt::format("<{}>", section), fmt::format("no array '{}'", name), "that array");
  return decode(node).data.values;
}

VtkArrays VtkXmlFile::arrays(const char* section, std::size_t items) const {
  VtkArrays result;
  for (const pugi::xml_node& node : piece_.child(section).children("DataArray")) {
    const std::string name = node.attribute("Name").as_string();
    VtkArray array = decode(node);
    if (array.data.values.size() != items * static_cast<std::size_t>(array.data.components)) {
      fail(node, fmt::format("{} numbers", array.data.values.size()),
           fmt::format("{} for each of {} items", array.data.components, items));
    }
    const auto bad =
        std::find_if(array.data.values.begin(), array.data.values.end(), [](double v) { return !std::isfinite(v); });
    if (bad != array.data.values.end()) {
      fail(node, fmt::format("{} as value {}", *bad, bad - array.data.values.begin()), "finite numbers");
    }
    result[name] = std::move(array);
  }
  if (is_ras_) turn_over(result);
  return result;
}

}  // namespace incise::io_detail
