#include "io/picture_file.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>
#include <png.h>
#include <zlib.h>

#include <bit>
#include <csetjmp>
#include <cstring>
#include <new>

namespace incise {
namespace {

namespace fs = std::filesystem;

constexpr double kMostPngBits = 8.0 * 1100.0;  // per byte of the file: zlib packs 1032 bytes into one

/// Source or target of libpng's reading or writing, and its error message.
struct PngTransfer {
  std::string_view in;
  std::size_t at = 0;
  std::string* out = nullptr;
  char words[128] = {};
};

void read_png_bytes(png_structp png, png_bytep to, png_size_t count) {
  auto* transfer = static_cast<PngTransfer*>(png_get_io_ptr(png));
  if (count > transfer->in.size() - transfer->at) {
    transfer->at = transfer->in.size();
    png_error(png, "the end of the file");
  }
  std::memcpy(to, transfer->in.data() + transfer->at, count);
  transfer->at += count;
}

void write_png_bytes(png_structp png, png_bytep from, png_size_t count) {
  static_cast<PngTransfer*>(png_get_io_ptr(png))->out->append(reinterpret_cast<const char*>(from), count);
}

void flush_png(png_structp /*png*/) {}

[[noreturn]] void leave_png(png_structp png, png_const_charp words) {
  auto* transfer = static_cast<PngTransfer*>(png_get_error_ptr(png));
  std::strncpy(transfer->words, words, sizeof transfer->words - 1);
  std::longjmp(png_jmpbuf(png), 1);
}

void pass_over_png(png_structp /*png*/, png_const_charp /*words*/) {}

/// Reads one PNG file. No object with a destructor may exist between setjmp and longjmp.
class PngReading {
 public:
  PngReading(std::string_view bytes, const fs::path& name) : name_(name) {
    transfer_.in = bytes;
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &transfer_, leave_png, pass_over_png);
    info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
  }
  ~PngReading() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReading(const PngReading&) = delete;
  PngReading& operator=(const PngReading&) = delete;

  PngHeader header(double most_pixels) {
    if (!reads_header()) refuse();
    const PngHeader header{static_cast<int>(png_get_image_width(png_, info_)),
                           static_cast<int>(png_get_image_height(png_, info_)), png_get_bit_depth(png_, info_),
                           png_get_color_type(png_, info_)};
    const double pixel_bits = header.bits * png_get_channels(png_, info_);
    require_possible_size(name_, header.width, header.height, most_pixels, kMostPngBits / pixel_bits,
                          transfer_.in.size());
    return header;
  }

  /// @pre header() has returned.
  StoredPixels pixels() {
    if (!begins_pixels()) refuse();
    StoredPixels pixels{static_cast<int>(png_get_image_width(png_, info_)),
                        static_cast<int>(png_get_image_height(png_, info_)),
                        png_get_channels(png_, info_),
                        png_get_bit_depth(png_, info_),
                        {}};
    png_uint_32 x = 0, y = 0;
    int unit = 0;
    if (png_get_pHYs(png_, info_, &x, &y, &unit) != 0) {
      pixels.per_width = x;
      pixels.per_height = y;
    }
    pixels.bytes.resize(png_get_rowbytes(png_, info_) * static_cast<std::size_t>(pixels.height));
    if (!reads_rows(pixels.bytes.data())) refuse();
    return pixels;
  }

 private:
  bool reads_header() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_read_fn(png_, &transfer_, read_png_bytes);
    png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_set_user_limits(png_, 0x7fffffff, 0x7fffffff);
    png_set_chunk_cache_max(png_, 1);  // do not unpack texts: a thousand of them would fill 8 GB
    png_read_info(png_, info_);
    return true;
  }

  bool begins_pixels() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    if (png_get_color_type(png_, info_) != PNG_COLOR_TYPE_GRAY) png_set_expand(png_);
    if constexpr (std::endian::native == std::endian::little) png_set_swap(png_);
    passes_ = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }

  bool reads_rows(char* to) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    const std::size_t row_bytes = png_get_rowbytes(png_, info_);
    const png_uint_32 rows = png_get_image_height(png_, info_);
    for (int pass = 0; pass < passes_; ++pass) {
      for (png_uint_32 row = 0; row < rows; ++row)
        png_read_row(png_, reinterpret_cast<png_bytep>(to + row * row_bytes), nullptr);
    }
    png_read_end(png_, nullptr);
    return true;
  }

  [[noreturn]] void refuse() const {
    refuse_picture(name_, fmt::format("byte {}", transfer_.at), transfer_.words, "PNG");
  }

  const fs::path& name_;
  PngTransfer transfer_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  int passes_ = 1;
};

bool writes_png(PngTransfer& transfer, const StoredPixels& pixels, PngPacking packing) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &transfer, leave_png, pass_over_png);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_set_write_fn(png, &transfer, write_png_bytes, flush_png);
  png_set_IHDR(png, info, static_cast<png_uint_32>(pixels.width), static_cast<png_uint_32>(pixels.height), pixels.bits,
               pixels.channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (packing == PngPacking::Small) {
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  } else {
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_compression_level(png, Z_BEST_SPEED);
    png_set_compression_strategy(png, Z_RLE);
  }
  png_write_info(png, info);
  if constexpr (std::endian::native == std::endian::little) png_set_swap(png);
  const std::size_t row_bytes = png_get_rowbytes(png, info);
  for (int row = 0; row < pixels.height; ++row) {
    png_write_row(png,
                  reinterpret_cast<png_const_bytep>(pixels.bytes.data()) + static_cast<std::size_t>(row) * row_bytes);
  }
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return true;
}

}  // namespace

PngHeader read_png_header(std::string_view bytes, const fs::path& name, double most_pixels) {
  return PngReading(bytes, name).header(most_pixels);
}

StoredPixels read_png(std::string_view bytes, const fs::path& name, double most_pixels) {
  PngReading reading(bytes, name);
  static_cast<void>(reading.header(most_pixels));
  return reading.pixels();
}

std::string write_png(const StoredPixels& pixels, PngPacking packing) {
  std::string file;
  PngTransfer transfer;
  transfer.out = &file;
  if (!writes_png(transfer, pixels, packing))
    throw Error(fmt::format("a PNG picture cannot be encoded: {}", transfer.words));
  return file;
}

}  // namespace incise
