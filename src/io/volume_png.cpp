#include "io/volume_png.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>

#include <fmt/format.h>
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <string>

namespace incise {
namespace {

namespace fs = std::filesystem;

constexpr double kLargestPngGain = 1100.0;  // of packed pixels: zlib's is 1032

/// A big-endian number of four bytes.
std::uint32_t number_at(const std::string& bytes, std::size_t position) {
  std::uint32_t number = 0;
  for (std::size_t b = 0; b < 4; ++b) number = number << 8U | static_cast<unsigned char>(bytes[position + b]);
  return number;
}

struct PngHeader {
  std::uint32_t columns = 0, rows = 0;
  int depth = 0;
};

/// Follows the chunks from the signature to the end mark and checks their sums, then what the first of them states.
PngHeader header_of(const fs::path& file, const std::string& bytes) {
  const std::string signature = "\x89PNG\r\n\x1a\n";
  if (bytes.compare(0, signature.size(), signature) != 0) {
    throw DataError(file, "first bytes", "something else", "a PNG picture", "Is the file damaged, or its extension wrong?");
  }
  constexpr std::size_t around = 12;  // length, name and sum of a chunk
  std::string name;
  bool has_pixels = false;
  for (std::size_t position = signature.size(); name != "IEND";) {
    const std::size_t length = position + around <= bytes.size() ? number_at(bytes, position) : bytes.size();
    const bool is_whole = position + around + length <= bytes.size();
    const auto* sum_begin = reinterpret_cast<const Bytef*>(bytes.data() + position + 4);
    if (!is_whole || crc32(0, sum_begin, static_cast<uInt>(length + 4)) != number_at(bytes, position + 8 + length)) {
      throw DataError(file, fmt::format("byte {} of {}", position, bytes.size()), "a damaged chunk", "a complete PNG picture",
                      "Is the file cut short?");
    }
    name = bytes.substr(position + 4, 4);
    if (position == signature.size() && (name != "IHDR" || length != 13)) throw DataError(file, "header", "another first chunk", "IHDR");
    has_pixels = has_pixels || name == "IDAT";
    position += around + length;
  }
  PngHeader header{number_at(bytes, 16), number_at(bytes, 20), static_cast<unsigned char>(bytes[24])};
  const int colour = static_cast<unsigned char>(bytes[25]);
  if (colour != 0) throw DataError(file, "colour type", colour == 4 ? "gray with transparency" : "colour", "gray only");
  if (header.depth != 8 && header.depth != 16) throw DataError(file, "bit depth", fmt::format("{}", header.depth), "8 or 16");
  if (!has_pixels) throw DataError(file, "IDAT", "no pixels", "a complete PNG picture");
  const double pixels = static_cast<double>(header.columns) * header.rows;
  const bool is_possible = pixels >= 1.0 && pixels <= kMostPicturePixels && pixels * header.depth / 8 <= kLargestPngGain * static_cast<double>(bytes.size());
  if (!is_possible) {
    throw DataError(file, "size", fmt::format("{} x {} pixels in {} bytes", header.columns, header.rows, bytes.size()), "a picture that its file can hold");
  }
  return header;
}

/// What libpng reads from, and what it says when it gives up.
struct PngSource {
  const std::string* bytes = nullptr;
  std::size_t at = 0;
  char problem[128] = {};
};

void read_bytes(png_structp png, png_bytep out, png_size_t count) {
  auto* source = static_cast<PngSource*>(png_get_io_ptr(png));
  if (count > source->bytes->size() - source->at) png_error(png, "the file ends too early");
  std::memcpy(out, source->bytes->data() + source->at, count);
  source->at += count;
}

[[noreturn]] void give_up(png_structp png, png_const_charp words) {
  auto* source = static_cast<PngSource*>(png_get_error_ptr(png));
  std::strncpy(source->problem, words, sizeof source->problem - 1);
  std::longjmp(png_jmpbuf(png), 1);
}

void pass_over(png_structp /*png*/, png_const_charp /*words*/) {}

/// Plain code between setjmp and longjmp: nothing here has a destructor. @returns whether all rows were read into `pixels`.
bool decode(PngSource& source, char* pixels, std::size_t row_bytes, std::uint32_t rows) {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, give_up, pass_over);
  if (png == nullptr) return false;
  png_infop info = png_create_info_struct(png);
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_read_struct(&png, &info, nullptr);
    return false;
  }
  png_set_read_fn(png, &source, read_bytes);
  png_set_user_limits(png, 0x7fffffff, 0x7fffffff);
  png_read_info(png, info);
  if (png_get_rowbytes(png, info) != row_bytes || png_get_image_height(png, info) != rows) png_error(png, "another size than its header states");
  if (png_get_bit_depth(png, info) == 16) png_set_swap(png);
  const int passes = png_set_interlace_handling(png);
  png_read_update_info(png, info);
  for (int pass = 0; pass < passes; ++pass) {
    for (std::uint32_t row = 0; row < rows; ++row) png_read_row(png, reinterpret_cast<png_bytep>(pixels + row * row_bytes), nullptr);
  }
  png_read_end(png, nullptr);
  png_destroy_read_struct(&png, &info, nullptr);
  return true;
}

}  // namespace

RawImage read_gray_png(const fs::path& file) {
  const std::string bytes = read_text(file);
  const PngHeader header = header_of(file, bytes);
  RawImage image;
  image.grid.size = {static_cast<int>(header.columns), static_cast<int>(header.rows), 1};
  image.component = header.depth == 8 ? Component::U8 : Component::U16;
  const std::size_t row_bytes = static_cast<std::size_t>(header.columns) * static_cast<std::size_t>(header.depth / 8);
  image.bytes.resize(row_bytes * header.rows);
  PngSource source{&bytes};
  if (!decode(source, image.bytes.data(), row_bytes, header.rows)) {
    throw DataError(file, "pixels", fmt::format("\"{}\"", source.problem), "a complete PNG picture", "Is the file damaged?");
  }
  return image;
}

}  // namespace incise
