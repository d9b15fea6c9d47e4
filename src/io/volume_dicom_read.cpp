#include "io/child_process.hpp"
#include "io/volume_dicom.hpp"
#include "io/volume_dicom_file.hpp"
#include "io/volume_quiet.hpp"

#include <incise/core/error.hpp>
#include <incise/io/input_file.hpp>

#include <fmt/format.h>
#include <gdcmPixmapReader.h>
#include <gdcmUIDs.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <sstream>
#include <string_view>

namespace incise {
namespace {

namespace fs = std::filesystem;

std::string name_of(const fs::path& file) {
  return file.filename().string();
}

struct FolderContent {
  std::map<std::string, std::vector<DicomIdentity>> series;  ///< pictures, by SeriesInstanceUID
  int other_files = 0;                                       ///< not DICOM, or DICOM without a picture
};

FolderContent scan_folder(const fs::path& folder, Monitor& monitor) {
  const std::vector<fs::path> files = input_files(folder);
  FolderContent content;
  for (std::size_t f = 0; f < files.size(); ++f) {
    throw_if_cancelled(monitor, "reading CT");
    monitor.progress("reading CT", 0.2 * static_cast<double>(f) / static_cast<double>(files.size()));
    if (!looks_like_dicom(files[f])) {
      ++content.other_files;
      continue;
    }
    DicomIdentity identity = read_dicom_identity(files[f]);
    if (identity.has_picture) {
      content.series[identity.series_uid].push_back(std::move(identity));
    } else {
      ++content.other_files;
    }
  }
  return content;
}

std::string list_series(const FolderContent& content) {
  std::string list;
  for (const auto& [uid, files] : content.series) {
    list += fmt::format("{}{} ('{}', {}, {} files)", list.empty() ? "" : "; ", uid.empty() ? "(no UID)" : uid,
                        files.front().series_description, files.front().modality, files.size());
  }
  return list;
}

const std::vector<DicomIdentity>& choose_series(const fs::path& folder, const FolderContent& content,
                                                const std::string& wanted) {
  if (content.series.empty()) throw DataError(folder, "", "no DICOM picture", "a series of CT slices");
  if (!wanted.empty()) {
    const auto found = content.series.find(wanted);
    if (found != content.series.end()) return found->second;
    throw DataError(folder, "SeriesInstanceUID", list_series(content), wanted);
  }
  if (content.series.size() > 1) {
    throw DataError(folder, "SeriesInstanceUID",
                    fmt::format("{} series: {}", content.series.size(), list_series(content)), "one series",
                    "Name one as series_uid.");
  }
  return content.series.begin()->second;
}

/// Checks that two slices have the same size, pixel spacing and orientation.
void require_same_frame(const DicomHeader& first, const DicomHeader& other) {
  const SliceFrame& a = first.frame;
  const SliceFrame& b = other.frame;
  if (a.columns != b.columns || a.rows != b.rows) {
    throw DataError(other.file, "Rows, Columns", fmt::format("{} x {}", b.rows, b.columns),
                    fmt::format("{} x {} as in '{}'", a.rows, a.columns, name_of(first.file)));
  }
  constexpr double same_mm = 1e-4;  // over 512 pixels 0.05 mm
  if (std::abs(a.row_spacing_mm - b.row_spacing_mm) > same_mm ||
      std::abs(a.column_spacing_mm - b.column_spacing_mm) > same_mm) {
    throw DataError(other.file, "PixelSpacing", fmt::format("{} x {} mm", b.row_spacing_mm, b.column_spacing_mm),
                    fmt::format("{} x {} mm as in '{}'", a.row_spacing_mm, a.column_spacing_mm, name_of(first.file)));
  }
  constexpr double same_axis = 1e-3;  // over a slice of 250 mm a quarter of a millimetre
  if ((a.row_axis - b.row_axis).norm() > same_axis || (a.column_axis - b.column_axis).norm() > same_axis) {
    throw DataError(other.file, "ImageOrientationPatient", "another orientation",
                    fmt::format("that of '{}'", name_of(first.file)), "Are a scout view and slices in one series?");
  }
}

/// "1.2.840.10008.1.2.4.90 (JPEG 2000 Image Compression (Lossless Only))"
std::string transfer_syntax_words(const DicomFile& file) {
  gdcm::UIDs known;
  if (!known.SetFromUID(file.transfer_syntax().c_str())) return file.transfer_syntax();
  return fmt::format("{} ({})", file.transfer_syntax(), known.GetName());
}

bool is_compressed(const std::string& transfer_syntax) {
  return transfer_syntax != "1.2.840.10008.1.2" && transfer_syntax != "1.2.840.10008.1.2.1";
}

void require_whole_pixels(const DicomHeader& header, const DicomFile& file) {
  const std::size_t needed =
      static_cast<std::size_t>(header.frame.columns) * header.frame.rows * (header.bits_allocated / 8U);
  const auto native = file.native_pixel_bytes();
  if (native && *native < needed) {
    throw DataError(header.file, "PixelData", fmt::format("{} bytes", *native), fmt::format("{} bytes", needed),
                    "Is the file cut short?");
  }
}

/// The format of a slice's pixels as GDCM decodes them; the pixels follow it in the answer of decode_pixels.
struct DecodedPixels {
  std::uint16_t allocated_bits = 0, stored_bits = 0, high_bit = 0, is_signed = 0;
};

/// Decodes a slice with GDCM, in a child process. Empty: GDCM could not decode it.
std::string decode_pixels(const DicomFile& file) {
  const QuietImageLibraries quiet;
  std::istringstream stream(file.up_to_pixels());
  gdcm::PixmapReader reader;
  reader.SetStream(stream);
  try {
    if (!reader.Read()) return {};
    const gdcm::Pixmap& picture = reader.GetPixmap();
    const gdcm::PixelFormat format = picture.GetPixelFormat();
    const DecodedPixels decoded{format.GetBitsAllocated(), format.GetBitsStored(), format.GetHighBit(), format.GetPixelRepresentation()};
    std::string answer(reinterpret_cast<const char*>(&decoded), sizeof decoded);
    const std::size_t begin = answer.size();
    if (picture.GetBufferLength() == 0) return {};
    answer.resize(begin + picture.GetBufferLength());
    return picture.GetBuffer(answer.data() + begin) ? answer : std::string();
  } catch (const std::exception&) {
    return {};  // stored_values reports it
  }
}

/// Returns the stored values of one slice, before rescale, without the bits above BitsStored.
std::vector<int> stored_values(const DicomHeader& header) {
  const DicomFile file(header.file);
  require_whole_pixels(header, file);
  const std::size_t pixels = static_cast<std::size_t>(header.frame.columns) * header.frame.rows;
  const io_detail::ChildLimits limits{(512ULL << 20) + 32 * pixels, 60};
  const std::string answer = io_detail::in_child_process(header.file, "DICOM", limits, [&] { return decode_pixels(file); });
  // GDCM would misread native pixels that the file declares compressed.
  if (answer.size() < sizeof(DecodedPixels) || file.native_pixel_bytes().has_value() == is_compressed(file.transfer_syntax())) {
    throw DataError(header.file, "PixelData",
                    fmt::format("pixels that cannot be decoded, in transfer syntax {}", transfer_syntax_words(file)),
                    "a whole picture in a known encoding", "Is the file damaged? Otherwise try 'gdcmconv --raw'.");
  }
  DecodedPixels format;
  std::memcpy(&format, answer.data(), sizeof format);
  const std::string_view bytes = std::string_view(answer).substr(sizeof format);
  const std::size_t size = format.allocated_bits / 8U;
  if ((size != 1 && size != 2) || format.stored_bits < 1 || format.stored_bits > 16 || format.high_bit + 1 != format.stored_bits ||
      bytes.size() != pixels * size) {
    throw DataError(header.file, "PixelData",
                    fmt::format("{} bytes, {} of {} bits", bytes.size(), format.stored_bits, format.allocated_bits),
                    fmt::format("{} pixels of 8 or 16 bits", pixels));
  }
  const int mask = static_cast<int>((1U << format.stored_bits) - 1U);
  const int sign_bit = format.is_signed == 1 ? 1 << (format.stored_bits - 1U) : 0;
  std::vector<int> values(pixels);
  for (std::size_t p = 0; p < pixels; ++p) {
    std::uint16_t word = 0;
    std::memcpy(&word, bytes.data() + p * size, size);
    const int value = word & mask;
    values[p] = (value & sign_bit) != 0 ? value - 2 * sign_bit : value;
  }
  return values;
}

/// Writes the slice's Hounsfield units to `out`. @returns the number of padding pixels, which become air.
std::size_t to_hounsfield(const DicomHeader& header, const std::vector<int>& stored, std::int16_t* out) {
  std::size_t padding = 0;
  for (std::size_t p = 0; p < stored.size(); ++p) {
    if (header.padding && stored[p] >= header.padding->first && stored[p] <= header.padding->second) {
      out[p] = kAirHu;
      ++padding;
      continue;
    }
    const double hu = header.slope * stored[p] + header.intercept;
    if (hu < -32768.0 || hu > 32767.0) {
      const std::size_t columns = static_cast<std::size_t>(header.frame.columns);
      throw DataError(header.file, fmt::format("pixel ({}, {})", p % columns, p / columns),
                      fmt::format("{:.6g} HU", hu), "a value of 16 bits");
    }
    out[p] = static_cast<std::int16_t>(std::lround(hu));
  }
  return padding;
}

void tell_oddities(const std::vector<DicomHeader>& headers, int other_files, CtReadDiagnostics& diagnostics,
                   Monitor& monitor) {
  if (other_files > 0)
    notify(diagnostics, monitor,
           fmt::format("files of the folder that are no DICOM pictures and were passed over: {}", other_files));
  if (const std::string& type = headers.front().rescale_type; !type.empty() && type != "HU") {
    notify(diagnostics, monitor,
           fmt::format("the series calls its values '{}'; they are taken as Hounsfield units", type));
  }
  const auto has_fraction = [](const DicomHeader& h) {
    return h.slope != std::round(h.slope) || h.intercept != std::round(h.intercept);
  };
  if (std::any_of(headers.begin(), headers.end(), has_fraction)) {
    notify(diagnostics, monitor, "fractional Hounsfield units were rounded to whole ones");
  }
}

}  // namespace

ReadVolume read_dicom_folder(const fs::path& folder, const CtReadSettings& settings, Monitor& monitor) {
  const FolderContent content = scan_folder(folder, monitor);
  const auto& files = choose_series(folder, content, settings.series_uid);

  std::vector<DicomHeader> headers;
  std::vector<SlicePlace> places;
  for (const DicomIdentity& identity : files) {
    headers.push_back(read_dicom_header(identity.file));
    require_same_frame(headers.front(), headers.back());
    places.push_back({name_of(identity.file), headers.back().position_mm});
  }
  const SliceFrame& frame = headers.front().frame;
  const StackLayout layout = lay_out_stack(folder, frame, places);
  judge_stack(folder, layout, settings);

  ReadVolume result;
  result.diagnostics.format = VolumeFormat::DicomSeries;
  result.diagnostics.series_uid = headers.front().series_uid;
  tell_oddities(headers, content.other_files, result.diagnostics, monitor);
  const std::size_t slice_pixels = static_cast<std::size_t>(frame.columns) * frame.rows;
  std::vector<std::int16_t> hu(slice_pixels * headers.size());
  for (std::size_t k = 0; k < headers.size(); ++k) {
    throw_if_cancelled(monitor, "reading CT");
    monitor.progress("reading CT", 0.2 + 0.8 * static_cast<double>(k) / static_cast<double>(headers.size()));
    const DicomHeader& header = headers[layout.order[k]];
    result.diagnostics.padding_voxels += to_hounsfield(header, stored_values(header), hu.data() + k * slice_pixels);
  }
  monitor.progress("reading CT", 1.0);
  result.volume = assemble_stack(folder, frame, layout, std::move(hu), result.diagnostics, monitor);
  return result;
}

}  // namespace incise
