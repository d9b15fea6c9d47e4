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

/// What to do with slices that are tilted or shifted sideways, or that lie at uneven steps.
enum class IrregularSlices {
  Resample,  ///< linear interpolation onto an orthogonal grid, reported as a notice
  Refuse,    ///< DataError
};
inline constexpr std::array<std::string_view, 2> kIrregularSlicesNames{"resample", "refuse"};
[[nodiscard]] constexpr Names names_of(IrregularSlices) {
  return kIrregularSlicesNames;
}

/// What to do with a hole in an otherwise regular series, where the tissue is unknown.
enum class MissingSlices {
  Refuse,       ///< DataError naming the hole
  Interpolate,  ///< treated like uneven spacing, with a notice that names the hole
};
inline constexpr std::array<std::string_view, 2> kMissingSlicesNames{"refuse", "interpolate"};
[[nodiscard]] constexpr Names names_of(MissingSlices) {
  return kMissingSlicesNames;
}

enum class VolumeFormat { DicomSeries, Nrrd, Nifti, MetaImage, PictureStack };
/// Names of the formats for messages.
inline constexpr std::array<std::string_view, 5> kVolumeFormatNames{"DICOM series", "NRRD", "NIfTI", "MetaImage",
                                                                    "PNG pictures"};
[[nodiscard]] constexpr Names names_of(VolumeFormat) {
  return kVolumeFormatNames;
}

/// Conversion of gray levels to Hounsfield units: HU = slope * gray + intercept.
struct GrayToHu {
  double slope = 1.0;
  double intercept = 0.0;  ///< HU
};

struct CtReadSettings {
  std::string series_uid{};  ///< DICOM: which SeriesInstanceUID to read; needed only where a folder holds several
  IrregularSlices irregular = IrregularSlices::Resample;
  MissingSlices missing = MissingSlices::Refuse;
  // Pictures only, and required for them: they carry no geometry and no Hounsfield units.
  std::optional<Vec3> spacing_mm{};  ///< column, row and slice spacing, > 0
  std::optional<GrayToHu> hu{};
  bool first_picture_is_head = false;  ///< pictures numbered from head to foot instead of from foot to head
};

inline void describe(Visitor& v, CtReadSettings& s) {
  v("series_uid", s.series_uid, "DICOM: which series to read if the folder contains several.");
  v("irregular_slices", s.irregular, "What to do with a tilted or unevenly spaced series.");
  v("missing_slices", s.missing, "What to do with missing slices in a series.");
  v({"spacing_mm", "PNG slices only: column, row and slice spacing.", "mm"}, s.spacing_mm, kPositive);
  std::optional<std::array<double, 2>> hu;
  if (s.hu) hu = {s.hu->slope, s.hu->intercept};
  v({"hu", "PNG slices only: [slope, intercept] with HU = slope * gray + intercept.", "HU"}, hu);
  if (v.sets()) s.hu = hu ? std::optional(GrayToHu{(*hu)[0], (*hu)[1]}) : std::nullopt;
  v.internal("first_picture_is_head", s.first_picture_is_head, "Whether pictures are numbered from head to foot.");
}

/// Findings of read_ct. `notices` are the sentences that the monitor received.
struct CtReadDiagnostics {
  VolumeFormat format = VolumeFormat::DicomSeries;
  int slices = 0;              ///< in the input, before any resampling
  std::string series_uid;      ///< DICOM only
  double gantry_tilt_deg = 0;  ///< angle between the stacking direction and the slices' normal
  double min_step_mm = 0;      ///< smallest and largest distance between neighbouring slices along their normal
  double max_step_mm = 0;
  int missing_slices = 0;          ///< interpolated on request; otherwise a series with holes is refused
  bool is_resampled = false;       ///< voxels were interpolated, because of tilt, uneven steps or a hole
  std::size_t padding_voxels = 0;  ///< outside the scanner's field of view according to the file; set to air
  std::vector<std::string> notices;
};

struct ReadVolume {
  CtVolume volume;
  CtReadDiagnostics diagnostics;
};

