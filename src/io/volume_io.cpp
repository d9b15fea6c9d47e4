#include "io/volume_dicom.hpp"
#include "io/volume_dicom_file.hpp"
#include "io/volume_itk.hpp"
#include "io/volume_pictures.hpp"
#include "io/volume_stack.hpp"

#include <incise/core/error.hpp>
#include <incise/io/input_file.hpp>
#include <incise/io/volume_io.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace incise {
namespace {

namespace fs = std::filesystem;

enum class Fractions { Round, Refuse };

/// Converts raw values from type `In` to `Out`, exactly; rounds fractions of floats if allowed.
/// @returns whether any value was rounded.
template <class In, class Out>
bool convert_values(const fs::path& path, const RawImage& image, Fractions fractions, std::vector<Out>& out) {
  constexpr double lowest = std::numeric_limits<Out>::min();
  constexpr double highest = std::numeric_limits<Out>::max();
  bool is_rounded = false;
  for (std::size_t v = 0; v < out.size(); ++v) {
    In raw{};
    std::memcpy(&raw, image.bytes.data() + v * sizeof(In), sizeof(In));
    const auto value = static_cast<double>(raw);
    const double whole = std::is_integral_v<In> ? value : std::round(value);
    const bool is_refused =
        !(whole >= lowest && whole <= highest) || (whole != value && fractions == Fractions::Refuse);
    if (is_refused) {
      const auto columns = static_cast<std::size_t>(image.grid.size[0]);
      const auto rows = static_cast<std::size_t>(image.grid.size[1]);
      throw DataError(
          path, fmt::format("voxel ({}, {}, {})", v % columns, v / columns % rows, v / columns / rows),
          fmt::format("{:.6g}", value),
          fmt::format("a {}number in [{}, {}]", fractions == Fractions::Refuse ? "whole " : "", lowest, highest));
    }
    is_rounded = is_rounded || whole != value;
    out[v] = static_cast<Out>(whole);
  }
  return is_rounded;
}

template <class Out>
bool convert(const fs::path& path, const RawImage& image, Fractions fractions, std::vector<Out>& out) {
  out.resize(image.grid.voxel_count());
  switch (image.component) {
    case Component::U8:
      return convert_values<std::uint8_t>(path, image, fractions, out);
    case Component::I8:
      return convert_values<std::int8_t>(path, image, fractions, out);
    case Component::U16:
      return convert_values<std::uint16_t>(path, image, fractions, out);
    case Component::I16:
      return convert_values<std::int16_t>(path, image, fractions, out);
    case Component::U32:
      return convert_values<std::uint32_t>(path, image, fractions, out);
    case Component::I32:
      return convert_values<std::int32_t>(path, image, fractions, out);
    case Component::U64:
      return convert_values<std::uint64_t>(path, image, fractions, out);
    case Component::I64:
      return convert_values<std::int64_t>(path, image, fractions, out);
    case Component::F32:
      return convert_values<float>(path, image, fractions, out);
    case Component::F64:
      return convert_values<double>(path, image, fractions, out);
  }
  throw InvalidArgument("convert: expected a component type, found another value");
}

void require_exists(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) throw DataError(path, "", "no such file or folder", "a volume");
  require_file_or_folder(path);
}

/// Returns the format of a single file. @throws DataError if its name has no format of a volume.
VolumeFormat format_of_file(const fs::path& path, const std::string& expected) {
  const auto format = format_of_name(path);
  if (format && *format != VolumeFormat::PictureStack) return *format;
  if (format || looks_like_dicom(path)) {
    throw DataError(path, "", "a single slice", "the folder with all slices of the volume",
                    "Give the folder instead of the file.");
  }
  throw DataError(path, "extension", fmt::format("'{}'", path.extension().string()), expected);
}

ReadVolume read_ct_file(const fs::path& path, VolumeFormat format, Monitor& monitor) {
  monitor.progress("reading CT", 0.0);
  const RawImage image = read_itk_image(path, format);
  throw_if_cancelled(monitor, "reading CT");
  ReadVolume result;
  result.volume.grid = image.grid;
  result.diagnostics.format = format;
  result.diagnostics.slices = image.grid.size[2];
  result.diagnostics.min_step_mm = result.diagnostics.max_step_mm = image.grid.spacing_mm[2];
  for (const std::string& notice : image.notices) notify(result.diagnostics, monitor, notice);
  if (convert(path, image, Fractions::Round, result.volume.voxels)) {
    notify(result.diagnostics, monitor, "fractional Hounsfield units were rounded to whole ones");
  }
  monitor.progress("reading CT", 1.0);
  return result;
}

