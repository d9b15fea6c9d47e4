#include "io/picture_file.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace incise {
namespace {

namespace fs = std::filesystem;

constexpr double kMostTiffBits = 8.0 * 2800.0;  // per byte of the file: LZW has 4096 symbols in codes of 12 bits
constexpr tmsize_t kMostTiffAtOnce = tmsize_t{1} << 30;

/// Source of libtiff's reading, and its first error message.
struct TiffSource {
  std::string_view bytes;
  std::uint64_t at = 0;
  bool reads_pixels = false;
  char words[256] = {};
};

TiffSource& tiff_source_of(thandle_t handle) {
  return *static_cast<TiffSource*>(handle);
}

tmsize_t read_tiff_bytes(thandle_t handle, void* to, tmsize_t count) {
  TiffSource& source = tiff_source_of(handle);
  if (source.at >= source.bytes.size()) return 0;
  const std::size_t taken = source.bytes.copy(static_cast<char*>(to), static_cast<std::size_t>(count), source.at);
  source.at += taken;
  return static_cast<tmsize_t>(taken);
}

tmsize_t write_tiff_bytes(thandle_t /*handle*/, void* /*from*/, tmsize_t /*count*/) {
  return 0;
}

toff_t seek_tiff(thandle_t handle, toff_t offset, int whence) {
  TiffSource& source = tiff_source_of(handle);
  const std::uint64_t from = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? source.at : source.bytes.size();
  return source.at = from + offset;
}

int close_tiff(thandle_t /*handle*/) {
  return 0;
}

toff_t size_of_tiff(thandle_t handle) {
  return tiff_source_of(handle).bytes.size();
}

int map_tiff(thandle_t handle, void** bytes, toff_t* size) {
  const std::string_view all = tiff_source_of(handle).bytes;
  *bytes = const_cast<char*>(all.data());  // libtiff's type is not const; opened for reading, it writes nothing
  *size = all.size();
  return 1;
}

void unmap_tiff(thandle_t /*handle*/, void* /*bytes*/, toff_t /*size*/) {}

int keep_tiff_words(TIFF* /*tiff*/, void* source, const char* /*module*/, const char* format, va_list values) {
  auto& words = static_cast<TiffSource*>(source)->words;
  if (words[0] == '\0') std::vsnprintf(words, sizeof words, format, values);
  return 1;
}

/// Keeps a warning as an error if it is about embedded JPEG pixels, whose damage libtiff would hide; other warnings are
/// about odd entries.
int warn_tiff(TIFF* tiff, void* source, const char* module, const char* format, va_list values) {
  const bool is_damage =
      static_cast<TiffSource*>(source)->reads_pixels && module != nullptr && std::string_view(module) == "JPEGLib";
  return is_damage ? keep_tiff_words(tiff, source, module, format, values) : 1;
}

using TiffFile = std::unique_ptr<TIFF, decltype(&TIFFClose)>;

TiffFile opened_tiff(TiffSource& source) {
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                                 &TIFFOpenOptionsFree);
  if (options == nullptr) throw std::bad_alloc();
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), kMostTiffAtOnce);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_tiff_words, &source);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), warn_tiff, &source);
  return {TIFFClientOpenExt("picture", "r", &source, read_tiff_bytes, write_tiff_bytes, seek_tiff, close_tiff,
                            size_of_tiff, map_tiff, unmap_tiff, options.get()),
          &TIFFClose};
}

template <class Value>
Value tiff_field(TIFF* tiff, ttag_t tag) {
  Value value{};
  TIFFGetFieldDefaulted(tiff, tag, &value);
  return value;
}

/// Reads the pixels of a picture with one channel of 16 bits. @returns whether that succeeded.
bool reads_tiff_counts(TIFF* tiff, StoredPixels& pixels) {
  const auto width = static_cast<std::size_t>(pixels.width), height = static_cast<std::size_t>(pixels.height);
  pixels.bytes.resize(2 * width * height);
  if (TIFFIsTiled(tiff) == 0) {
    for (std::size_t row = 0; row < height; ++row) {
      if (TIFFReadScanline(tiff, pixels.bytes.data() + 2 * width * row, static_cast<std::uint32_t>(row)) != 1)
        return false;
    }
    return true;
  }
  const std::size_t tile_width = tiff_field<std::uint32_t>(tiff, TIFFTAG_TILEWIDTH);
  const std::size_t tile_height = tiff_field<std::uint32_t>(tiff, TIFFTAG_TILELENGTH);
  std::string tile(static_cast<std::size_t>(TIFFTileSize(tiff)), '\0');
  if (tile_width == 0 || tile_height == 0 || tile.size() < 2 * tile_width * tile_height) return false;
  for (std::size_t y = 0; y < height; y += tile_height) {
    for (std::size_t x = 0; x < width; x += tile_width) {
      if (TIFFReadTile(tiff, tile.data(), static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0, 0) < 0)
        return false;
      for (std::size_t row = 0; row < std::min(tile_height, height - y); ++row)
        tile.copy(pixels.bytes.data() + 2 * (width * (y + row) + x), 2 * std::min(tile_width, width - x),
                  2 * tile_width * row);
    }
  }
  return true;
}

