#pragma once

#include <incise/core/monitor.hpp>
#include <incise/core/names.hpp>
#include <incise/geometry/volume.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise {

/// What to do with slices that do not stack straight (gantry tilt) or not at even steps.
enum class IrregularSlices {
  Resample,  ///< linear interpolation onto an orthogonal grid, reported as a notice
  Refuse,    ///< DataError
};
inline constexpr std::array<std::string_view, 2> kIrregularSlicesNames{"resample", "refuse"};
[[nodiscard]] constexpr Names names_of(IrregularSlices) {
  return kIrregularSlicesNames;
}

/// What to do with a hole in a series that is regular otherwise: what lay there is not known.
enum class MissingSlices {
  Refuse,       ///< DataError naming the hole
  Interpolate,  ///< treated like uneven spacing, with a notice that names the hole
};
inline constexpr std::array<std::string_view, 2> kMissingSlicesNames{"refuse", "interpolate"};
[[nodiscard]] constexpr Names names_of(MissingSlices) {
  return kMissingSlicesNames;
}

enum class VolumeFormat { DicomSeries, Nrrd, Nifti, MetaImage, PictureStack };
/// As they are said to people.
inline constexpr std::array<std::string_view, 5> kVolumeFormatNames{"DICOM series", "NRRD", "NIfTI", "MetaImage",
                                                                    "PNG pictures"};
[[nodiscard]] constexpr Names names_of(VolumeFormat) {
  return kVolumeFormatNames;
}

/// Gray level to Hounsfield units: HU = slope * gray + intercept.
struct GrayToHu {
  double slope = 1.0;
  double intercept = 0.0;  ///< HU
};

struct CtReadSettings {
  std::string series_uid{};  ///< DICOM: which SeriesInstanceUID to read; needed only where a folder holds several
  IrregularSlices irregular = IrregularSlices::Resample;
  MissingSlices missing = MissingSlices::Refuse;
  // Pictures only: they carry no geometry and no Hounsfield units, so these two have to be stated.
  std::optional<Vec3> spacing_mm{};  ///< column, row and slice spacing, > 0
  std::optional<GrayToHu> hu{};
  bool first_picture_is_head = false;  ///< pictures numbered from head to foot instead of from foot to head
};

inline void describe(Visitor& v, CtReadSettings& s) {
  v("series_uid", s.series_uid, "DICOM: which series to read, where a folder holds several.");
  v("irregular_slices", s.irregular, "What to do with a tilted or unevenly spaced series.");
  v("missing_slices", s.missing, "What to do with holes in a series.");
  v({"spacing_mm", "PNG slices only: column, row and slice spacing.", "mm"}, s.spacing_mm, kPositive);
  std::optional<std::array<double, 2>> hu;
  if (s.hu) hu = {s.hu->slope, s.hu->intercept};
  v({"hu", "PNG slices only: [slope, intercept] with HU = slope * gray + intercept.", "HU"}, hu);
  if (v.sets()) s.hu = hu ? std::optional(GrayToHu{(*hu)[0], (*hu)[1]}) : std::nullopt;
  v.internal("first_picture_is_head", s.first_picture_is_head, "Whether pictures are numbered from head to foot.");
}

/// What was found on the way; `notices` are the same sentences that the monitor received.
struct CtReadDiagnostics {
  VolumeFormat format = VolumeFormat::DicomSeries;
  int slices = 0;              ///< in the input, before any resampling
  std::string series_uid;      ///< DICOM only
  double gantry_tilt_deg = 0;  ///< angle between the direction of stacking and the slices' normal
  double min_step_mm = 0;      ///< smallest and largest distance of neighbouring slices along their normal
  double max_step_mm = 0;
  int missing_slices = 0;          ///< not 0 only where they were interpolated on request
  bool is_resampled = false;       ///< voxels were interpolated, because of tilt, uneven steps or a hole
  std::size_t padding_voxels = 0;  ///< marked by the scanner as outside its field of view, now air
  std::vector<std::string> notices;
};

