#include "imaging/picture_file.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace incise::imaging_detail {
namespace {

constexpr const char* kWhole = "a complete picture";
constexpr const char* kCutShort = "Was the file cut short when it was copied?";

/// The checksum of PNG's blocks (ISO 3309), bit by bit from a table of bytes.
std::uint32_t crc32_of(std::string_view bytes) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> result{};
    for (std::uint32_t i = 0; i < result.size(); ++i) {
      std::uint32_t value = i;
      for (int bit = 0; bit < 8; ++bit) value = (value & 1U) != 0 ? 0xEDB88320U ^ (value >> 1U) : value >> 1U;
      result[i] = value;
    }
    return result;
  }();
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char c : bytes) crc = table[(crc ^ static_cast<std::uint8_t>(c)) & 0xFFU] ^ (crc >> 8U);
  return ~crc;
}

/// Numbers of a file, with the end of the file watched.
class Bytes {
 public:
  Bytes(std::string_view bytes, const std::filesystem::path& name) : bytes_(bytes), name_(name) {}

  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] std::uint32_t at(std::size_t place, int count, bool big_endian) const {
    if (place > bytes_.size() || bytes_.size() - place < static_cast<std::size_t>(count)) end_at(bytes_.size());
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i) {
      const auto byte =
          static_cast<std::uint8_t>(bytes_[place + static_cast<std::size_t>(big_endian ? i : count - 1 - i)]);
      value = value << 8 | byte;
    }
    return value;
  }
  [[noreturn]] void end_at(std::size_t place) const {
    throw DataError(name_, fmt::format("byte {}", place), "the end of the file", kWhole, kCutShort);
  }
  void require_checksum(std::size_t place, std::size_t length, std::uint32_t expected) const {
    if (crc32_of(bytes_.substr(place, length)) == expected) return;
    throw DataError(name_, fmt::format("byte {}", place), "a block whose checksum does not match", "a sound PNG file",
                    "Was the file damaged when it was copied?");
  }
  /// @param most_pixels_per_byte  that the format's compression can reach: a file that claims more would fill the memory
  ///                              with nothing.
  void require_size(double width, double height, double most_pixels_per_byte) const {
    const std::string found = fmt::format("{:.0f} x {:.0f} pixels", width, height);
    if (!(width > 0.0 && height > 0.0)) throw DataError(name_, "", found, "a picture with pixels");
    if (width * height > kMostPixels) throw DataError(name_, "", found, "at most 200 million pixels");
    if (width * height > most_pixels_per_byte * static_cast<double>(size())) {
      throw DataError(name_, "", fmt::format("{} in {} bytes", found, size()),
                      fmt::format("at most {:.0f} pixels for a byte, as its format has them", most_pixels_per_byte),
                      "Is it damaged?");
    }
  }
  /// Measures are taken along rows and columns alike. @param x, y  pixels in one length, as the file states them, or 0.
  void require_square_pixels(double x, double y) const {
    constexpr double kSquare = 0.01;
    if (!(x > 0.0 && y > 0.0) || std::abs(x / y - 1.0) <= kSquare) return;
    throw DataError(name_, "", fmt::format("pixels that are not square ({:g} in a width, {:g} in a height)", x, y),
                    "square pixels", "Scale the picture so that its pixels are square, or take the entry out.");
  }
  [[noreturn]] void refuse_header(const char* found) const {
    throw DataError(name_, "", found, kWhole, "Is it damaged?");
  }
  [[noreturn]] void cmyk() const {
    throw DataError(name_, "", "a CMYK picture (made for printing)", "an RGB picture",
                    "Save it again as RGB; the colours of the lines must be those that the camera saw.");
  }

 private:
  std::string_view bytes_;
  const std::filesystem::path& name_;
};

// What compression can reach: DEFLATE 1032 bytes for one, of pixels of one bit at least; LZW 4096 symbols in codes of 12 bits;
// JPEG one bit for each block of 8 x 8 pixels.
constexpr double kPngPixelsPerByte = 8.0 * 1032.0;
constexpr double kTiffPixelsPerByte = 8.0 * 2800.0;
constexpr double kJpegPixelsPerByte = 8.0 * 64.0;

void check_png(const Bytes& file) {
  constexpr std::uint32_t kHeader = 0x49484452;  // "IHDR"
  constexpr std::uint32_t kEnd = 0x49454E44;     // "IEND"
  constexpr std::uint32_t kResolution = 0x70485973;  // "pHYs"
  constexpr std::uint32_t kHeaderLength = 13;
  std::size_t place = 8;
  while (true) {
    const std::uint32_t length = file.at(place, 4, true);
    const std::uint32_t kind = file.at(place + 4, 4, true);
    if (file.size() - place < 12 + static_cast<std::size_t>(length)) file.end_at(file.size());
    file.require_checksum(place + 4, 4 + static_cast<std::size_t>(length), file.at(place + 8 + length, 4, true));
    if (place == 8) {
      if (kind != kHeader || length != kHeaderLength) file.refuse_header("no PNG header (IHDR) at its start");
      file.require_size(file.at(16, 4, true), file.at(20, 4, true), kPngPixelsPerByte);
    }
    if (kind == kResolution && length == 9)
      file.require_square_pixels(file.at(place + 8, 4, true), file.at(place + 12, 4, true));
    if (kind == kEnd) return;
    place += 12 + static_cast<std::size_t>(length);
  }
}

