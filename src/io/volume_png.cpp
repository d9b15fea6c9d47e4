#include "io/volume_png.hpp"

#include "io/picture_file.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>

#include <fmt/format.h>

#include <string>

namespace incise {

RawImage read_gray_png(const std::filesystem::path& file) {
  const std::string bytes = read_text(file);
  const PngHeader header = read_png_header(bytes, file, kMostPicturePixels);
  constexpr int kGray = 0, kGrayAndAlpha = 4;
  if (header.colour != kGray) {
    throw DataError(file, "colour type", header.colour == kGrayAndAlpha ? "gray with transparency" : "colour",
                    "gray only");
  }
  if (header.bits != 8 && header.bits != 16)
    throw DataError(file, "bit depth", fmt::format("{}", header.bits), "8 or 16");
  RawImage image;
  image.grid.size = {header.width, header.height, 1};
  image.component = header.bits == 8 ? Component::U8 : Component::U16;
  const StoredPixels pixels = read_png(bytes, file, kMostPicturePixels);
  image.bytes.assign(pixels.bytes.begin(), pixels.bytes.end());
  return image;
}

}  // namespace incise
