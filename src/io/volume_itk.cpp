#include "io/volume_itk.hpp"

#include "io/child_process.hpp"
#include "io/number_text.hpp"
#include "io/volume_complete.hpp"
#include "io/volume_itk_eigen.hpp"
#include "io/volume_nrrd_header.hpp"
#include "io/volume_quiet.hpp"
#include "io/volume_stack.hpp"

#include <incise/core/described_bytes.hpp>
#include <incise/core/error.hpp>
#include <incise/core/image_library_turn.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/input_file.hpp>

#include <fmt/format.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

#include <Eigen/SVD>
#include <algorithm>
#include <fstream>
#include <limits>
#include <new>

namespace incise {
namespace {

namespace fs = std::filesystem;

// NIfTI keeps its axes in single precision, MetaImage files are often written with six digits.
constexpr double kOrthonormalTolerance = 1e-4;

itk::ImageIOBase::Pointer make_image_io(VolumeFormat format) {
  switch (format) {
    case VolumeFormat::Nrrd:
      return itk::NrrdImageIO::New().GetPointer();
    case VolumeFormat::Nifti:
      return itk::NiftiImageIO::New().GetPointer();
    case VolumeFormat::MetaImage: {
      auto io = itk::MetaImageIO::New();
      io->SetDoublePrecision(std::numeric_limits<double>::max_digits10);
      return io.GetPointer();
    }
    case VolumeFormat::PictureStack:
    case VolumeFormat::DicomSeries:
      break;
  }
  throw InvalidArgument("make_image_io: expected NRRD, NIfTI or MetaImage");
}

/// Returns the message of an exception, without the file, line and object address that ITK adds.
std::string essence(const std::exception& error) {
  std::string text = error.what();
  const auto* itk_error = dynamic_cast<const itk::ExceptionObject*>(&error);
  if (itk_error != nullptr) text = itk_error->GetDescription();
  if (const auto address = text.find("): "); text.rfind("itk::ERROR", 0) == 0 && address != std::string::npos) {
    text.erase(0, address + 3);
  }
  text = text.substr(0, text.find('\n'));
  constexpr std::size_t longest = 160;
  return text.empty() ? "no further details from the reader" : text.substr(0, longest);
}

std::optional<Component> component_of(itk::IOComponentEnum type) {
  using enum itk::CommonEnums::IOComponent;
  const bool long_is_64_bit = sizeof(long) == 8;
  switch (type) {
    case UCHAR:
      return Component::U8;
    case CHAR:
      return Component::I8;
    case USHORT:
      return Component::U16;
    case SHORT:
      return Component::I16;
    case UINT:
      return Component::U32;
    case INT:
      return Component::I32;
    case ULONG:
      return long_is_64_bit ? Component::U64 : Component::U32;
    case LONG:
      return long_is_64_bit ? Component::I64 : Component::I32;
    case ULONGLONG:
      return Component::U64;
    case LONGLONG:
      return Component::I64;
    case FLOAT:
      return Component::F32;
    case DOUBLE:
      return Component::F64;
    default:
      return std::nullopt;
  }
}

/// Returns the text header of an NRRD or MetaImage file in lower case: its first lines up to a blank one or `last_key`.
std::string text_header(const fs::path& path, const std::string& last_key) {
  std::ifstream stream(path, std::ios::binary);
  std::string header;
  constexpr int longest = 200;  // lines; more than any header needs
  std::string line;
  for (int count = 0; count < longest && std::getline(stream, line); ++count) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) break;
    header += line + '\n';
    if (!last_key.empty() && line.rfind(last_key, 0) == 0) break;
  }
  return io_detail::lower_case(header);
}

/// Refuses a header without voxel spacing, for which ITK would silently assume 1 mm.
void require_stated_geometry(const fs::path& path, VolumeFormat format, std::vector<std::string>& notices) {
  const auto says = [](const std::string& header, std::initializer_list<const char*> keys) {
    return std::any_of(keys.begin(), keys.end(), [&](const char* key) {
      return ("\n" + header).find(std::string("\n") + key) != std::string::npos;
    });
  };
  if (format == VolumeFormat::Nrrd) {
    const std::string header = text_header(path, "");
    require_stated_nrrd_geometry(path, header);
    if (!names_nrrd_space(header))
      notices.emplace_back("the NRRD names no anatomical space: its axes are taken as LPS, mm");
  }
  if (format == VolumeFormat::MetaImage &&
      !says(text_header(path, "ElementDataFile"), {"elementspacing", "elementsize"})) {
    throw DataError(path, "header", "no voxel spacing", "'ElementSpacing'");
  }
}

