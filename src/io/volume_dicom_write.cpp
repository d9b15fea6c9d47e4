#include "io/volume_itk.hpp"
#include "io/volume_quiet.hpp"

#include <incise/core/error.hpp>
#include <incise/core/image_library_turn.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/volume_io.hpp>

#include <fmt/format.h>
#include <gdcmDataSet.h>
#include <gdcmWriter.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>

namespace incise {
namespace {

namespace fs = std::filesystem;
using gdcm::Tag;
using gdcm::VR;

constexpr int kWrittenIntercept = -1024;  // HU of stored value 0
const char* const kWrittenStorage = "1.2.840.10008.5.1.4.1.1.2";

/// Returns a UID made from a text: "2.25." and 128 bits of its SHA-256, marked as a UUID made from a name.
std::string uid_from(const std::string& text) {
  const std::string digits = sha256_of_text(text);
  std::array<unsigned, 16> bytes{};
  for (std::size_t b = 0; b < bytes.size(); ++b) {
    std::from_chars(digits.data() + 2 * b, digits.data() + 2 * b + 2, bytes[b], 16);
  }
  bytes[6] = (bytes[6] & 0x0fU) | 0x50U;
  bytes[8] = (bytes[8] & 0x3fU) | 0x80U;
  // Long division by ten: a UID holds the 128 bits as one decimal number.
  std::string reversed;
  while (std::any_of(bytes.begin(), bytes.end(), [](unsigned b) { return b != 0; })) {
    unsigned rest = 0;
    for (unsigned& byte : bytes) {
      const unsigned value = rest * 256U + byte;
      byte = value / 10U;
      rest = value % 10U;
    }
    reversed += static_cast<char>('0' + rest);
  }
  return "2.25." + std::string(reversed.rbegin(), reversed.rend());
}

std::string digest_of(const std::vector<std::int16_t>& voxels) {
  return sha256_of_text({reinterpret_cast<const char*>(voxels.data()), voxels.size() * sizeof(std::int16_t)});
}

/// Returns a decimal string of DICOM, with as many digits as fit into its 16 characters.
std::string decimal_string(double value) {
  for (int digits = 15; digits > 0; --digits) {
    const std::string text = fmt::format("{:.{}g}", value, digits);
    if (text.size() <= 16) return text;
  }
  throw InvalidArgument(fmt::format("decimal_string: expected a number of 16 characters, found {}", value));
}

std::string decimal_strings(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) text += fmt::format("{}{}", text.empty() ? "" : "\\", decimal_string(value));
  return text;
}

void set_bytes(gdcm::DataSet& data, const Tag& tag, VR::VRType vr, const void* bytes, std::size_t size) {
  gdcm::DataElement element(tag);
  element.SetVR(vr);
  element.SetByteValue(static_cast<const char*>(bytes), static_cast<std::uint32_t>(size));
  data.Replace(element);
}

void set_text(gdcm::DataSet& data, const Tag& tag, VR::VRType vr, std::string text) {
  if (text.size() % 2 != 0) text += vr == VR::UI ? '\0' : ' ';  // values have even length
  set_bytes(data, tag, vr, text.data(), text.size());
}

void set_word(gdcm::DataSet& data, const Tag& tag, unsigned value) {
  const auto word = static_cast<std::uint16_t>(value);
  set_bytes(data, tag, VR::US, &word, sizeof word);
}

void require_plain_text(const std::string& text) {
  const bool is_plain =
      std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f || c == '\\'; });
  INCISE_REQUIRE(text.size() <= 64 && is_plain,
                 fmt::format("expected a DICOM text of at most 64 bytes without backslash, found '{}'", text));
}

/// The data that every file of the series shares.
struct Series {
  std::string study_uid;
  std::string series_uid;
  std::string frame_uid;
  bool is_signed = false;
};

Series plan_series(const fs::path& folder, const CtVolume& volume, const DicomTags& tags) {
  const auto [low, high] = std::minmax_element(volume.voxels.begin(), volume.voxels.end());
  Series series;
  series.is_signed = *low < kWrittenIntercept;
  if (series.is_signed && *high > 32767 + kWrittenIntercept) {
    throw DataError(folder, "PixelData", fmt::format("{} to {} HU", *low, *high),
                    "a range that 16 bits hold with intercept -1024");
  }
  const VolumeGrid& grid = volume.grid;
  std::string key = digest_of(volume.voxels);
  for (const int size : grid.size) key += fmt::format("|{}", size);
  for (int axis = 0; axis < 3; ++axis) key += fmt::format("|{}|{}", grid.spacing_mm[axis], grid.origin_mm[axis]);
  for (const double cosine : grid.direction.reshaped()) key += fmt::format("|{}", cosine);
  for (const std::string& text :
       {tags.patient_name, tags.patient_id, tags.study_description, tags.series_description, tags.manufacturer}) {
    require_plain_text(text);
    key += fmt::format("|{}", text);
  }
  series.study_uid = uid_from("study|" + key);
  series.series_uid = uid_from("series|" + key);
  series.frame_uid = uid_from("frame of reference|" + key);
  return series;
}

