#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace incise {

/// A DICOM tag as one number: group in the upper, element in the lower 16 bits.
using DicomTag = std::uint32_t;
inline constexpr DicomTag kPixelDataTag = 0x7fe00010;

/// One DICOM file, whose structure is followed from the first byte to the end of its pixels, to find truncated files
/// here. GDCM, which decodes the pixels later, stops the whole process on some damaged files and accepts others.
/// Supports little-endian encodings, implicit or explicit, native or encapsulated, in part 10 files with a "DICM" mark.
/// Source: DICOM PS3.5, 7.1 (elements), 7.5 (sequences), A.4 (encapsulated pixels); PS3.10, 7.1 (file header).
class DicomFile {
 public:
  /// @throws DataError if the file cannot be read, is no DICOM file, has an unsupported encoding, or ends too early.
  explicit DicomFile(std::filesystem::path path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Returns the bytes of an element outside all sequences, valid as long as this object; nothing if it is absent or
  /// empty.
  [[nodiscard]] std::optional<std::string_view> value(DicomTag tag) const;
  [[nodiscard]] bool has_pixels() const { return pixels_.has_value(); }
  /// Returns the number of bytes of native pixels; nothing if they are encapsulated, that is compressed, or absent.
  [[nodiscard]] std::optional<std::size_t> native_pixel_bytes() const;
  /// Returns the UID of the encoding.
  [[nodiscard]] const std::string& transfer_syntax() const { return transfer_syntax_; }
  /// Returns the file up to the last byte of its pixels, without any bytes after them.
  [[nodiscard]] std::string up_to_pixels() const { return bytes_.substr(0, end_); }

 private:
  struct Element {
    DicomTag tag = 0;
    std::size_t begin = 0;  ///< of the value
    std::size_t length = 0;
    bool is_undefined_length = false;
    bool is_unknown = false;  ///< VR "UN"
  };
  Element read_element(std::size_t position, bool is_explicit) const;
  std::size_t skip_items(std::size_t position, bool is_explicit, int depth) const;
  std::size_t end_of(const Element& element, bool is_explicit, int depth) const;
  std::uint32_t number_at(std::size_t position, std::size_t size) const;
  [[noreturn]] void stop_at(std::size_t position, const std::string& found) const;
  void read_meta();
  void read_data_set();

  std::filesystem::path path_;
  std::string bytes_;
  std::string transfer_syntax_;
  std::map<DicomTag, Element> elements_;
  std::optional<Element> pixels_;
  std::size_t meta_end_ = 0;
  std::size_t end_ = 0;
};

/// Whether the file has the "DICM" mark behind its preamble, or at least the extension .dcm.
[[nodiscard]] bool looks_like_dicom(const std::filesystem::path& file);

}  // namespace incise
