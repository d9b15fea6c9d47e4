#include "bench_png.hpp"

#include <incise/core/error.hpp>

#include <png.h>

#include <csetjmp>
#include <vector>

namespace incise {
namespace {

extern "C" void keep_bytes(png_structp png, png_bytep data, png_size_t length) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), length);
}
extern "C" void nothing_to_flush(png_structp /*png*/) {}

/// @param rows  as the file wants them: 16-bit values with the high byte first.
std::string encoded(const std::vector<png_bytep>& rows, int width, int height, int bits, int color) {
  std::string file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    throw Error("a picture could not be encoded as PNG");
  }
  png_set_write_fn(png, &file, keep_bytes, nothing_to_flush);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits, color,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(png, 4);
  png_write_info(png, info);
  png_write_image(png, const_cast<png_bytepp>(rows.data()));
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return file;
}

}  // namespace

std::string png_of_colors(std::span<const std::uint8_t> pixels, int width, int height) {
  INCISE_REQUIRE(width > 0 && height > 0 &&
                     pixels.size() == 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                 "expected three values for each pixel");
  std::vector<png_bytep> rows;
  for (int v = 0; v < height; ++v)
    rows.push_back(const_cast<png_bytep>(pixels.data()) + 3 * static_cast<std::size_t>(v) * static_cast<std::size_t>(width));
  return encoded(rows, width, height, 8, PNG_COLOR_TYPE_RGB);
}

std::string png_of_counts(std::span<const std::uint16_t> counts, int width, int height) {
  INCISE_REQUIRE(width > 0 && height > 0 &&
                     counts.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                 "expected one value for each pixel");
  std::vector<png_byte> bytes;
  bytes.reserve(2 * counts.size());
  for (const std::uint16_t count : counts) {
    bytes.push_back(static_cast<png_byte>(count >> 8));
    bytes.push_back(static_cast<png_byte>(count & 0xFF));
  }
  std::vector<png_bytep> rows;
  for (int v = 0; v < height; ++v)
    rows.push_back(bytes.data() + 2 * static_cast<std::size_t>(v) * static_cast<std::size_t>(width));
  return encoded(rows, width, height, 16, PNG_COLOR_TYPE_GRAY);
}

}  // namespace incise
