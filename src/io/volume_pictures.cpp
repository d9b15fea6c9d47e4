#include "io/volume_pictures.hpp"

#include "io/picture_file.hpp"
#include "io/volume_stack.hpp"

#include <incise/core/error.hpp>
#include <incise/core/workers.hpp>
#include <incise/io/atomic_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace incise {
namespace {

namespace fs = std::filesystem;

/// "texture-12.png" is picture 12 of the stack "texture-*".
struct Picture {
  fs::path file;
  std::string stack;
  long long number = 0;
};

Picture parse_name(const fs::path& file) {
  const std::string stem = file.stem().string();
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  std::size_t end = stem.size();
  while (end > 0 && !is_digit(stem[end - 1])) --end;
  std::size_t begin = end;
  while (begin > 0 && is_digit(stem[begin - 1])) --begin;
  Picture picture{file, stem.substr(0, begin) + '*' + stem.substr(end)};
  const auto [stop, problem] = std::from_chars(stem.data() + begin, stem.data() + end, picture.number);
  if (begin == end || problem != std::errc() || stop != stem.data() + end) {
    throw DataError(file, "name", fmt::format("'{}'", stem), "a name with the picture's number in the stack");
  }
  return picture;
}

/// Returns the pictures of a folder in the order of their numbers. Refuses mixed stacks, and duplicates or gaps in the
/// numbering.
std::vector<Picture> sorted_pictures(const fs::path& folder, int& other_files) {
  std::vector<Picture> pictures;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    if (format_of_name(entry.path()) == VolumeFormat::PictureStack) {
      pictures.push_back(parse_name(entry.path()));
    } else {
      ++other_files;
    }
  }
  std::sort(pictures.begin(), pictures.end(), [](const Picture& a, const Picture& b) {
    return std::pair(a.number, a.file) < std::pair(b.number, b.file);
  });
  if (pictures.size() < 2) throw DataError(folder, "pictures", "a single slice", "a stack of two pictures or more");
  const long long step = pictures[1].number - pictures[0].number;
  for (std::size_t p = 1; p < pictures.size(); ++p) {
    const Picture& before = pictures[p - 1];
    const Picture& here = pictures[p];
    const auto both = [&] {
      return fmt::format("'{}' and '{}'", before.file.filename().string(), here.file.filename().string());
    };
    if (before.stack != here.stack)
      throw DataError(folder, "pictures", both(), "names that differ only by the picture's number");
    if (before.number == here.number)
      throw DataError(folder, "pictures", both() + " with one number", "one picture per number");
    if (here.number - before.number != step) {
      throw DataError(folder, "pictures", "a gap in the numbering between " + both(), "every slice of the stack");
    }
  }
  return pictures;
}

void require_settings(const fs::path& folder, const CtReadSettings& settings) {
  const std::string hint = "Pictures carry neither millimetres nor Hounsfield units.";
  if (!settings.spacing_mm) {
    throw CaseError(folder.string(), "ct.spacing_mm", "nothing", "column, row and slice spacing in mm", hint);
  }
  if (!settings.hu)
    throw CaseError(folder.string(), "ct.hu", "nothing", "{slope, intercept} from gray level to HU", hint);
  const Vec3& spacing = *settings.spacing_mm;
  if (!spacing.allFinite() || spacing.minCoeff() < kFinestVoxelMm || spacing.maxCoeff() > kCoarsestVoxelMm) {
    throw CaseError(folder.string(), "ct.spacing_mm", fmt::format("[{}, {}, {}]", spacing[0], spacing[1], spacing[2]),
                    fmt::format("three positive, finite lengths of {} to {} mm", kFinestVoxelMm, kCoarsestVoxelMm));
  }
  if (!std::isfinite(settings.hu->slope) || settings.hu->slope == 0 || !std::isfinite(settings.hu->intercept)) {
    throw CaseError(folder.string(), "ct.hu",
                    fmt::format("{{slope: {}, intercept: {}}}", settings.hu->slope, settings.hu->intercept),
                    "finite numbers and a slope other than 0");
  }
}

/// Table of HU by gray level, computed once for all slices.
class HuTable {
 public:
  explicit HuTable(const GrayToHu& hu) : hu_(hu), values_(std::size_t{1} << 16) {
    for (std::size_t gray = 0; gray < values_.size(); ++gray) {
      const double value = value_of(gray);
      values_[gray] = value < -32768.0 || value > 32767.0 ? kNone : static_cast<std::int32_t>(std::lround(value));
    }
  }
  void convert(const fs::path& file, const RawImage& image, std::int16_t* out) const {
    for (std::size_t p = 0; p < image.grid.voxel_count(); ++p) {
      std::uint16_t gray = 0;
      if (image.component == Component::U8) {
        gray = static_cast<unsigned char>(image.bytes[p]);
      } else {
        std::memcpy(&gray, image.bytes.data() + p * sizeof gray, sizeof gray);
      }
      if (values_[gray] == kNone) {
        throw DataError(file, fmt::format("pixel ({}, {})", p % image.grid.size[0], p / image.grid.size[0]),
                        fmt::format("gray level {}, that is {:.6g} HU", gray, value_of(gray)), "a value of 16 bits",
                        "Check ct.hu.");
      }
      out[p] = static_cast<std::int16_t>(values_[gray]);
    }
  }

