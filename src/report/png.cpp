#include "report/png.hpp"

#include <incise/core/error.hpp>
#include <incise/io/text_encoding.hpp>

#include <png.h>

#include <cstring>

namespace incise {

std::string encoded_png(std::span<const std::uint8_t> pixels, int width, int height, int channels) {
  INCISE_REQUIRE(width > 0 && height > 0 && (channels == 1 || channels == 3), "expected a picture of 1 or 3 channels");
  INCISE_REQUIRE(pixels.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                                      static_cast<std::size_t>(channels),
                 "expected as many pixels as width times height");
  png_image image;
  std::memset(&image, 0, sizeof image);
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = channels == 1 ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB;
  std::string file(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t size = file.size();
  if (png_image_write_to_memory(&image, file.data(), &size, 0, pixels.data(), 0, nullptr) == 0) {
    throw Error(std::string("a picture of the report could not be encoded: ") + image.message);
  }
  file.resize(size);
  return file;
}

std::string png_data_uri(std::string_view png) {
  return "data:image/png;base64," + base64(png);
}

}  // namespace incise