void require_gray_volume(const fs::path& path, const itk::ImageIOBase& io) {
  if (io.GetNumberOfComponents() != 1) {
    throw DataError(path, "pixels", fmt::format("{} values per pixel (colour or vectors)", io.GetNumberOfComponents()),
                    "gray values, one per pixel");
  }
  if (!component_of(io.GetComponentType())) {
    throw DataError(path, "pixels", itk::ImageIOBase::GetComponentTypeAsString(io.GetComponentType()),
                    "integers or floating-point numbers");
  }
  const unsigned dimensions = io.GetNumberOfDimensions();
  for (unsigned axis = 3; axis < dimensions; ++axis) {
    if (io.GetDimensions(axis) != 1) {
      throw DataError(path, "size", fmt::format("{} dimensions", dimensions), "one volume of three dimensions");
    }
  }
  if (dimensions < 3 || io.GetDimensions(2) < 2) {
    throw DataError(path, "size", "a single slice", "a volume of two slices or more");
  }
  double voxels = 1;
  for (unsigned axis = 0; axis < std::min(dimensions, 3U); ++axis) {
    if (io.GetDimensions(axis) < 1 || io.GetDimensions(axis) > 100'000) {
      throw DataError(path, "size", fmt::format("{} voxels along axis {}", io.GetDimensions(axis), axis),
                      "1 to 100000");
    }
    voxels *= static_cast<double>(io.GetDimensions(axis));
  }
  if (voxels > 4e9) throw DataError(path, "size", fmt::format("{:.2g} voxels", voxels), "at most 4e9 voxels");
}

constexpr std::uint64_t kLargestGain = 1100;               // of compression: zlib's is 1032
constexpr std::uint64_t kLibraryMemory = 1ULL << 30;       // bytes that ITK may use beside the voxels

/// Returns the total size of a volume's file and all files that its header names, bytes.
std::uint64_t total_size(const fs::path& path) {
  std::uint64_t total = 0;
  for (const fs::path& file : input_files(path)) {
    std::error_code error;
    if (!fs::exists(file, error)) continue;  // the reader says which one is missing
    if (!fs::is_regular_file(file, error)) {
      throw DataError(path, file == path ? "" : "data file",
                      file == path ? kind_of_file(file) : fmt::format("{} ('{}')", kind_of_file(file), file.string()),
                      "a file");
    }
    total += fs::file_size(file, error);
  }
  return total;
}

/// Refuses a header that claims more voxels than compression can make from the file's bytes.
void require_possible_size(const fs::path& path, std::uint64_t voxel_bytes) {
  const std::uint64_t size = total_size(path);
  if (voxel_bytes <= kLargestGain * size) return;
  throw DataError(path, "size", fmt::format("a header that claims {} bytes of voxels, and {} bytes of data", voxel_bytes, size),
                  "all voxels of the volume", "Is the file cut short?");
}

/// Checks the number of axes before ITK reads the header: ITK loops over as many axes as it states, however many.
void require_plain_meta_header(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::string line;
  constexpr int kLongest = 200;           // lines
  constexpr std::size_t kLongestLine = 4096;
  for (int count = 0; count < kLongest && std::getline(stream, line); ++count) {
    if (line.size() > kLongestLine) break;
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos) continue;
    const std::string key = io_detail::lower_case(io_detail::trimmed(std::string_view(line).substr(0, equals)));
    const std::string value(io_detail::trimmed(std::string_view(line).substr(equals + 1)));
    if (key == "ndims") {
      const auto dimensions = io_detail::to_integer(value);
      if (!dimensions || *dimensions < 2 || *dimensions > 4) throw DataError(path, "NDims", fmt::format("'{}'", value.substr(0, 40)), "3");
    }
    if (key == "elementdatafile") return;
  }
  throw DataError(path, "header", "no ElementDataFile in the first lines", "a MetaImage header");
}

/// Refuses an NRRD file without a blank line after its header, which holds no voxels, unless the header is detached.
void require_ended_nrrd_header(const fs::path& path) {
  const std::string text = beginning_of(path, 64 << 10);
  const bool is_ended = text.find("\n\n") != std::string::npos || text.find("\r\n\r\n") != std::string::npos;
  if (is_ended || input_files(path).size() > 1) return;
  throw DataError(path, "header", "no blank line after the header", "a header, a blank line and the voxels", "Is the file cut short?");
}