/// Reads a CT as Hounsfield units on a regular grid, mm, LPS, from a folder of DICOM slices, .nrrd/.nhdr, .nii/.nii.gz,
/// .mhd/.mha, or a folder of gray PNG pictures (8 or 16 bits).
///
/// DICOM: slices are sorted by ImagePositionPatient along their common normal, row x column direction, along which k
/// grows. Spacing comes from the positions, never from SliceThickness; rescale is applied per file, and padding becomes
/// air. Tilt and uneven steps are judged by the positions: a slice may be off by at most 0.1 mm sideways and, along the
/// normal, by the larger of 0.05 mm and 2 % of a step. Otherwise the series is resampled or refused. The resampled grid
/// keeps the slices' rows, columns and normal, spans every slice, and is air where a slice does not reach. Its step is
/// the larger of the finest slice step and the smaller pixel spacing, shortened to divide the height evenly. If all
/// steps are whole multiples of the median step and at most a quarter are longer, the longer ones are missing slices.
///
/// Pictures: sorted by the number in their names; columns run to +x, rows to +y (posterior), slices to +z (head);
/// origin 0. Fractional values are rounded to whole HU, with a notice.
///
/// @throws DataError if the input is missing, damaged, not CT, in colour, a single slice, ambiguous (several series),
///         in an encoding that cannot be decoded, has values that are not finite or beyond 16 bits, or voxels outside
///         0.0001 to 100 mm or more than 50 times as long as wide.
/// @throws CaseError if pictures come without `spacing_mm` or `hu`, or if a setting belongs to another format.
/// @throws Cancelled if the monitor asks to stop.
[[nodiscard]] ReadVolume read_ct(const std::filesystem::path& path, const CtReadSettings& settings, Monitor& monitor);

/// Reads labels, integers in [0, 255], from .nrrd/.nhdr, .nii/.nii.gz or .mhd/.mha; mm, LPS.
/// @throws DataError as read_ct, or naming the first voxel that holds no such integer.
[[nodiscard]] LabelVolume read_labels(const std::filesystem::path& path);
/// Endings of read_labels' formats, for messages.
inline constexpr const char* kLabelFormats = ".nrrd, .nhdr, .nii, .nii.gz, .mhd or .mha";

/// Writes .nrrd, .nhdr (with its .raw.gz beside it), .nii, .nii.gz, .mhd (with its .zraw beside it) or .mha, all or
/// nothing. Voxels are kept exactly; geometry in double precision, except in NIfTI, whose single precision keeps about
/// 1e-5 mm.
/// @throws DataError if the extension is not a format of read_labels, or if the file cannot be written.
/// @throws InvalidArgument if the volume is empty or its grid is not finite, positive and orthonormal.
void write_ct(const std::filesystem::path& path, const CtVolume& volume);
void write_labels(const std::filesystem::path& path, const LabelVolume& labels);
/// Checks the extension of a volume's name before a long computation. @throws DataError as write_ct.
void require_volume_name(const std::filesystem::path& path);

/// Reads and writes gray values of any meaning as 32-bit floats, exactly, in the same formats. @throws as read_labels
/// and write_ct; read_gray also throws DataError for a non-finite value or for voxels that are not 32-bit floats.
[[nodiscard]] GrayVolume read_gray(const std::filesystem::path& path);
void write_gray(const std::filesystem::path& path, const GrayVolume& volume);

/// Texts of a DICOM series. Names are `Family^Given`; every text is UTF-8 of at most 64 bytes.
struct DicomTags {
  std::string patient_name = "Virtual^Specimen";
  std::string patient_id = "VIRTUAL";
  std::string study_description = "Virtual specimen";
  std::string series_description = "Synthetic CT";
  std::string manufacturer = "incise";
};

/// Writes a folder of CT Image Storage files IM0001.dcm, … (one per slice, 16 bits, uncompressed, explicit little
/// endian), all or nothing. Does not replace an existing series. Every UID follows from the voxels, the grid and the
/// tags, and no date is written: the same volume gives the same bytes.
/// @throws DataError if the folder holds other files or cannot be written, or if the values span more than 16 bits can
///         hold with intercept -1024.
/// @throws InvalidArgument as write_ct, if there are more than 65535 rows or columns, or if a text is too long or holds
///         a backslash or a control character.
void write_dicom_series(const std::filesystem::path& folder, const CtVolume& volume, const DicomTags& tags = {});

}  // namespace incise
