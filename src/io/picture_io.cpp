#include "io/picture_file.hpp"

#include <incise/core/error.hpp>
#include <incise/io/picture_io.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace incise {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = std::size_t{1} << 30;  // decoders count bytes in 31 bits
constexpr int kGreyTolerance = 8;                         // most by which the channels of grey differ

StoredPixels stored(std::string_view bytes, const fs::path& name) {
  if (bytes.size() > kMostBytes) {
    throw DataError(name, "", fmt::format("{} bytes", bytes.size()), fmt::format("at most {} bytes", kMostBytes));
  }
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return read_png(bytes, name, kMostPhotoPixels);
  if (bytes.starts_with("\xFF\xD8\xFF")) return read_jpeg(bytes, name);
  if (bytes.starts_with(std::string_view("II*\0", 4)) || bytes.starts_with(std::string_view("MM\0*", 4)))
    return read_tiff(bytes, name);
  throw DataError(name, "", bytes.empty() ? "an empty file" : "another kind of file", "a picture: PNG, JPEG or TIFF");
}

/// Decodes a file and refuses pixels that are not square, because lengths are measured along rows and columns alike.
StoredPixels decoded(std::string_view bytes, const fs::path& name) {
  constexpr double kSquare = 0.01;
  StoredPixels pixels = stored(bytes, name);
  const double x = pixels.per_width, y = pixels.per_height;
  if (x > 0.0 && y > 0.0 && std::abs(x / y - 1.0) > kSquare) {
    throw DataError(name, "", fmt::format("pixels that are not square ({:g} in a width, {:g} in a height)", x, y),
                    "square pixels",
                    "Scale the picture so that its pixels are square, or remove its pixel-density entry.");
  }
  return pixels;
}

std::uint16_t sixteen_bits(const StoredPixels& from, std::size_t i) {
  std::uint16_t value = 0;
  std::memcpy(&value, from.bytes.data() + 2 * i, 2);
  return value;
}

/// @pre 3 or 4 channels.
std::vector<std::uint8_t> rgb_on_white(const StoredPixels& from) {
  const std::size_t count = static_cast<std::size_t>(from.width) * static_cast<std::size_t>(from.height);
  const auto channels = static_cast<std::size_t>(from.channels);
  const auto value = [&from](std::size_t i) -> int {
    return from.bits == 16 ? (sixteen_bits(from, i) + 128) / 257 : static_cast<std::uint8_t>(from.bytes[i]);
  };
  std::vector<std::uint8_t> rgb(3 * count);
  for (std::size_t pixel = 0; pixel < count; ++pixel) {
    const int alpha = channels == 4 ? value(4 * pixel + 3) : 255;
    for (std::size_t c = 0; c < 3; ++c)
      rgb[3 * pixel + c] =
          static_cast<std::uint8_t>((value(channels * pixel + c) * alpha + 255 * (255 - alpha) + 127) / 255);
  }
  return rgb;
}

/// Whether some pixel differs from grey by more than noise.
bool has_color(const std::vector<std::uint8_t>& rgb) {
  for (std::size_t i = 0; i < rgb.size(); i += 3) {
    const auto [low, high] = std::minmax({rgb[i], rgb[i + 1], rgb[i + 2]});
    if (high - low > kGreyTolerance) return true;
  }
  return false;
}

void require_filled(int width, int height, std::size_t found, std::size_t channels) {
  INCISE_REQUIRE(width > 0 && height > 0, fmt::format("expected a picture with pixels, found {} x {}", width, height));
  const std::size_t expected = channels * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  INCISE_REQUIRE(found == expected, fmt::format("expected {} numbers, found {}", expected, found));
}

}  // namespace

void require_possible_size(const fs::path& name, double width, double height, double most_pixels,
                           double most_pixels_per_byte, std::size_t bytes) {
  const std::string found = fmt::format("{:.0f} x {:.0f} pixels", width, height);
  if (!(width > 0.0 && height > 0.0)) throw DataError(name, "", found, "a picture with pixels");
  if (width * height > most_pixels) {
    throw DataError(name, "", found, fmt::format("at most {:.0f} million pixels", most_pixels / 1e6));
  }
  if (width * height > most_pixels_per_byte * static_cast<double>(bytes)) {
    throw DataError(name, "", fmt::format("{} in {} bytes", found, bytes),
                    fmt::format("at most {:.0f} pixels per byte, the limit of its format", most_pixels_per_byte),
                    "Is it damaged?");
  }
}