VolumeFormat format_of_folder(const fs::path& folder) {
  bool has_pictures = false;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    if (looks_like_dicom(entry.path())) return VolumeFormat::DicomSeries;
    has_pictures = has_pictures || format_of_name(entry.path()) == VolumeFormat::PictureStack;
  }
  if (has_pictures) return VolumeFormat::PictureStack;
  throw DataError(folder, "", "a folder without DICOM files or PNG pictures", "the slices of a CT");
}

/// Refuses settings that do not apply to the format: they show a misunderstanding.
void refuse_foreign_settings(const fs::path& path, VolumeFormat format, const CtReadSettings& settings) {
  const auto refuse = [&](const char* field, const char* belongs) {
    throw CaseError(path.string(), field, "a value", fmt::format("none for {}", to_string(format)), belongs);
  };
  if (format != VolumeFormat::PictureStack) {
    const char* belongs = "It belongs to a folder of PNG pictures; this format states its own.";
    if (settings.spacing_mm) refuse("ct.spacing_mm", belongs);
    if (settings.hu) refuse("ct.hu", belongs);
    if (settings.first_picture_is_head) refuse("ct.first_picture_is_head", belongs);
  }
  if (format != VolumeFormat::DicomSeries && !settings.series_uid.empty()) {
    refuse("ct.series_uid", "It belongs to a folder of DICOM slices.");
  }
}

/// Refuses needle-shaped voxels: smoothing and meshing assume one length for all directions.
void require_compact_voxels(const fs::path& path, const Vec3& spacing_mm) {
  if (spacing_mm.maxCoeff() <= kLongestVoxel * spacing_mm.minCoeff()) return;
  throw DataError(path, "spacing",
                  fmt::format("voxels of {:.4g} x {:.4g} x {:.4g} mm", spacing_mm[0], spacing_mm[1], spacing_mm[2]),
                  fmt::format("a longest side of at most {} times the shortest", kLongestVoxel), "Lengths are mm");
}

ReadVolume read_any_ct(const fs::path& path, const CtReadSettings& settings, Monitor& monitor) {
  require_exists(path);
  const VolumeFormat format =
      fs::is_directory(path)
          ? format_of_folder(path)
          : format_of_file(path, fmt::format("{}, or a folder of DICOM or PNG slices", kLabelFormats));
  refuse_foreign_settings(path, format, settings);
  if (format == VolumeFormat::DicomSeries) return read_dicom_folder(path, settings, monitor);
  if (format == VolumeFormat::PictureStack) return read_picture_folder(path, settings, monitor);
  return read_ct_file(path, format, monitor);
}

}  // namespace

ReadVolume read_ct(const fs::path& path, const CtReadSettings& settings, Monitor& monitor) {
  ReadVolume result = read_any_ct(path, settings, monitor);
  require_compact_voxels(path, result.volume.grid.spacing_mm);
  return result;
}

LabelVolume read_labels(const fs::path& path) {
  require_exists(path);
  if (fs::is_directory(path)) throw DataError(path, "", "a folder", fmt::format("a file of labels: {}", kLabelFormats));
  const RawImage image = read_itk_image(path, format_of_file(path, kLabelFormats));
  LabelVolume labels;
  require_compact_voxels(path, image.grid.spacing_mm);
  labels.grid = image.grid;
  convert(path, image, Fractions::Refuse, labels.voxels);
  return labels;
}

GrayVolume read_gray(const fs::path& path) {
  require_exists(path);
  const RawImage image = read_itk_image(path, format_of_file(path, kLabelFormats));
  if (image.component != Component::F32) throw DataError(path, "voxels", "another type", "32-bit floats");
  GrayVolume volume;
  volume.grid = image.grid;
  volume.voxels.resize(image.grid.voxel_count());
  std::memcpy(volume.voxels.data(), image.bytes.data(), volume.voxels.size() * sizeof(float));
  const auto bad = std::find_if(volume.voxels.begin(), volume.voxels.end(), [](float v) { return !std::isfinite(v); });
  if (bad != volume.voxels.end()) {
    throw DataError(path, fmt::format("voxel {}", bad - volume.voxels.begin()), fmt::format("{}", *bad), "a finite number");
  }
  return volume;
}

void write_gray(const fs::path& path, const GrayVolume& volume) {
  require_writable_grid(volume.grid, volume.voxels.size());
  write_itk_image(path, volume.grid, Component::F32, volume.voxels.data());
}

void write_ct(const fs::path& path, const CtVolume& volume) {
  require_writable_grid(volume.grid, volume.voxels.size());
  write_itk_image(path, volume.grid, Component::I16, volume.voxels.data());
}

void require_volume_name(const fs::path& path) { static_cast<void>(format_to_write(path)); }

void write_labels(const fs::path& path, const LabelVolume& labels) {
  require_writable_grid(labels.grid, labels.voxels.size());
  write_itk_image(path, labels.grid, Component::U8, labels.voxels.data());
}

}  // namespace incise
