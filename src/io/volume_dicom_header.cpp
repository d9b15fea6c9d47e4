#include "io/volume_dicom.hpp"
#include "io/volume_dicom_file.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

namespace incise {
namespace {

namespace fs = std::filesystem;

struct TagField {
  DicomTag tag;
  const char* name;
};
constexpr TagField kStorageClass{0x00020002, "MediaStorageSOPClassUID"};
constexpr TagField kModality{0x00080060, "Modality"};
constexpr TagField kSeriesUid{0x0020000e, "SeriesInstanceUID"};
constexpr TagField kSeriesDescription{0x0008103e, "SeriesDescription"};
constexpr TagField kPosition{0x00200032, "ImagePositionPatient"};
constexpr TagField kOrientation{0x00200037, "ImageOrientationPatient"};
constexpr TagField kPixelSpacing{0x00280030, "PixelSpacing"};
constexpr TagField kRows{0x00280010, "Rows"};
constexpr TagField kColumns{0x00280011, "Columns"};
constexpr TagField kFrames{0x00280008, "NumberOfFrames"};
constexpr TagField kSamples{0x00280002, "SamplesPerPixel"};
constexpr TagField kPhotometric{0x00280004, "PhotometricInterpretation"};
constexpr TagField kBitsAllocated{0x00280100, "BitsAllocated"};
constexpr TagField kSigned{0x00280103, "PixelRepresentation"};
constexpr TagField kPadding{0x00280120, "PixelPaddingValue"};
constexpr TagField kPaddingLimit{0x00280121, "PixelPaddingRangeLimit"};
constexpr TagField kIntercept{0x00281052, "RescaleIntercept"};
constexpr TagField kSlope{0x00281053, "RescaleSlope"};
constexpr TagField kRescaleType{0x00281054, "RescaleType"};

const std::string kCtImageStorage = "1.2.840.10008.5.1.4.1.1.2";

/// Returns an element's text without the padding that DICOM adds; empty if absent.
std::string text_of(const DicomFile& file, const TagField& field) {
  std::string_view text = file.value(field.tag).value_or("");
  const auto is_padding = [](char c) { return c == ' ' || c == '\0'; };
  while (!text.empty() && is_padding(text.back())) text.remove_suffix(1);
  while (!text.empty() && is_padding(text.front())) text.remove_prefix(1);
  return std::string(text);
}

/// Reads exactly `count` decimal numbers, separated by backslashes.
std::vector<double> numbers_of(const DicomFile& file, const TagField& field, std::size_t count) {
  const std::string text = text_of(file, field);
  const std::string expected = fmt::format("{} decimal number{}", count, count == 1 ? "" : "s");
  if (text.empty()) throw DataError(file.path(), field.name, "nothing", expected);
  std::vector<double> numbers;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find('\\', begin), text.size());
    const std::size_t first = text.find_first_not_of(" +", begin);
    const std::size_t last = text.find_last_not_of(' ', end - 1);
    double number = 0;
    if (first >= end || last == std::string::npos || last < first) break;
    const auto [stop, problem] = std::from_chars(text.data() + first, text.data() + last + 1, number);
    if (problem != std::errc() || stop != text.data() + last + 1 || !std::isfinite(number)) break;
    numbers.push_back(number);
    begin = end + 1;
  }
  if (begin <= text.size() || numbers.size() != count)
    throw DataError(file.path(), field.name, fmt::format("'{}'", text), expected);
  return numbers;
}

std::optional<std::uint16_t> word_of(const DicomFile& file, const TagField& field) {
  const auto value = file.value(field.tag);
  if (!value || value->size() < 2) return std::nullopt;
  std::uint16_t word = 0;
  std::memcpy(&word, value->data(), sizeof word);
  return word;
}

int required_word(const DicomFile& file, const TagField& field) {
  const auto word = word_of(file, field);
  if (!word) throw DataError(file.path(), field.name, "nothing", "a whole number");
  return *word;
}

