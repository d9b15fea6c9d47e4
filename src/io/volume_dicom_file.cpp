#include "io/volume_dicom_file.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <cstring>
#include <fstream>

namespace incise {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMarkAt = 128;  // after a preamble of any content
constexpr std::size_t kMarkSize = 4;
constexpr std::uint32_t kUndefinedLength = 0xffffffff;
constexpr DicomTag kTransferSyntaxTag = 0x00020010;
constexpr DicomTag kItem = 0xfffee000;
constexpr DicomTag kItemEnd = 0xfffee00d;
constexpr DicomTag kSequenceEnd = 0xfffee0dd;
constexpr int kDeepestNesting = 32;

const char* const kImplicitLittleEndian = "1.2.840.10008.1.2";

/// Encodings that wrap the whole data set, not only the pixels.
bool is_foreign_encoding(const std::string& transfer_syntax) {
  return transfer_syntax == "1.2.840.10008.1.2.2" ||     // explicit big endian, retired
         transfer_syntax == "1.2.840.10008.1.2.1.99" ||  // deflated
         transfer_syntax == "1.2.840.10008.1.2.4.95";    // JPIP deflated
}

bool has_long_length(std::string_view vr) {
  constexpr std::array<std::string_view, 13> long_ones{"OB", "OW", "OF", "OD", "OL", "OV", "SQ",
                                                       "UC", "UR", "UT", "UN", "SV", "UV"};
  for (const std::string_view candidate : long_ones) {
    if (vr == candidate) return true;
  }
  return false;
}

bool is_vr(std::string_view vr) {
  return std::isupper(static_cast<unsigned char>(vr[0])) != 0 && std::isupper(static_cast<unsigned char>(vr[1])) != 0;
}

}  // namespace

bool looks_like_dicom(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::array<char, kMarkAt + kMarkSize> start{};
  stream.read(start.data(), start.size());
  if (stream.gcount() == start.size() && std::memcmp(start.data() + kMarkAt, "DICM", kMarkSize) == 0) return true;
  const std::string extension = file.extension().string();
  return extension == ".dcm" || extension == ".DCM";
}

DicomFile::DicomFile(fs::path path) : path_(std::move(path)), bytes_(read_text(path_)) {
  if (bytes_.size() < kMarkAt + kMarkSize || bytes_.compare(kMarkAt, kMarkSize, "DICM") != 0) {
    throw DataError(path_, fmt::format("byte {}", kMarkAt), "no mark 'DICM'", "a DICOM file",
                    "Is the file damaged, or its extension wrong?");
  }
  read_meta();
  read_data_set();
}

void DicomFile::stop_at(std::size_t position, const std::string& found) const {
  throw DataError(path_, fmt::format("byte {} of {}", position, bytes_.size()), found, "a complete DICOM file",
                  "Is the file cut short?");
}

/// Reads a little-endian number of `size` bytes.
std::uint32_t DicomFile::number_at(std::size_t position, std::size_t size) const {
  if (position + size > bytes_.size()) stop_at(bytes_.size(), "the end of the file inside an element");
  std::uint32_t number = 0;
  for (std::size_t b = size; b > 0; --b) number = (number << 8U) | static_cast<unsigned char>(bytes_[position + b - 1]);
  return number;
}

DicomFile::Element DicomFile::read_element(std::size_t position, bool is_explicit) const {
  Element element;
  element.tag = number_at(position, 2) << 16U | number_at(position + 2, 2);
  const bool is_delimiter = element.tag >> 16U == 0xfffeU;
  std::uint32_t length = 0;
  if (!is_explicit || is_delimiter) {
    length = number_at(position + 4, 4);
    element.begin = position + 8;
  } else {
    number_at(position + 4, 2);  // checks that the two bytes exist
    const std::string_view vr = std::string_view(bytes_).substr(position + 4, 2);
    if (!is_vr(vr)) stop_at(position + 4, "bytes that are not a value representation");
    const bool is_long = has_long_length(vr);
    length = is_long ? number_at(position + 8, 4) : number_at(position + 6, 2);
    element.begin = position + (is_long ? 12 : 8);
    element.is_unknown = vr == "UN";
  }
  element.is_undefined_length = length == kUndefinedLength;
  element.length = element.is_undefined_length ? 0 : length;
  if (element.begin + element.length > bytes_.size()) {
    stop_at(bytes_.size(), fmt::format("the end of the file inside element ({:04x},{:04x})", element.tag >> 16U,
                                       element.tag & 0xffffU));
  }
  return element;
}

/// Returns the position after the element's value, delimiters included.
std::size_t DicomFile::end_of(const Element& element, bool is_explicit, int depth) const {
  if (!element.is_undefined_length) return element.begin + element.length;
  // An unknown element of undefined length is a sequence in implicit encoding, whatever surrounds it (PS3.5, 6.2.2).
  return skip_items(element.begin, is_explicit && !element.is_unknown, depth + 1);
}

/// Returns the position after the items of a sequence, or the fragments of encapsulated pixels, and their delimiter.
std::size_t DicomFile::skip_items(std::size_t position, bool is_explicit, int depth) const {
  if (depth > kDeepestNesting) stop_at(position, fmt::format("more than {} nested sequences", kDeepestNesting));
  while (true) {
    const Element item = read_element(position, is_explicit);
    if (item.tag == kSequenceEnd) return item.begin;
    if (item.tag != kItem) stop_at(position, "bytes that are not an item of a sequence");
    position = item.begin + item.length;
    if (!item.is_undefined_length) continue;
    while (true) {
      const Element inside = read_element(position, is_explicit);
      position = inside.begin;
      if (inside.tag == kItemEnd) break;
      position = end_of(inside, is_explicit, depth);
    }
  }
}

void DicomFile::read_meta() {
  std::size_t position = kMarkAt + kMarkSize;
  while (position + 4 <= bytes_.size() && number_at(position, 2) == 0x0002) {
    const Element element = read_element(position, true);
    elements_[element.tag] = element;
    position = end_of(element, true, 0);
  }
  meta_end_ = position;
  transfer_syntax_ = value(kTransferSyntaxTag).value_or("");
  while (!transfer_syntax_.empty() && (transfer_syntax_.back() == '\0' || transfer_syntax_.back() == ' '))
    transfer_syntax_.pop_back();
  if (transfer_syntax_.empty()) stop_at(meta_end_, "no transfer syntax before this");
  if (is_foreign_encoding(transfer_syntax_)) {
    throw DataError(path_, "TransferSyntaxUID", transfer_syntax_, "a little-endian encoding that is not deflated",
                    "Convert the files with 'gdcmconv --raw'.");
  }
}

void DicomFile::read_data_set() {
  const bool is_explicit = transfer_syntax_ != kImplicitLittleEndian;
  std::size_t position = meta_end_;
  while (position < bytes_.size() && !pixels_) {
    const Element element = read_element(position, is_explicit);
    elements_[element.tag] = element;
    position = end_of(element, is_explicit, 0);
    if (element.tag == kPixelDataTag) pixels_ = element;
  }
  end_ = position;
}

std::optional<std::string_view> DicomFile::value(DicomTag tag) const {
  const auto found = elements_.find(tag);
  if (found == elements_.end() || found->second.length == 0) return std::nullopt;
  return std::string_view(bytes_).substr(found->second.begin, found->second.length);
}

std::optional<std::size_t> DicomFile::native_pixel_bytes() const {
  if (!pixels_ || pixels_->is_undefined_length) return std::nullopt;
  return pixels_->length;
}

}  // namespace incise