void refuse_cmyk(const fs::path& name) {
  throw DataError(name, "", "a CMYK picture (made for printing)", "an RGB picture",
                  "Save it again as RGB; the colours of the lines must be those that the camera saw.");
}

void refuse_picture(const fs::path& name, const std::string& place, const char* words, const char* format) {
  throw DataError(name, place, fmt::format("a picture that cannot be read ({})", words),
                  fmt::format("an undamaged {} file", format), "Was it cut short or changed when it was copied?");
}

StoredPixels upright(StoredPixels from, int orientation) {
  if (orientation <= 1 || orientation > 8) return from;
  const bool flips_x = orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
  const bool flips_y = orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
  const bool is_on_its_side = orientation >= 5;
  StoredPixels to = from;
  if (is_on_its_side) {
    std::swap(to.width, to.height);
    std::swap(to.per_width, to.per_height);
  }
  const auto size = static_cast<std::size_t>(from.channels * from.bits / 8);
  const auto place = [size](int column, int row, int width) {
    return size * (static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column));
  };
  for (int v = 0; v < to.height; ++v) {
    for (int u = 0; u < to.width; ++u) {
      int x = is_on_its_side ? v : u, y = is_on_its_side ? u : v;
      if (flips_x) x = from.width - 1 - x;
      if (flips_y) y = from.height - 1 - y;
      from.bytes.copy(to.bytes.data() + place(u, v, to.width), size, place(x, y, from.width));
    }
  }
  return to;
}

ColorPicture decode_picture(std::string_view bytes, const fs::path& name) {
  const StoredPixels pixels = decoded(bytes, name);
  if (pixels.channels < 3) {
    throw DataError(name, "", "a greyscale picture", "a colour picture",
                    "Red and green lines cannot be distinguished in grey.");
  }
  ColorPicture picture{pixels.width, pixels.height, rgb_on_white(pixels)};
  if (!has_color(picture.rgb)) {
    throw DataError(name, "",
                    fmt::format("a picture without colour (red, green and blue differ by at most {} at every pixel)",
                                kGreyTolerance),
                    "a colour picture");
  }
  return picture;
}

DepthPicture decode_depth(std::string_view bytes, const fs::path& name) {
  const StoredPixels pixels = decoded(bytes, name);
  if (pixels.channels != 1 || pixels.bits != 16) {
    throw DataError(name, "", fmt::format("{} channel(s) of {} bits", pixels.channels, pixels.bits),
                    "a depth picture: one channel of 16 bits");
  }
  DepthPicture picture{pixels.width, pixels.height, std::vector<std::uint16_t>(pixels.bytes.size() / 2)};
  std::memcpy(picture.counts.data(), pixels.bytes.data(), pixels.bytes.size());
  if (std::all_of(picture.counts.begin(), picture.counts.end(), [](std::uint16_t count) { return count == 0; })) {
    throw DataError(name, "", "no depth at any pixel", "a depth picture");
  }
  return picture;
}

std::string encode_png(std::span<const std::uint8_t> pixels, int width, int height, int channels) {
  INCISE_REQUIRE(channels == 1 || channels == 3, fmt::format("expected 1 or 3 channels, found {}", channels));
  require_filled(width, height, pixels.size(), static_cast<std::size_t>(channels));
  return write_png({width, height, channels, 8, {pixels.begin(), pixels.end()}}, PngPacking::Small);
}

std::string encode_png(const ColorPicture& picture) {
  require_filled(picture.width, picture.height, picture.rgb.size(), 3);
  return write_png({picture.width, picture.height, 3, 8, {picture.rgb.begin(), picture.rgb.end()}}, PngPacking::Fast);
}

std::string encode_png(const DepthPicture& picture) {
  require_filled(picture.width, picture.height, picture.counts.size(), 1);
  const std::string bytes(reinterpret_cast<const char*>(picture.counts.data()), 2 * picture.counts.size());
  return write_png({picture.width, picture.height, 1, 16, bytes}, PngPacking::Fast);
}

}  // namespace incise
