#pragma once

#include <incise/core/error.hpp>
#include <incise/geometry/volume.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <vector>

// Image files put together byte by byte from the formats' descriptions, so that the readers are not tested with their
// own writers.
namespace incise::testing {

inline void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

inline std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return bytes.str();
}

inline std::string little_endian(std::uint64_t value, int size) {
  std::string bytes;
  for (int b = 0; b < size; ++b) bytes += static_cast<char>((value >> (8 * b)) & 0xff);
  return bytes;
}

inline std::string big_endian(std::uint64_t value, int size) {
  const std::string reversed = little_endian(value, size);
  return std::string(reversed.rbegin(), reversed.rend());
}

/// Values as their bytes in memory.
template <class T>
std::string raw_bytes(const std::vector<T>& values) {
  return std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

/// One CT slice as an explicit little-endian DICOM file; every field can be changed or erased before `bytes()`.
class HandmadeSlice {
 public:
  using Tag = std::uint32_t;

  HandmadeSlice(int columns, int rows, const Vec3& position_mm, const std::vector<std::uint16_t>& stored) {
    text(0x00080060, "CS", "CT");
    text(0x00180050, "DS", "9");  // a thickness that is never the spacing
    text(0x0020000e, "UI", "1.2.3");
    text(0x00200032, "DS", fmt::format("{:.10g}\\{:.10g}\\{:.10g}", position_mm[0], position_mm[1], position_mm[2]));
    text(0x00200037, "DS", "1\\0\\0\\0\\1\\0");
    word(0x00280002, 1);
    text(0x00280004, "CS", "MONOCHROME2");
    word(0x00280010, rows);
    word(0x00280011, columns);
    text(0x00280030, "DS", "1\\1");
    word(0x00280100, 16);
    word(0x00280101, 16);
    word(0x00280102, 15);
    word(0x00280103, 0);
    text(0x00281052, "DS", "-1024");
    text(0x00281053, "DS", "1");
    elements_[0x7fe00010] = {"OW", raw_bytes(stored)};
  }
  HandmadeSlice& text(Tag tag, const std::string& vr, std::string value) {
    if (value.size() % 2 != 0) value += vr == "UI" ? '\0' : ' ';
    elements_[tag] = {vr, value};
    return *this;
  }
  HandmadeSlice& word(Tag tag, int value, const std::string& vr = "US") {
    elements_[tag] = {vr, little_endian(static_cast<std::uint16_t>(value), 2)};
    return *this;
  }
  HandmadeSlice& erase(Tag tag) {
    elements_.erase(tag);
    return *this;
  }
  HandmadeSlice& axes(const Vec3& row, const Vec3& column) {
    return text(0x00200037, "DS",
                fmt::format("{:.10g}\\{:.10g}\\{:.10g}\\{:.10g}\\{:.10g}\\{:.10g}", row[0], row[1], row[2], column[0],
                            column[1], column[2]));
  }
  HandmadeSlice& transfer_syntax(const std::string& uid) {
    transfer_syntax_ = uid;
    return *this;
  }
  /// Pixels as one fragment of a compressed stream.
  HandmadeSlice& encapsulate(std::string fragment) {
    if (fragment.size() % 2 != 0) fragment += '\0';
    const auto item = [](std::uint32_t tag, std::size_t length) {
      return little_endian(tag >> 16, 2) + little_endian(tag & 0xffff, 2) + little_endian(length, 4);
    };
    elements_.erase(0x7fe00010);
    encapsulated_ = little_endian(0x7fe0, 2) + little_endian(0x0010, 2) + "OB" + std::string(2, '\0') +
                    "\xff\xff\xff\xff" + item(0xfffee000, 0) + item(0xfffee000, fragment.size()) + fragment +
                    item(0xfffee0dd, 0);
    return *this;
  }
  [[nodiscard]] std::string bytes() const {
    std::string syntax = transfer_syntax_;
    if (syntax.size() % 2 != 0) syntax += '\0';
    std::string meta = element(0x00020001, "OB", std::string("\0\1", 2)) +
                       element(0x00020002, "UI", std::string("1.2.840.10008.5.1.4.1.1.2\0", 26)) +
                       element(0x00020003, "UI", std::string("1.2.3.4\0", 8)) + element(0x00020010, "UI", syntax);
    std::string all(128, '\0');
    all += "DICM" + element(0x00020000, "UL", little_endian(meta.size(), 4)) + meta;
    for (const auto& [tag, content] : elements_) all += element(tag, content.first, content.second);
    return all + encapsulated_;
  }

 private:
  static std::string element(Tag tag, const std::string& vr, const std::string& value) {
    std::string all = little_endian(tag >> 16, 2) + little_endian(tag & 0xffff, 2) + vr;
    const bool is_long = vr == "OB" || vr == "OW" || vr == "SQ" || vr == "UN";
    all += is_long ? std::string(2, '\0') + little_endian(value.size(), 4) : little_endian(value.size(), 2);
    return all + value;
  }
  std::map<Tag, std::pair<std::string, std::string>> elements_;
  std::string encapsulated_;
  std::string transfer_syntax_ = "1.2.840.10008.1.2.1";
};

/// Fields of an explicit little-endian DICOM file, found by walking its elements; files without sequences only.
inline std::map<std::uint32_t, std::string> dicom_fields(const std::filesystem::path& path) {
  const std::string bytes = read_bytes(path);
  const auto number = [&bytes](std::size_t at, int size) {
    std::uint64_t value = 0;
    for (int b = size - 1; b >= 0; --b) value = value << 8 | static_cast<unsigned char>(bytes.at(at + b));
    return static_cast<std::size_t>(value);
  };
  std::map<std::uint32_t, std::string> fields;
  for (std::size_t at = 132; at < bytes.size();) {
    const auto tag = static_cast<std::uint32_t>(number(at, 2) << 16 | number(at + 2, 2));
    const std::string vr = bytes.substr(at + 4, 2);
    const bool is_long = vr == "OB" || vr == "OW" || vr == "SQ" || vr == "UN";
    const std::size_t length = is_long ? number(at + 8, 4) : number(at + 6, 2);
    at += is_long ? 12 : 8;
    fields[tag] = bytes.substr(at, length);
    at += length;
  }
  return fields;
}

/// A PNG picture with uncompressed (stored) blocks. @param samples  bytes of the rows, 16-bit values big endian
inline std::string png_bytes(int width, int height, int depth, int colour_type, const std::string& samples) {
  const auto crc = [](const std::string& text) {
    std::uint32_t value = 0xffffffff;
    for (const char c : text) {
      value ^= static_cast<unsigned char>(c);
      for (int bit = 0; bit < 8; ++bit) value = value >> 1 ^ ((value & 1) != 0 ? 0xedb88320U : 0U);
    }
    return ~value;
  };
  const auto chunk = [&crc](const std::string& type, const std::string& data) {
    return big_endian(data.size(), 4) + type + data + big_endian(crc(type + data), 4);
  };
  std::string rows;
  const std::size_t row_size = samples.size() / static_cast<std::size_t>(height);
  for (int row = 0; row < height; ++row) rows += '\0' + samples.substr(row * row_size, row_size);
  std::uint32_t a = 1;
  std::uint32_t b = 0;
  for (const char c : rows) {
    a = (a + static_cast<unsigned char>(c)) % 65521;
    b = (b + a) % 65521;
  }
  const std::string stored = std::string("\x78\x01\x01", 3) + little_endian(rows.size(), 2) +
                             little_endian(~rows.size() & 0xffff, 2) + rows + big_endian(b << 16 | a, 4);
  return std::string("\x89PNG\r\n\x1a\n") +
         chunk("IHDR", big_endian(width, 4) + big_endian(height, 4) + static_cast<char>(depth) +
                           static_cast<char>(colour_type) + std::string(3, '\0')) +
         chunk("IDAT", stored) + chunk("IEND", "");
}

/// An NRRD with raw little-endian voxels and the given extra header lines.
inline std::string nrrd_bytes(const std::string& type, const std::array<int, 3>& size, const std::string& header_lines,
                              const std::string& voxels) {
  return fmt::format("NRRD0004\ntype: {}\ndimension: 3\nsizes: {} {} {}\nencoding: raw\nendian: little\n{}\n", type,
                     size[0], size[1], size[2], header_lines) +
         voxels;
}

/// What an expected failure says; the test fails if it says nothing, more than a line, or prints to stderr.
template <class Failure>
std::string message_of(const std::function<void()>& action) {
  std::string message;
  ::testing::internal::CaptureStderr();
  try {
    action();
    ADD_FAILURE() << "expected an exception, found none";
  } catch (const Failure& failure) {
    message = failure.what();
  } catch (const std::exception& other) {
    ADD_FAILURE() << "expected another type of exception, found: " << other.what();
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_LT(message.size(), 600U) << message;
  return message;
}

/// Small, with no symmetry to hide a swapped axis: 7 x 5 x 4 voxels, different spacings, oblique axes, values that are
/// all different.
inline CtVolume oblique_ct() {
  CtVolume volume;
  volume.grid.size = {7, 5, 4};
  volume.grid.spacing_mm = Vec3(0.48828125, 0.7, 2.0 / 3.0);
  volume.grid.origin_mm = Vec3(-117.25, 31.4159265358979, 801.0625);
  volume.grid.direction = (Eigen::AngleAxisd(0.3, Vec3::UnitX()) * Eigen::AngleAxisd(-0.2, Vec3::UnitY()) *
                           Eigen::AngleAxisd(0.1, Vec3::UnitZ()))
                              .toRotationMatrix();
  for (std::size_t v = 0; v < volume.grid.voxel_count(); ++v)
    volume.voxels.push_back(static_cast<std::int16_t>(-1024 + 29 * static_cast<int>(v)));
  return volume;
}

/// Where the farthest corner voxel of two grids differs, mm: spacing, origin and axes in one number.
inline double grid_distance_mm(const VolumeGrid& a, const VolumeGrid& b) {
  double farthest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 index((corner & 1) * (a.size[0] - 1), (corner >> 1 & 1) * (a.size[1] - 1),
                     (corner >> 2 & 1) * (a.size[2] - 1));
    farthest = std::max(farthest, (a.world_from_index(index) - b.world_from_index(index)).norm());
  }
  return farthest;
}

}  // namespace incise::testing