VolumeGrid grid_of(const fs::path& path, const itk::ImageIOBase& io) {
  VolumeGrid grid;
  grid.size = {1, 1, 1};
  const unsigned dimensions = std::min(io.GetNumberOfDimensions(), 3U);
  for (unsigned axis = 0; axis < dimensions; ++axis) {
    grid.size[axis] = static_cast<int>(io.GetDimensions(axis));
    grid.spacing_mm[axis] = io.GetSpacing(axis);
    grid.origin_mm[axis] = io.GetOrigin(axis);
    for (unsigned row = 0; row < dimensions; ++row) grid.direction(row, axis) = io.GetDirection(axis)[row];
  }
  if (!grid.spacing_mm.allFinite() || grid.spacing_mm.minCoeff() <= 0) {
    throw DataError(path, "spacing",
                    fmt::format("{} x {} x {} mm", grid.spacing_mm[0], grid.spacing_mm[1], grid.spacing_mm[2]),
                    "positive, finite lengths");
  }
  if (grid.spacing_mm.minCoeff() < kFinestVoxelMm || grid.spacing_mm.maxCoeff() > kCoarsestVoxelMm) {
    throw DataError(path, "spacing", fmt::format("{:.4g} x {:.4g} x {:.4g} mm", grid.spacing_mm[0], grid.spacing_mm[1], grid.spacing_mm[2]),
                    fmt::format("voxels of {} to {} mm", kFinestVoxelMm, kCoarsestVoxelMm), "Lengths are mm");
  }
  if (!grid.origin_mm.allFinite()) throw DataError(path, "origin", "a value that is not finite", "millimetres");
  if (grid.origin_mm.cwiseAbs().maxCoeff() > kFarthestPlaceOfScanMm) {
    throw DataError(path, "origin", fmt::format("({:.4g}, {:.4g}, {:.4g}) mm", grid.origin_mm[0], grid.origin_mm[1], grid.origin_mm[2]),
                    fmt::format("a place within {} mm", kFarthestPlaceOfScanMm), "Lengths are mm");
  }
  const double skew = (grid.direction.transpose() * grid.direction - Mat3::Identity()).cwiseAbs().maxCoeff();
  if (!(skew < kOrthonormalTolerance)) {
    throw DataError(path, "axes", fmt::format("voxel axes that are not at right angles (by {:.2g})", skew),
                    "an orthogonal grid", "Resample the volume onto one first.");
  }
  // The nearest orthonormal axes undo the rounding of the file format.
  const Eigen::JacobiSVD<Mat3> svd(grid.direction, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Mat3 nearest = svd.matrixU() * svd.matrixV().transpose();
  if (skew > 1e-12) grid.direction = nearest;
  return grid;
}

void set_whole_region(itk::ImageIOBase& io) {
  itk::ImageIORegion region(io.GetNumberOfDimensions());
  for (unsigned axis = 0; axis < io.GetNumberOfDimensions(); ++axis) {
    region.SetIndex(axis, 0);
    region.SetSize(axis, io.GetDimensions(axis));
  }
  io.SetIORegion(region);
}

RawImage read_here(const fs::path& path, VolumeFormat format) {
  const QuietImageLibraries quiet;
  const auto io = make_image_io(format);
  RawImage image;
  try {
    if (!io->CanReadFile(path.c_str())) {
      throw DataError(path, "first bytes", "something else", fmt::format("a {} file", to_string(format)),
                      "Is the file damaged, or its extension wrong?");
    }
    io->SetFileName(path.string());
    io->ReadImageInformation();
    require_gray_volume(path, *io);
    require_stated_geometry(path, format, image.notices);
    image.grid = grid_of(path, *io);
    image.component = *component_of(io->GetComponentType());
    set_whole_region(*io);
    require_possible_size(path, image.grid.voxel_count() * io->GetComponentSize());
    require_complete_voxels(path, format, image.grid.voxel_count() * io->GetComponentSize());
    image.bytes.resize(image.grid.voxel_count() * io->GetComponentSize());
    io->Read(image.bytes.data());
  } catch (const std::bad_alloc&) {
    throw DataError(path, "voxels", "more than fits into memory", "a volume that fits into memory");
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw DataError(path, "content", fmt::format("\"{}\"", essence(error)),
                    fmt::format("a complete {} file", to_string(format)), "Is the file cut short?");
  }
  return image;
}

/// A hidden folder beside the target, removed at the end: files get their final names in it (a .mhd names its voxel
/// file) and then move out together.
class StagingFolder {
 public:
  explicit StagingFolder(const fs::path& target) : target_(target), folder_(folder_beside(target)) {}

  [[nodiscard]] fs::path file() const { return folder_.path() / target_.filename(); }

  /// Moves voxel files first, so that a header never names voxels that are not there.
  void move_out() const {
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      if (entry.path() != file()) move_one(entry.path());
    }
    move_one(file());
  }

 private:
  /// @throws DataError that names the target, not the hidden folder.
  static AtomicFolder folder_beside(const fs::path& target) {
    require_writable(target);
    try {
      return AtomicFolder(target.parent_path() / ("." + target.filename().string()));
    } catch (const DataError& error) {
      throw DataError(target, "", fmt::format("no room for a hidden folder beside it ({})", error.what()),
                      "a folder that can be written");
    }
  }
  void move_one(const fs::path& from) const {
    std::error_code error;
    fs::rename(from, target_.parent_path() / from.filename(), error);
    if (error) throw DataError(target_, "", system_reason(error), "a file that can be written");
  }

  fs::path target_;
  AtomicFolder folder_;  // is never put in place
};

}  // namespace

