#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace incise {

/// Pixels as a file holds them: rows from the top, channels side by side, 16 bits in the machine's byte order.
struct StoredPixels {
  int width = 0;
  int height = 0;
  int channels = 0;  ///< 1 grey, 2 grey and alpha, 3 RGB, 4 RGB and alpha
  int bits = 0;      ///< of a channel; pixels of fewer than 8 are packed
  std::string bytes;
  double per_width = 0.0, per_height = 0.0;  ///< pixels in one length, as the file states them; 0: it does not
};

/// Turned so that its first row is the top of what the camera saw. @pre 8 or 16 bits.
/// @param orientation  1 to 8, as EXIF and TIFF number them (EXIF 2.32, 4.6.4; TIFF 6.0, section 8); others: as it is.
[[nodiscard]] StoredPixels upright(StoredPixels from, int orientation);

/// What the first chunk of a PNG file states.
struct PngHeader {
  int width = 0;
  int height = 0;
  int bits = 0;    ///< of a channel
  int colour = 0;  ///< colour type: 0 grey, 2 RGB, 3 palette, 4 grey and alpha, 6 RGB and alpha
};

inline constexpr double kMostPhotoPixels = 2e8;

/// @throws DataError for anything but a PNG file, for damage, and for more pixels than `most_pixels` or than the file
/// can hold.
[[nodiscard]] PngHeader read_png_header(std::string_view bytes, const std::filesystem::path& name, double most_pixels);

/// The whole picture, every checksum compared; palettes and transparent colours are expanded, nothing else is changed:
/// no gamma, no background, no scaling. @throws DataError as read_png_header.
/// Source: PNG specification (W3C), 5.2 to 5.5 and 11.2.2.
[[nodiscard]] StoredPixels read_png(std::string_view bytes, const std::filesystem::path& name, double most_pixels);

enum class PngPacking {
  Small,  ///< for drawings, in sRGB, which libpng's defaults pack to a fraction
  Fast,   ///< for photographs, whose noise hardly packs: a ninth of the time for five per cent more bytes
};

/// @pre bytes of width * height * channels numbers of 8 or 16 bits; 1 or 3 channels.
[[nodiscard]] std::string write_png(const StoredPixels& pixels, PngPacking packing);

/// RGB, or grey as it is; the camera's orientation applied. What libjpeg would paint over in grey is refused.
/// @throws DataError for damage, CMYK, more pixels than kMostPhotoPixels or than the file can hold.
/// Sources: ITU-T T.81; EXIF 2.32.
[[nodiscard]] StoredPixels read_jpeg(std::string_view bytes, const std::filesystem::path& name);

/// Colour as RGB of 8 bits, laid on white where it is transparent. Grey pixels are read only if they have one channel of
/// 16 bits; of other grey pictures only size, channels and bits are returned. The stored orientation is applied.
/// @throws DataError as read_jpeg.  Source: TIFF 6.0.
[[nodiscard]] StoredPixels read_tiff(std::string_view bytes, const std::filesystem::path& name);

/// @param most_pixels_per_byte  that the format's compression can reach: a file that claims more would fill the memory
/// with nothing.  @throws DataError
void require_possible_size(const std::filesystem::path& name, double width, double height, double most_pixels,
                           double most_pixels_per_byte, std::size_t bytes);

[[noreturn]] void refuse_cmyk(const std::filesystem::path& name);
[[noreturn]] void refuse_picture(const std::filesystem::path& name, const std::string& place, const char* words,
                                 const char* format);

}  // namespace incise
