#pragma once

#include <incise/geometry/picture.hpp>

#include <cstdio>
#include <cstdlib>
#include <string>
// libjpeg's header needs FILE.
#include <jpeglib.h>

namespace incise::testing {

/// A JPEG file in memory, chroma at half resolution as cameras write it. @param quality  [1, 100].
inline std::string encode_jpeg(const ColorPicture& picture, int quality) {
  jpeg_error_mgr errors;
  jpeg_compress_struct info;
  info.err = jpeg_std_error(&errors);  // ends the program at an error
  jpeg_create_compress(&info);
  unsigned char* file = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &file, &size);
  info.image_width = static_cast<JDIMENSION>(picture.width);
  info.image_height = static_cast<JDIMENSION>(picture.height);
  info.input_components = 3;
  info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, quality, TRUE);
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    const std::size_t row_bytes = 3 * static_cast<std::size_t>(picture.width);
    auto* row = const_cast<JSAMPROW>(picture.rgb.data() + info.next_scanline * row_bytes);
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  std::string bytes(reinterpret_cast<const char*>(file), size);
  std::free(file);
  return bytes;
}

}  // namespace incise::testing