 private:
  static constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::max();
  [[nodiscard]] double value_of(std::size_t gray) const {
    return hu_.slope * static_cast<double>(gray) + hu_.intercept;
  }
  GrayToHu hu_;
  std::vector<std::int32_t> values_;
};

/// Reads the slices, several at a time, into a volume whose grid has their size. @param first  slice 0, already read
void read_slices(const std::vector<Picture>& pictures, const HuTable& table, const RawImage& first, CtVolume& volume,
                 Monitor& monitor) {
  const VolumeGrid& grid = volume.grid;
  const std::size_t pixels = first.grid.voxel_count();
  const auto read = [&](std::size_t k) {
    const RawImage image = k == 0 ? first : read_gray_png(pictures[k].file);
    if (image.grid.size[0] != grid.size[0] || image.grid.size[1] != grid.size[1]) {
      throw DataError(
          pictures[k].file, "size", fmt::format("{} x {}", image.grid.size[0], image.grid.size[1]),
          fmt::format("{} x {} as in '{}'", grid.size[0], grid.size[1], pictures[0].file.filename().string()));
    }
    table.convert(pictures[k].file, image, volume.voxels.data() + k * pixels);
  };
  Workers workers(0);
  const std::size_t block = 4 * static_cast<std::size_t>(workers.thread_count());  // slices between monitor checks
  for (std::size_t begin = 0; begin < pictures.size(); begin += block) {
    throw_if_cancelled(monitor, "reading CT");
    monitor.progress("reading CT", static_cast<double>(begin) / static_cast<double>(pictures.size()));
    workers.for_each(std::min(block, pictures.size() - begin), 1, [&](std::size_t i) { read(begin + i); });
  }
}

}  // namespace

RawImage read_gray_png(const fs::path& file) {
  constexpr double kMostPixels = 1073741824.0;  // 32768 x 32768 in a slice: far above any scanner's
  constexpr int kGray = 0, kGrayAndAlpha = 4;
  const std::string bytes = read_text(file);
  const PngHeader header = read_png_header(bytes, file, kMostPixels);
  if (header.colour != kGray) {
    throw DataError(file, "colour type", header.colour == kGrayAndAlpha ? "gray with transparency" : "colour",
                    "gray only");
  }
  if (header.bits != 8 && header.bits != 16)
    throw DataError(file, "bit depth", fmt::format("{}", header.bits), "8 or 16");
  RawImage image;
  image.grid.size = {header.width, header.height, 1};
  image.component = header.bits == 8 ? Component::U8 : Component::U16;
  image.bytes = read_png(bytes, file, kMostPixels).bytes;
  return image;
}

ReadVolume read_picture_folder(const fs::path& folder, const CtReadSettings& settings, Monitor& monitor) {
  require_settings(folder, settings);
  int other_files = 0;
  std::vector<Picture> pictures = sorted_pictures(folder, other_files);
  if (settings.first_picture_is_head) std::reverse(pictures.begin(), pictures.end());

  ReadVolume result;
  CtReadDiagnostics& diagnostics = result.diagnostics;
  diagnostics.format = VolumeFormat::PictureStack;
  diagnostics.slices = static_cast<int>(pictures.size());
  diagnostics.min_step_mm = diagnostics.max_step_mm = (*settings.spacing_mm)[2];
  const RawImage first = read_gray_png(pictures.front().file);
  VolumeGrid& grid = result.volume.grid;
  grid.size = {first.grid.size[0], first.grid.size[1], diagnostics.slices};
  grid.spacing_mm = *settings.spacing_mm;
  result.volume.voxels.resize(grid.voxel_count());
  read_slices(pictures, HuTable(*settings.hu), first, result.volume, monitor);
  monitor.progress("reading CT", 1.0);
  if (other_files > 0)
    notify(diagnostics, monitor,
           fmt::format("files of the folder that are no PNG pictures and were passed over: {}", other_files));
  const auto has_fraction = [](double v) { return v != std::round(v); };
  if (has_fraction(settings.hu->slope) || has_fraction(settings.hu->intercept)) {
    notify(diagnostics, monitor, "fractional Hounsfield units were rounded to whole ones");
  }
  return result;
}

}  // namespace incise