/// Reads pixels of any colour type as RGB through libtiff's conversion, whose colours are already multiplied by alpha.
/// Does not turn the picture: it requests the orientation of the file. @returns whether that succeeded.
bool reads_tiff_colors(TIFF* tiff, StoredPixels& pixels, int orientation) {
  const std::size_t count = static_cast<std::size_t>(pixels.width) * static_cast<std::size_t>(pixels.height);
  std::vector<std::uint32_t> abgr(count);
  const int is_read = TIFFReadRGBAImageOriented(tiff, static_cast<std::uint32_t>(pixels.width),
                                                static_cast<std::uint32_t>(pixels.height), abgr.data(), orientation, 1);
  if (is_read != 1) return false;
  pixels.channels = 3;
  pixels.bits = 8;
  pixels.bytes.resize(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t white = 255 - TIFFGetA(abgr[i]);
    const std::uint32_t rgb[] = {TIFFGetR(abgr[i]), TIFFGetG(abgr[i]), TIFFGetB(abgr[i])};
    for (std::size_t c = 0; c < 3; ++c) pixels.bytes[3 * i + c] = static_cast<char>(std::min(255U, rgb[c] + white));
  }
  return true;
}

/// Refuses tiles that the file cannot hold: tiles may be larger than their picture, and may share bytes.
void require_possible_tiles(TIFF* tiff, const fs::path& name, std::size_t bytes) {
  if (TIFFIsTiled(tiff) == 0) return;
  const double tiles = TIFFNumberOfTiles(tiff), size = static_cast<double>(TIFFTileSize(tiff));
  if (tiles * size <= kMostTiffBits / 8.0 * static_cast<double>(bytes)) return;
  throw DataError(name, "", fmt::format("{:.0f} tiles of {:.0f} bytes in {} bytes", tiles, size, bytes),
                  "tiles that its file can hold", "Is it damaged?");
}

}  // namespace

StoredPixels read_tiff(std::string_view bytes, const fs::path& name) {
  TiffSource source{bytes};
  const TiffFile file = opened_tiff(source);
  if (file == nullptr) refuse_picture(name, "", source.words, "TIFF");
  TIFF* tiff = file.get();
  const auto width = tiff_field<std::uint32_t>(tiff, TIFFTAG_IMAGEWIDTH),
             height = tiff_field<std::uint32_t>(tiff, TIFFTAG_IMAGELENGTH);
  const auto channels = tiff_field<std::uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL);
  const auto colours = tiff_field<std::uint16_t>(tiff, TIFFTAG_PHOTOMETRIC);
  if (colours == PHOTOMETRIC_SEPARATED) refuse_cmyk(name);
  const auto bits = tiff_field<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE);
  if (tiff_field<std::uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT) != SAMPLEFORMAT_UINT || bits > 16) {
    throw DataError(name, "", "channels of another type", "whole numbers of 8 or 16 bits per channel");
  }
  require_possible_size(name, width, height, kMostPhotoPixels,
                        kMostTiffBits / std::max(1.0, static_cast<double>(bits) * channels), bytes.size());
  require_possible_tiles(tiff, name, bytes.size());
  StoredPixels pixels{static_cast<int>(width), static_cast<int>(height), channels, bits, {}};
  pixels.per_width = static_cast<double>(tiff_field<float>(tiff, TIFFTAG_XRESOLUTION));
  pixels.per_height = static_cast<double>(tiff_field<float>(tiff, TIFFTAG_YRESOLUTION));
  const auto orientation = tiff_field<std::uint16_t>(tiff, TIFFTAG_ORIENTATION);
  const bool is_grey = colours == PHOTOMETRIC_MINISBLACK || colours == PHOTOMETRIC_MINISWHITE;
  if (is_grey && (channels > 1 || bits != 16)) {  // neither caller accepts these
    pixels.channels = std::min(2, pixels.channels);
    return pixels;
  }
  source.reads_pixels = true;
  source.words[0] = '\0';
  const bool is_read = is_grey ? reads_tiff_counts(tiff, pixels) : reads_tiff_colors(tiff, pixels, orientation);
  if (!is_read || source.words[0] != '\0') refuse_picture(name, "", source.words, "TIFF");
  return upright(std::move(pixels), orientation);
}

}  // namespace incise
