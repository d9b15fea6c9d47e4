#include "io/picture_file.hpp"

#include <incise/core/error.hpp>

#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

namespace incise {
namespace {

namespace fs = std::filesystem;

constexpr double kMostTiffBits = 8.0 * 2800.0;  // for a byte of the file: LZW has 4096 symbols in codes of 12 bits
constexpr tmsize_t kMostTiffAtOnce = tmsize_t{1} << 30;

/// What libtiff reads from, and the first thing it complains of.
struct TiffSource {
  std::string_view bytes;
  std::uint64_t at = 0;
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

int keep_tiff_words(TIFF* /*tiff*/, void* source, const char* /*module*/, const char* format, va_list values) {
  auto& words = static_cast<TiffSource*>(source)->words;
  if (words[0] == '\0') std::vsnprintf(words, sizeof words, format, values);
  return 1;
}

int pass_over_tiff(TIFF* /*tiff*/, void* /*source*/, const char* /*module*/, const char* /*format*/,
                   va_list /*values*/) {
  return 1;
}

using TiffFile = std::unique_ptr<TIFF, decltype(&TIFFClose)>;

TiffFile opened_tiff(TiffSource& source) {
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                                 &TIFFOpenOptionsFree);
  if (options == nullptr) throw std::bad_alloc();
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), kMostTiffAtOnce);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_tiff_words, &source);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), pass_over_tiff, &source);
  // "m": no mapping into memory; the bytes are there already.
  return {TIFFClientOpenExt("picture", "rm", &source, read_tiff_bytes, write_tiff_bytes, seek_tiff, close_tiff,
                            size_of_tiff, nullptr, nullptr, options.get()),
          &TIFFClose};
}

template <class Value>
Value tiff_field(TIFF* tiff, ttag_t tag) {
  Value value{};
  TIFFGetFieldDefaulted(tiff, tag, &value);
  return value;
}

/// One channel, as it is.
bool reads_tiff_rows(TIFF* tiff, StoredPixels& pixels) {
  const auto row_bytes = static_cast<std::size_t>(TIFFScanlineSize(tiff));
  pixels.bytes.resize(row_bytes * static_cast<std::size_t>(pixels.height));
  for (int row = 0; row < pixels.height; ++row) {
    char* to = pixels.bytes.data() + static_cast<std::size_t>(row) * row_bytes;
    if (TIFFReadScanline(tiff, to, static_cast<std::uint32_t>(row)) != 1) return false;
  }
  return true;
}

/// Through libtiff's own way from any kind of colour, whose transparent pixels are darkened already.
bool reads_tiff_colors(TIFF* tiff, StoredPixels& pixels) {
  const std::size_t count = static_cast<std::size_t>(pixels.width) * static_cast<std::size_t>(pixels.height);
  std::vector<std::uint32_t> abgr(count);
  const int is_read =
      TIFFReadRGBAImageOriented(tiff, static_cast<std::uint32_t>(pixels.width),
                                static_cast<std::uint32_t>(pixels.height), abgr.data(), ORIENTATION_TOPLEFT, 1);
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

}  // namespace

StoredPixels read_tiff(std::string_view bytes, const fs::path& name) {
  TiffSource source{bytes};
  const TiffFile file = opened_tiff(source);
  if (file == nullptr) refuse_damage(name, "", source.words, "TIFF");
  TIFF* tiff = file.get();
  const auto width = tiff_field<std::uint32_t>(tiff, TIFFTAG_IMAGEWIDTH),
             height = tiff_field<std::uint32_t>(tiff, TIFFTAG_IMAGELENGTH);
  const auto channels = tiff_field<std::uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL);
  const auto colours = tiff_field<std::uint16_t>(tiff, TIFFTAG_PHOTOMETRIC);
  if (colours == PHOTOMETRIC_SEPARATED) refuse_cmyk(name);
  const auto bits = tiff_field<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE);
  require_possible_size(name, width, height, kMostPhotoPixels, kMostTiffBits / std::max(1, bits * channels),
                        bytes.size());
  require_square_pixels(name, tiff_field<float>(tiff, TIFFTAG_XRESOLUTION),
                        tiff_field<float>(tiff, TIFFTAG_YRESOLUTION));
  if (tiff_field<std::uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT) != SAMPLEFORMAT_UINT || bits > 16) {
    throw DataError(name, "", "channels of another type", "whole numbers of 8 or 16 bits a channel");
  }
  StoredPixels pixels{static_cast<int>(width), static_cast<int>(height), channels, bits, {}};
  const bool is_grey = channels == 1 && (colours == PHOTOMETRIC_MINISBLACK || colours == PHOTOMETRIC_MINISWHITE);
  if (is_grey && TIFFIsTiled(tiff) != 0) {
    throw DataError(name, "", "one channel in tiles", "one channel in strips", "Save it again without tiles.");
  }
  if (!(is_grey ? reads_tiff_rows(tiff, pixels) : reads_tiff_colors(tiff, pixels)))
    refuse_damage(name, "", source.words, "TIFF");
  return pixels;
}

}  // namespace incise
