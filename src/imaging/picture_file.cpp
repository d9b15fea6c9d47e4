#include "imaging/picture_file.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <cstdint>

namespace incise::imaging_detail {
namespace {

constexpr const char* kWhole = "a complete picture";
constexpr const char* kCutShort = "Was the file cut short when it was copied?";

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
  [[noreturn]] void cmyk() const {
    throw DataError(name_, "", "a CMYK picture (made for printing)", "an RGB picture",
                    "Save it again as RGB; the colours of the lines must be those that the camera saw.");
  }

 private:
  std::string_view bytes_;
  const std::filesystem::path& name_;
};

void check_png(const Bytes& file) {
  constexpr std::uint32_t kEnd = 0x49454E44;  // "IEND"
  std::size_t place = 8;
  while (true) {
    const std::uint32_t length = file.at(place, 4, true);
    const std::uint32_t kind = file.at(place + 4, 4, true);
    if (file.size() - place < 12 + static_cast<std::size_t>(length)) file.end_at(file.size());
    if (kind == kEnd) return;
    place += 12 + static_cast<std::size_t>(length);
  }
}

/// Walks the segments to the frame header, which tells the number of channels, and asks for the end marker.
void check_jpeg(const Bytes& file) {
  std::size_t place = 2;
  while (true) {
    while (file.at(place, 1, true) == 0xFF && file.at(place + 1, 1, true) == 0xFF) ++place;
    const std::uint32_t marker = file.at(place, 2, true);
    const std::size_t length = file.at(place + 2, 2, true);
    const bool is_frame =
        marker >= 0xFFC0 && marker <= 0xFFCF && marker != 0xFFC4 && marker != 0xFFC8 && marker != 0xFFCC;
    if (is_frame && file.at(place + 9, 1, true) == 4) file.cmyk();
    if (marker == 0xFFDA || marker >> 8 != 0xFF) break;
    place += 2 + length;
  }
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
  for (std::uint32_t i = 0; i < entries; ++i) {
    const std::size_t entry = directory + 2 + 12 * static_cast<std::size_t>(i);
    const std::uint32_t tag = file.at(entry, 2, big);
    const int size = file.at(entry + 2, 2, big) == 3 ? 2 : 4;  // SHORT or LONG
    const std::uint32_t count = file.at(entry + 4, 4, big);
    const bool is_inline = static_cast<std::size_t>(size) * count <= 4;
    const Numbers numbers{is_inline ? entry + 8 : file.at(entry + 8, 4, big), count, size};
    if (tag == 262 && file.at(entry + 8, 2, big) == 5) file.cmyk();
    if (tag == 273 || tag == 324) offsets = numbers;
    if (tag == 279 || tag == 325) counts = numbers;
  }
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
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return check_png(file);
  if (bytes.starts_with("\xFF\xD8\xFF")) return check_jpeg(file);
  if (bytes.starts_with(std::string_view("II*\0", 4)) || bytes.starts_with(std::string_view("MM\0*", 4)))
    return check_tiff(file);
  throw DataError(name, "", bytes.empty() ? "an empty file" : "another kind of file", "a picture: PNG, JPEG or TIFF");
}

}  // namespace incise::imaging_detail
