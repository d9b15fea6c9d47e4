#include "imaging/picture_file.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>
#include <jpeglib.h>

#include <csetjmp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace incise::imaging_detail {
namespace {

/// libjpeg's error handler, with a way out: its errors must not return.
struct Handler {
  jpeg_error_mgr manager;  ///< first, so that libjpeg's pointer to it is one to this
  jpeg_decompress_struct info;
  std::jmp_buf out;
  char message[JMSG_LENGTH_MAX];
};

[[noreturn]] void leave(j_common_ptr info) {
  auto* handler = reinterpret_cast<Handler*>(info->err);
  info->err->format_message(info, handler->message);
  std::longjmp(handler->out, 1);
}

/// In the header a warning is about odd bytes of the camera's maker.
void pass_over(j_common_ptr, int) {}

/// In the picture it is damage that libjpeg would paint over in grey.
void leave_at_warning(j_common_ptr info, int level) {
  if (level < 0) leave(info);
}

/// Decodes at an eighth of the size, which reads every coefficient. False: damaged, message set.
/// Only plain data lives in here: longjmp runs no destructors.
bool can_be_decoded(Handler& handler, const unsigned char* bytes, unsigned long size, unsigned char* row) {
  jpeg_decompress_struct& info = handler.info;
  info.err = jpeg_std_error(&handler.manager);
  handler.manager.error_exit = leave;
  handler.manager.emit_message = pass_over;
  jpeg_create_decompress(&info);
  if (setjmp(handler.out) != 0) {
    jpeg_destroy_decompress(&info);
    return false;
  }
  jpeg_mem_src(&info, bytes, size);
  jpeg_read_header(&info, TRUE);
  handler.manager.emit_message = leave_at_warning;
  info.scale_num = 1;
  info.scale_denom = 8;
  info.dct_method = JDCT_IFAST;
  jpeg_start_decompress(&info);
  while (info.output_scanline < info.output_height) jpeg_read_scanlines(&info, &row, 1);
  jpeg_finish_decompress(&info);
  jpeg_destroy_decompress(&info);
  return true;
}

}  // namespace

void require_sound_jpeg(std::string_view bytes, const std::filesystem::path& name) {
  constexpr std::size_t kWidestRow = 4 * 65536;  // JPEG's widest picture, four channels
  const auto handler = std::make_unique<Handler>();
  std::vector<unsigned char> row(kWidestRow);
  if (can_be_decoded(*handler, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), row.data())) return;
  throw DataError(name, "", fmt::format("a damaged picture ({})", handler->message), "a sound JPEG file",
                  "Copy it again from the camera.");
}

}  // namespace incise::imaging_detail