void describe_study(gdcm::DataSet& data, const Series& series, const DicomTags& tags) {
  set_text(data, Tag(0x0008, 0x0005), VR::CS, "ISO_IR 192");
  set_text(data, Tag(0x0008, 0x0008), VR::CS, "DERIVED\\PRIMARY\\AXIAL");
  set_text(data, Tag(0x0008, 0x0016), VR::UI, kWrittenStorage);
  set_text(data, Tag(0x0008, 0x0060), VR::CS, "CT");
  set_text(data, Tag(0x0008, 0x0070), VR::LO, tags.manufacturer);
  set_text(data, Tag(0x0008, 0x1030), VR::LO, tags.study_description);
  set_text(data, Tag(0x0008, 0x103e), VR::LO, tags.series_description);
  set_text(data, Tag(0x0010, 0x0010), VR::PN, tags.patient_name);
  set_text(data, Tag(0x0010, 0x0020), VR::LO, tags.patient_id);
  set_text(data, Tag(0x0018, 0x5100), VR::CS, "HFS");
  set_text(data, Tag(0x0020, 0x000d), VR::UI, series.study_uid);
  set_text(data, Tag(0x0020, 0x000e), VR::UI, series.series_uid);
  set_text(data, Tag(0x0020, 0x0010), VR::SH, "1");
  set_text(data, Tag(0x0020, 0x0011), VR::IS, "1");
  set_text(data, Tag(0x0020, 0x0052), VR::UI, series.frame_uid);
  // These elements must exist but may be empty: dates, times, names and settings that a virtual scan does not have.
  const auto leave_empty = [&data](std::uint16_t group,
                                   std::initializer_list<std::pair<std::uint16_t, VR::VRType>> elements) {
    for (const auto& [element, vr] : elements) set_text(data, Tag(group, element), vr, "");
  };
  leave_empty(0x0008, {{0x0020, VR::DA}, {0x0030, VR::TM}, {0x0050, VR::SH}, {0x0090, VR::PN}});
  leave_empty(0x0010, {{0x0030, VR::DA}, {0x0040, VR::CS}});
  leave_empty(0x0018, {{0x0060, VR::DS}});
  leave_empty(0x0020, {{0x0012, VR::IS}, {0x1040, VR::LO}});
}

void describe_slice(gdcm::DataSet& data, const Series& series, const VolumeGrid& grid, int k) {
  const Vec3 position = grid.world_from_index(Vec3(0, 0, k));
  const Vec3 row = grid.direction.col(0);
  const Vec3 column = grid.direction.col(1);
  set_text(data, Tag(0x0008, 0x0018), VR::UI, uid_from(fmt::format("{}|slice {}", series.series_uid, k)));
  set_text(data, Tag(0x0018, 0x0050), VR::DS, decimal_string(grid.spacing_mm[2]));
  set_text(data, Tag(0x0020, 0x0013), VR::IS, fmt::format("{}", k + 1));
  set_text(data, Tag(0x0020, 0x0032), VR::DS, decimal_strings({position[0], position[1], position[2]}));
  set_text(data, Tag(0x0020, 0x0037), VR::DS,
           decimal_strings({row[0], row[1], row[2], column[0], column[1], column[2]}));
  // Distance between rows first, then between columns.
  set_text(data, Tag(0x0028, 0x0030), VR::DS, decimal_strings({grid.spacing_mm[1], grid.spacing_mm[0]}));
  set_text(data, Tag(0x0028, 0x0004), VR::CS, "MONOCHROME2");
  set_text(data, Tag(0x0028, 0x1052), VR::DS, fmt::format("{}", kWrittenIntercept));
  set_text(data, Tag(0x0028, 0x1053), VR::DS, "1");
  set_text(data, Tag(0x0028, 0x1054), VR::LO, "HU");
  set_word(data, Tag(0x0028, 0x0002), 1);
  set_word(data, Tag(0x0028, 0x0010), static_cast<unsigned>(grid.size[1]));
  set_word(data, Tag(0x0028, 0x0011), static_cast<unsigned>(grid.size[0]));
  set_word(data, Tag(0x0028, 0x0100), 16);
  set_word(data, Tag(0x0028, 0x0101), 16);
  set_word(data, Tag(0x0028, 0x0102), 15);
  set_word(data, Tag(0x0028, 0x0103), series.is_signed ? 1 : 0);
}

void set_pixels(gdcm::DataSet& data, const CtVolume& volume, int k) {
  const std::size_t pixels = static_cast<std::size_t>(volume.grid.size[0]) * volume.grid.size[1];
  std::vector<std::uint16_t> stored(pixels);
  const std::int16_t* hu = volume.voxels.data() + pixels * static_cast<std::size_t>(k);
  std::transform(hu, hu + pixels, stored.begin(),
                 [](std::int16_t value) { return static_cast<std::uint16_t>(value - kWrittenIntercept); });
  set_bytes(data, Tag(0x7fe0, 0x0010), VR::OW, stored.data(), pixels * sizeof(std::uint16_t));
}

}  // namespace

void write_dicom_series(const fs::path& folder, const CtVolume& volume, const DicomTags& tags) {
  require_writable_grid(volume.grid, volume.voxels.size());
  INCISE_REQUIRE(std::max(volume.grid.size[0], volume.grid.size[1]) <= 65535,
                 "expected at most 65535 rows and columns");
  const Series series = plan_series(folder, volume, tags);
  const ImageLibraryTurn turn;
  const QuietImageLibraries quiet;
  AtomicFolder target(folder);
  for (int k = 0; k < volume.grid.size[2]; ++k) {
    gdcm::Writer writer;
    gdcm::DataSet& data = writer.GetFile().GetDataSet();
    describe_study(data, series, tags);
    describe_slice(data, series, volume.grid, k);
    set_pixels(data, volume, k);
    writer.GetFile().GetHeader().SetDataSetTransferSyntax(gdcm::TransferSyntax::ExplicitVRLittleEndian);
    const std::string name = fmt::format("IM{:04}.dcm", k + 1);
    std::ostringstream bytes;  // in memory, because the library ends the program if the disk is full
    writer.SetStream(bytes);
    if (!writer.Write()) throw DataError(folder / name, "", "a failed write", "a complete file");
    write_atomically(target.path() / name, bytes.view());
  }
  target.commit();
}

}  // namespace incise
