#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace incise {

/// Pixels as stored in a file: rows from the top, channels interleaved, 16-bit numbers in the machine's byte order.
struct StoredPixels {
  int width = 0;
  int height = 0;
  int channels = 0;  ///< 1 grey, 2 grey and alpha, 3 RGB, 4 RGB and alpha
  int bits = 0;      ///< per channel; pixels of fewer than 8 bits are packed
  std::string bytes;
  double per_width = 0.0, per_height = 0.0;  ///< pixels per unit of length, as stated in the file; 0: not stated
};

/// Returns the picture turned so that its first row is the top of the camera's view. @pre 8 or 16 bits.
/// @param orientation  1 to 8, as in EXIF and TIFF (EXIF 2.32, 4.6.4; TIFF 6.0, section 8); any other: not turned
[[nodiscard]] StoredPixels upright(StoredPixels from, int orientation);

/// The first chunk of a PNG file.
struct PngHeader {
  int width = 0;
  int height = 0;
  int bits = 0;    ///< per channel
  int colour = 0;  ///< colour type: 0 grey, 2 RGB, 3 palette, 4 grey and alpha, 6 RGB and alpha
};

inline constexpr double kMostPhotoPixels = 2e8;

/// Reads the header of a PNG file held in memory. @param name  names the file in messages
/// @throws DataError if it is no PNG file, damaged, or has more pixels than `most_pixels` or than the file can hold.
[[nodiscard]] PngHeader read_png_header(std::string_view bytes, const std::filesystem::path& name, double most_pixels);

/// Reads the whole picture and checks every checksum. Expands palettes and transparent colours, and changes nothing
/// else: no gamma, no background, no scaling. @throws DataError as read_png_header.
/// Source: PNG specification (W3C), 5.2 to 5.5 and 11.2.2.
[[nodiscard]] StoredPixels read_png(std::string_view bytes, const std::filesystem::path& name, double most_pixels);

enum class PngPacking {
  Small,  ///< for drawings, in sRGB, which libpng's defaults compress well
  Fast,   ///< for photographs, whose noise hardly compresses: a ninth of the time for five per cent more bytes
};

/// Returns the bytes of a PNG file. @pre width * height * channels numbers of 8 or 16 bits; 1 or 3 channels.
[[nodiscard]] std::string write_png(const StoredPixels& pixels, PngPacking packing);

/// Reads a JPEG as RGB or grey and applies the camera's orientation. Refuses damage that libjpeg would fill with grey.
/// @throws DataError for damage, CMYK, or more pixels than kMostPhotoPixels or than the file can hold.
/// Sources: ITU-T T.81; EXIF 2.32.
[[nodiscard]] StoredPixels read_jpeg(std::string_view bytes, const std::filesystem::path& name);

/// Reads a TIFF and applies its orientation. Returns colour as RGB of 8 bits, transparent pixels blended with white;
/// grey pixels only if they have one channel of 16 bits; of other grey pictures only size, channels and bits.
/// @throws DataError as read_jpeg.  Source: TIFF 6.0.
[[nodiscard]] StoredPixels read_tiff(std::string_view bytes, const std::filesystem::path& name);

/// Checks the size of a picture that a file of `bytes` bytes states, before allocating memory for it.
/// @param most_pixels_per_byte  limit of the format's compression  @throws DataError
void require_possible_size(const std::filesystem::path& name, double width, double height, double most_pixels,
                           double most_pixels_per_byte, std::size_t bytes);

[[noreturn]] void refuse_cmyk(const std::filesystem::path& name);
[[noreturn]] void refuse_picture(const std::filesystem::path& name, const std::string& place, const char* words,
                                 const char* format);

}  // namespace incise
