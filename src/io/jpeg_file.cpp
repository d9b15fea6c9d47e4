#include "io/picture_file.hpp"

#include <cstdio>
// libjpeg's header needs FILE.
#include <jerror.h>
#include <jpeglib.h>

#include <csetjmp>
#include <memory>
#include <utility>

namespace incise {
namespace {

namespace fs = std::filesystem;

constexpr double kMostJpegPixelsPerByte = 8.0 * 64.0;  // one bit for each block of 8 x 8 pixels
constexpr int kMostJpegScans = 200;  // progressive files have about ten; each costs as much as a whole picture

/// libjpeg's error handler, with a jump target, because its error routine must not return.
struct JpegHandler {
  jpeg_error_mgr manager{};  ///< must be first: libjpeg's pointer to it is cast to JpegHandler*
  std::jmp_buf out{};
  char words[JMSG_LENGTH_MAX] = {};
  bool stops_at_warnings = false;
};

[[noreturn]] void leave_jpeg(j_common_ptr info) {
  auto* handler = reinterpret_cast<JpegHandler*>(info->err);
  info->err->format_message(info, handler->words);
  std::longjmp(handler->out, 1);
}

/// Treats a warning as an error if it means damage: in the picture always, because libjpeg would fill the gap with
/// grey; in the header only at the end of the file, because other warnings there are about the camera maker's bytes.
void warn_jpeg(j_common_ptr info, int level) {
  const bool is_damage =
      reinterpret_cast<JpegHandler*>(info->err)->stops_at_warnings || info->err->msg_code == JWRN_JPEG_EOF;
  if (level < 0 && is_damage) leave_jpeg(info);
}

/// Reads one JPEG file. No object with a destructor may exist between setjmp and longjmp.
class JpegReading {
 public:
  explicit JpegReading(std::string_view bytes) : bytes_(bytes) {
    info_.err = jpeg_std_error(&handler_.manager);
    handler_.manager.error_exit = leave_jpeg;
    handler_.manager.emit_message = warn_jpeg;
  }
  ~JpegReading() { jpeg_destroy_decompress(&info_); }
  JpegReading(const JpegReading&) = delete;
  JpegReading& operator=(const JpegReading&) = delete;

  [[nodiscard]] const jpeg_decompress_struct& info() const { return info_; }
  [[nodiscard]] const char* words() const { return handler_.words; }

  bool reads_header() {
    if (setjmp(handler_.out) != 0) return false;
    jpeg_create_decompress(&info_);
    jpeg_mem_src(&info_, reinterpret_cast<const unsigned char*>(bytes_.data()), bytes_.size());
    jpeg_save_markers(&info_, JPEG_APP0 + 1, 0xFFFF);
    jpeg_read_header(&info_, TRUE);
    return true;
  }

  /// @param to  image_height rows of image_width pixels of one channel or three.
  bool reads_rows(char* to, int channels) {
    if (setjmp(handler_.out) != 0) return false;
    handler_.stops_at_warnings = true;
    progress_.progress_monitor = [](j_common_ptr info) {
      if (reinterpret_cast<j_decompress_ptr>(info)->input_scan_number > kMostJpegScans) {
        auto* handler = reinterpret_cast<JpegHandler*>(info->err);
        std::snprintf(handler->words, sizeof handler->words, "more than %d scans", kMostJpegScans);
        std::longjmp(handler->out, 1);
      }
    };
    info_.progress = &progress_;
    info_.out_color_space = channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_start_decompress(&info_);
    const std::size_t row_bytes = static_cast<std::size_t>(info_.output_width) * static_cast<std::size_t>(channels);
    while (info_.output_scanline < info_.output_height) {
      auto* row = reinterpret_cast<JSAMPROW>(to + info_.output_scanline * row_bytes);
      jpeg_read_scanlines(&info_, &row, 1);
    }
    jpeg_finish_decompress(&info_);
    return true;
  }

 private:
  std::string_view bytes_;
  JpegHandler handler_;
  jpeg_decompress_struct info_{};
  jpeg_progress_mgr progress_{};
};

/// Returns the orientation in a JPEG's EXIF block, 1 to 8; 1 (not turned) if none is stated.
int orientation_in(std::string_view exif) {
  constexpr std::string_view kBegin("Exif\0\0", 6);
  if (!exif.starts_with(kBegin)) return 1;
  const std::string_view tiff = exif.substr(kBegin.size());
  const bool is_big = tiff.starts_with('M');
  const auto number = [&](std::size_t at, std::size_t count) -> std::uint32_t {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t place = at + (is_big ? i : count - 1 - i);
      value = value << 8U | (place < tiff.size() ? static_cast<std::uint8_t>(tiff[place]) : 0U);
    }
    return value;
  };
  constexpr std::uint32_t kOrientation = 0x0112, kTiff = 42;
  if (number(2, 2) != kTiff) return 1;
  const std::size_t directory = number(4, 4);
  const std::uint32_t entries = number(directory, 2);
  for (std::uint32_t i = 0; i < entries; ++i) {
    const std::size_t entry = directory + 2 + 12 * static_cast<std::size_t>(i);
    if (entry >= tiff.size()) break;
    if (number(entry, 2) != kOrientation) continue;
    const std::uint32_t value = number(entry + 8, 2);
    return value >= 1 && value <= 8 ? static_cast<int>(value) : 1;
  }
  return 1;
}

int orientation_of(const jpeg_decompress_struct& info) {
  for (const jpeg_marker_struct* marker = info.marker_list; marker != nullptr; marker = marker->next) {
    const int orientation = orientation_in({reinterpret_cast<const char*>(marker->data), marker->data_length});
    if (orientation != 1) return orientation;
  }
  return 1;
}

}  // namespace

StoredPixels read_jpeg(std::string_view bytes, const fs::path& name) {
  const auto reading = std::make_unique<JpegReading>(bytes);
  if (!reading->reads_header()) refuse_picture(name, "", reading->words(), "JPEG");
  const jpeg_decompress_struct& info = reading->info();
  if (info.num_components == 4) refuse_cmyk(name);
  require_possible_size(name, info.image_width, info.image_height, kMostPhotoPixels, kMostJpegPixelsPerByte,
                        bytes.size());
  StoredPixels pixels{
      static_cast<int>(info.image_width), static_cast<int>(info.image_height), info.num_components == 1 ? 1 : 3, 8, {}};
  pixels.bytes.resize(static_cast<std::size_t>(pixels.channels) * info.image_width * info.image_height);
  if (info.saw_JFIF_marker) {
    pixels.per_width = info.X_density;
    pixels.per_height = info.Y_density;
  }
  const int orientation = orientation_of(info);  // before reading the rows: libjpeg drops it with the last one
  if (!reading->reads_rows(pixels.bytes.data(), pixels.channels)) refuse_picture(name, "", reading->words(), "JPEG");
  return upright(std::move(pixels), orientation);
}

}  // namespace incise