std::optional<VolumeFormat> format_of_name(const fs::path& path) {
  const std::string name = io_detail::lower_case(path.filename().string());
  const auto ends = [&name](std::string_view end) { return name.size() > end.size() && name.ends_with(end); };
  if (ends(".nrrd") || ends(".nhdr")) return VolumeFormat::Nrrd;
  if (ends(".nii") || ends(".nii.gz")) return VolumeFormat::Nifti;
  if (ends(".mhd") || ends(".mha")) return VolumeFormat::MetaImage;
  if (ends(".png")) return VolumeFormat::PictureStack;
  return std::nullopt;
}

RawImage read_itk_image(const fs::path& path, VolumeFormat format) {
  require_regular_file(path);
  if (format == VolumeFormat::MetaImage) require_plain_meta_header(path);
  if (format == VolumeFormat::Nrrd) require_ended_nrrd_header(path);
  io_detail::ChildLimits limits;
  const std::uint64_t size = total_size(path);
  limits.memory_bytes = kLibraryMemory + 3 * std::min(kLargestGain * size, kLargestInputBytes);
  limits.processor_s = static_cast<unsigned>(60 + size / (4 << 20));
  const std::string answer = io_detail::in_child_process(path, std::string(to_string(format)), limits,
                                                         [&] { return bytes_of(read_here(path, format)); });
  return from_bytes<RawImage>(answer, path);
}

VolumeFormat format_to_write(const fs::path& path) {
  const auto format = format_of_name(path);
  if (format && *format != VolumeFormat::PictureStack) return *format;
  throw DataError(path, "extension", fmt::format("'{}'", path.extension().string()), kLabelFormats);
}

void write_itk_image(const fs::path& path, const VolumeGrid& grid, Component component, const void* voxels) {
  const VolumeFormat format = format_to_write(path);
  const ImageLibraryTurn turn;
  const QuietImageLibraries quiet;
  const StagingFolder staging(path);
  const auto io = make_image_io(format);
  try {
    io->SetFileName(staging.file().string());
    io->SetNumberOfDimensions(3);
    io->SetPixelType(itk::IOPixelEnum::SCALAR);
    io->SetNumberOfComponents(1);
    io->SetComponentType(component == Component::U8    ? itk::IOComponentEnum::UCHAR
                         : component == Component::F32 ? itk::IOComponentEnum::FLOAT
                                                       : itk::IOComponentEnum::SHORT);
    for (unsigned axis = 0; axis < 3; ++axis) {
      io->SetDimensions(axis, static_cast<itk::SizeValueType>(grid.size[axis]));
      io->SetSpacing(axis, grid.spacing_mm[axis]);
      io->SetOrigin(axis, grid.origin_mm[axis]);
      io->SetDirection(axis, {grid.direction(0, axis), grid.direction(1, axis), grid.direction(2, axis)});
    }
    io->SetUseCompression(true);
    set_whole_region(*io);
    io->WriteImageInformation();
    io->Write(voxels);
    require_complete_voxels(staging.file(), format, grid.voxel_count() * io->GetComponentSize());
  } catch (const DataError&) {
    throw DataError(path, "", "a failed write", "a file that can be written", "Is the disk full?");
  } catch (const std::exception& error) {
    throw DataError(path, "", fmt::format("\"{}\"", essence(error)), "a file that can be written", "Is the disk full?");
  }
  staging.move_out();
}

void require_writable_grid(const VolumeGrid& grid, std::size_t voxels) {
  INCISE_REQUIRE(*std::min_element(grid.size.begin(), grid.size.end()) >= 1,
                 fmt::format("expected one voxel or more along each axis, found {} x {} x {}", grid.size[0],
                             grid.size[1], grid.size[2]));
  INCISE_REQUIRE(voxels == grid.voxel_count(), fmt::format("expected {} voxels, found {}", grid.voxel_count(), voxels));
  INCISE_REQUIRE(grid.spacing_mm.allFinite() && grid.spacing_mm.minCoeff() > 0, "expected positive, finite spacing");
  INCISE_REQUIRE(grid.origin_mm.allFinite(), "expected a finite origin");
  const double skew = (grid.direction.transpose() * grid.direction - Mat3::Identity()).cwiseAbs().maxCoeff();
  INCISE_REQUIRE(skew < 1e-6, fmt::format("expected orthonormal axes, found them off by {}", skew));
}

}  // namespace incise