SliceFrame frame_of(const DicomFile& file) {
  SliceFrame frame;
  frame.columns = required_word(file, kColumns);
  frame.rows = required_word(file, kRows);
  if (frame.columns < 1 || frame.rows < 1)
    throw DataError(file.path(), "Rows, Columns", "an empty picture", "at least one pixel");
  const auto spacing = numbers_of(file, kPixelSpacing, 2);
  frame.row_spacing_mm = spacing[0];
  frame.column_spacing_mm = spacing[1];
  if (spacing[0] <= 0 || spacing[1] <= 0) {
    throw DataError(file.path(), kPixelSpacing.name, fmt::format("{} x {} mm", spacing[0], spacing[1]),
                    "positive lengths");
  }
  if (std::min(spacing[0], spacing[1]) < kFinestVoxelMm || std::max(spacing[0], spacing[1]) > kCoarsestVoxelMm) {
    throw DataError(file.path(), kPixelSpacing.name, fmt::format("{:.4g} x {:.4g} mm", spacing[0], spacing[1]),
                    fmt::format("pixels of {} to {} mm", kFinestVoxelMm, kCoarsestVoxelMm), "Lengths are mm");
  }
  const auto axes = numbers_of(file, kOrientation, 6);
  const Vec3 row(axes[0], axes[1], axes[2]);
  const Vec3 column(axes[3], axes[4], axes[5]);
  constexpr double tolerance = 1e-3;  // most files have six digits, some four
  if (std::abs(row.norm() - 1) > tolerance || std::abs(column.norm() - 1) > tolerance ||
      std::abs(row.dot(column)) > tolerance) {
    throw DataError(file.path(), kOrientation.name, text_of(file, kOrientation), "two unit vectors at right angles");
  }
  frame.row_axis = row.normalized();
  frame.column_axis = (column - frame.row_axis * frame.row_axis.dot(column)).normalized();
  return frame;
}

std::optional<std::pair<int, int>> padding_of(const DicomFile& file, bool is_signed) {
  // Writers disagree whether this field is signed; its bits have the meaning of the pixels' bits.
  const auto meaning = [is_signed](std::uint16_t word) {
    return is_signed ? int{static_cast<std::int16_t>(word)} : int{word};
  };
  const auto padding = word_of(file, kPadding);
  if (!padding) return std::nullopt;
  const int value = meaning(*padding);
  const int limit = meaning(word_of(file, kPaddingLimit).value_or(*padding));
  return std::pair(std::min(value, limit), std::max(value, limit));
}

}  // namespace

DicomIdentity read_dicom_identity(const fs::path& path) {
  const DicomFile file(path);
  DicomIdentity identity{path, text_of(file, kSeriesUid), text_of(file, kSeriesDescription), text_of(file, kModality)};
  // A directory file, a report or a structure set has no pixels; a slice that lost its pixels still has Rows.
  identity.has_picture = word_of(file, kRows).has_value() || file.has_pixels();
  if (!file.has_pixels() && (identity.has_picture || text_of(file, kStorageClass) == kCtImageStorage)) {
    throw DataError(path, "PixelData", "nothing", "a picture", "Is the file cut short?");
  }
  return identity;
}

DicomHeader read_dicom_header(const fs::path& path) {
  const DicomFile file(path);
  if (const auto samples = word_of(file, kSamples); samples && *samples != 1) {
    throw DataError(file.path(), kSamples.name, fmt::format("{} (colour)", *samples), "1 (gray)");
  }
  const std::string modality = text_of(file, kModality);
  if (modality != "CT") throw DataError(file.path(), kModality.name, fmt::format("'{}'", modality), "'CT'");
  const std::string photometric = text_of(file, kPhotometric);
  if (photometric != "MONOCHROME2") {
    throw DataError(file.path(), kPhotometric.name, fmt::format("'{}'", photometric), "'MONOCHROME2'");
  }
  if (const std::string frames = text_of(file, kFrames); !frames.empty() && frames != "1") {
    throw DataError(file.path(), kFrames.name, frames, "1", "Export the series as single-frame CT images.");
  }
  DicomHeader header;
  header.file = path;
  header.series_uid = text_of(file, kSeriesUid);
  header.frame = frame_of(file);
  const auto position = numbers_of(file, kPosition, 3);
  header.position_mm = Vec3(position[0], position[1], position[2]);
  if (header.position_mm.cwiseAbs().maxCoeff() > kFarthestPlaceOfScanMm) {
    throw DataError(path, kPosition.name, fmt::format("({:.4g}, {:.4g}, {:.4g}) mm", position[0], position[1], position[2]),
                    fmt::format("a place within {} mm", kFarthestPlaceOfScanMm), "Lengths are mm");
  }
  header.bits_allocated = required_word(file, kBitsAllocated);
  if (header.bits_allocated != 8 && header.bits_allocated != 16) {
    throw DataError(path, kBitsAllocated.name, fmt::format("{}", header.bits_allocated), "8 or 16");
  }
  header.slope = numbers_of(file, kSlope, 1)[0];
  header.intercept = numbers_of(file, kIntercept, 1)[0];
  header.rescale_type = text_of(file, kRescaleType);
  header.padding = padding_of(file, required_word(file, kSigned) == 1);
  return header;
}

}  // namespace incise