/// Walks the segments to the frame header, which tells the number of channels, and asks for the end marker.
void check_jpeg(const Bytes& file) {
  constexpr std::uint32_t kJfif = 0x4A464946;  // "JFIF"
  std::size_t place = 2;
  bool has_frame = false;
  while (true) {
    while (file.at(place, 1, true) == 0xFF && file.at(place + 1, 1, true) == 0xFF) ++place;
    const std::uint32_t marker = file.at(place, 2, true);
    const std::size_t length = file.at(place + 2, 2, true);
    const bool is_frame =
        marker >= 0xFFC0 && marker <= 0xFFCF && marker != 0xFFC4 && marker != 0xFFC8 && marker != 0xFFCC;
    if (is_frame && file.at(place + 9, 1, true) == 4) file.cmyk();
    if (is_frame) {
      file.require_size(file.at(place + 7, 2, true), file.at(place + 5, 2, true), kJpegPixelsPerByte);
      has_frame = true;
    }
    const bool is_jfif = marker == 0xFFE0 && length >= 14 && file.at(place + 4, 4, true) == kJfif;
    if (is_jfif) file.require_square_pixels(file.at(place + 12, 2, true), file.at(place + 14, 2, true));
    if (marker == 0xFFDA || marker >> 8 != 0xFF) break;
    place += 2 + length;
  }
  if (!has_frame) file.refuse_header("no frame header before its picture");
  // Cameras append previews and padding after the end marker.
  for (std::size_t i = file.size() - 1; i > place; --i) {
    if (file.at(i - 1, 2, true) == 0xFFD9) return;
  }
  file.end_at(file.size());
}

/// The first directory: photometric interpretation 5 is CMYK; strips (or tiles) must end within the file.
void check_tiff(const Bytes& file) {
  const bool big = file.at(0, 1, true) == 'M';
  const std::size_t directory = file.at(4, 4, big);
  const std::uint32_t entries = file.at(directory, 2, big);
  struct Numbers {
    std::size_t place = 0;
    std::uint32_t count = 0;
    int size = 0;
  } offsets, counts;
  double width = 0.0, height = 0.0, x_resolution = 0.0, y_resolution = 0.0;
  const auto ratio_at = [&](std::size_t entry) {
    const std::size_t place = file.at(entry + 8, 4, big);
    const double denominator = file.at(place + 4, 4, big);
    return denominator > 0.0 ? file.at(place, 4, big) / denominator : 0.0;  // 0: not stated
  };
  for (std::uint32_t i = 0; i < entries; ++i) {
    const std::size_t entry = directory + 2 + 12 * static_cast<std::size_t>(i);
    const std::uint32_t tag = file.at(entry, 2, big);
    const int size = file.at(entry + 2, 2, big) == 3 ? 2 : 4;  // SHORT or LONG
    const std::uint32_t count = file.at(entry + 4, 4, big);
    const bool is_inline = static_cast<std::size_t>(size) * count <= 4;
    const Numbers numbers{is_inline ? entry + 8 : file.at(entry + 8, 4, big), count, size};
    if (tag == 262 && file.at(entry + 8, 2, big) == 5) file.cmyk();
    if (tag == 256 && count == 1) width = file.at(entry + 8, size, big);
    if (tag == 257 && count == 1) height = file.at(entry + 8, size, big);
    if (tag == 282) x_resolution = ratio_at(entry);
    if (tag == 283) y_resolution = ratio_at(entry);
    if (tag == 273 || tag == 324) offsets = numbers;
    if (tag == 279 || tag == 325) counts = numbers;
  }
  file.require_size(width, height, kTiffPixelsPerByte);
  file.require_square_pixels(x_resolution, y_resolution);
  for (std::uint32_t i = 0; i < std::min(offsets.count, counts.count); ++i) {
    const auto number = [&](const Numbers& list) {
      return file.at(list.place + static_cast<std::size_t>(list.size) * i, list.size, big);
    };
    if (static_cast<std::size_t>(number(offsets)) + number(counts) > file.size()) file.end_at(file.size());
  }
}

}  // namespace

void require_whole_picture(std::string_view bytes, const std::filesystem::path& name) {
  const Bytes file(bytes, name);
  if (bytes.size() > kMostBytes) {
    throw DataError(name, "", fmt::format("{} bytes", bytes.size()), fmt::format("at most {} bytes", kMostBytes));
  }
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return check_png(file);
  if (bytes.starts_with("\xFF\xD8\xFF")) {
    check_jpeg(file);
    return require_sound_jpeg(bytes, name);
  }
  if (bytes.starts_with(std::string_view("II*\0", 4)) || bytes.starts_with(std::string_view("MM\0*", 4)))
    return check_tiff(file);
  throw DataError(name, "", bytes.empty() ? "an empty file" : "another kind of file", "a picture: PNG, JPEG or TIFF");
}

}  // namespace incise::imaging_detail