struct ReadVolume {
  CtVolume volume;
  CtReadDiagnostics diagnostics;
};

/// Reads a CT as Hounsfield units on a regular grid in LPS millimetres, whatever form it comes in:
/// a folder of DICOM slices, .nrrd/.nhdr, .nii/.nii.gz, .mhd/.mha, or a folder of gray PNG pictures (8 or 16 bit).
///
/// DICOM: slices are sorted by ImagePositionPatient along their common normal, so that k grows along
/// row x column direction; spacing comes from the positions, never from SliceThickness; rescale is per file and padding
/// becomes air. A tilted or uneven series is found by geometry (position off by more than 0.1 mm sideways, or by 0.05
/// mm and 2 % of a step along the normal) and resampled or refused. The resampled grid keeps the slices' rows, columns
/// and normal, spans every slice, is air where a slice did not reach, and steps by the finest slice step (but not finer
/// than the pixels). Isolated steps that are whole multiples of the common one (fewer than a quarter) count as missing
/// slices. Pictures: sorted by the number in their names; columns run to +x, rows to +y (posterior), slices to +z
/// (head); origin 0. Fractional values are rounded to whole HU, with a notice.
///
/// @throws DataError if the input is missing, damaged, not CT, in colour, a single slice, ambiguous (several series),
///         in an encoding that cannot be decoded, or has values that are not finite or beyond 16 bits.
/// @throws CaseError if pictures come without `spacing_mm` or `hu`, or anything else comes with them.
/// @throws Cancelled if the monitor asks to stop.
[[nodiscard]] ReadVolume read_ct(const std::filesystem::path& path, const CtReadSettings& settings, Monitor& monitor);

/// Reads labels, integers in [0, 255], from .nrrd/.nhdr, .nii/.nii.gz or .mhd/.mha; LPS, mm.
/// @throws DataError as read_ct does, or naming the first voxel that holds no such integer.
[[nodiscard]] LabelVolume read_labels(const std::filesystem::path& path);

/// Writes .nrrd, .nii, .nii.gz, .mhd (with its .zraw beside it) or .mha, all or nothing. Voxels are kept exactly;
/// geometry to double precision, but in NIfTI to the format's single precision (about 1e-5 mm).
/// @throws DataError if the extension is none of these or the file cannot be written; nothing partial remains then.
/// @throws InvalidArgument if the volume is empty or its grid is not finite, positive and orthonormal.
void write_ct(const std::filesystem::path& path, const CtVolume& volume);
void write_labels(const std::filesystem::path& path, const LabelVolume& labels);
/// Judges a name before what is to be written is computed. @throws DataError if its extension is none of the above.
void require_volume_name(const std::filesystem::path& path);

/// Gray values of any meaning, kept exactly as 32-bit floats. The same formats, @throws as read_labels and write_ct; a value that is not
/// finite, or a file that holds anything but 32-bit floats, is refused.
[[nodiscard]] GrayVolume read_gray(const std::filesystem::path& path);
void write_gray(const std::filesystem::path& path, const GrayVolume& volume);

/// What a DICOM series says beside its picture. Names are `Family^Given`; every text is UTF-8 of at most 64 bytes.
struct DicomTags {
  std::string patient_name = "Virtual^Specimen";
  std::string patient_id = "VIRTUAL";
  std::string study_description = "Virtual specimen";
  std::string series_description = "Synthetic CT";
  std::string manufacturer = "incise";
};

/// Writes a folder of CT Image Storage files IM0001.dcm, … (one per slice, 16 bit, uncompressed, explicit little
/// endian), all or nothing; a series that is there already is left and refused. Every UID follows from the voxels, the grid and
/// the tags: the same volume gives the same bytes. No date is written.
/// @throws DataError if the folder cannot be written or the values span more than 16 bits can hold with intercept
/// -1024.
/// @throws InvalidArgument as write_ct, or if a text is too long or holds a backslash or a control character.
void write_dicom_series(const std::filesystem::path& folder, const CtVolume& volume, const DicomTags& tags = {});

}  // namespace incise
