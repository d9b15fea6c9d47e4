#pragma once

#include "io/volume_stack.hpp"

#include <incise/io/volume_io.hpp>

#include <filesystem>
#include <optional>
#include <string>

namespace incise {

/// The header of one DICOM file, checked to be of a plain CT slice.
struct DicomHeader {
  std::filesystem::path file;
  std::string series_uid;
  SliceFrame frame;
  Vec3 position_mm = Vec3::Zero();
  int bits_allocated = 16;  ///< 8 or 16
  double slope = 1;
  double intercept = 0;  ///< HU
  std::string rescale_type;
  std::optional<std::pair<int, int>> padding;  ///< first and last stored value that mark pixels outside the picture
};

/// The series that a file belongs to, read without checking the content.
struct DicomIdentity {
  std::filesystem::path file;
  std::string series_uid;
  std::string series_description;
  std::string modality;
  bool has_picture = false;
};

/// Reads which series a file belongs to. @throws DataError if it cannot be parsed, or is a CT slice without pixels.
[[nodiscard]] DicomIdentity read_dicom_identity(const std::filesystem::path& file);

/// Reads the header of one slice.
/// @throws DataError unless it is a gray CT slice with position, orientation, spacing and rescale.
[[nodiscard]] DicomHeader read_dicom_header(const std::filesystem::path& file);

/// Reads the series of a folder. @throws as read_ct
[[nodiscard]] ReadVolume read_dicom_folder(const std::filesystem::path& folder, const CtReadSettings& settings,
                                           Monitor& monitor);

}  // namespace incise
