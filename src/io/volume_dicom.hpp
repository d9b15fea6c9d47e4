#pragma once

#include "io/volume_stack.hpp"

#include <incise/io/volume_io.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise {

/// What one DICOM file says about its slice, checked for being a plain CT slice.
struct DicomHeader {
  std::filesystem::path file;
  std::string series_uid;
  std::string series_description;
  SliceFrame frame;
  Vec3 position_mm = Vec3::Zero();
  int bits_allocated = 16;  ///< 8 or 16
  double slope = 1;
  double intercept = 0;  ///< HU
  std::string rescale_type;
  std::optional<std::pair<int, int>> padding;  ///< stored values from … to that stand for "no picture here"
};

/// The series that a file belongs to, read without judging what is in it.
struct DicomIdentity {
  std::filesystem::path file;
  std::string series_uid;
  std::string series_description;
  std::string modality;
  bool has_picture = false;
};

/// @throws DataError if the file cannot be parsed.
[[nodiscard]] DicomIdentity read_dicom_identity(const std::filesystem::path& file);

/// @throws DataError unless this is one gray CT slice with position, orientation, spacing and rescale.
[[nodiscard]] DicomHeader read_dicom_header(const std::filesystem::path& file);

/// Reads the series of a folder. @throws as read_ct
[[nodiscard]] ReadVolume read_dicom_folder(const std::filesystem::path& folder, const CtReadSettings& settings,
                                           Monitor& monitor);

}  // namespace incise
