#include "io/volume_stack.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace incise {
namespace {

namespace fs = std::filesystem;

constexpr double kSamePlaceMm = 0.01;     // scanners write positions to 0.01 mm or finer
constexpr double kSidewaysMm = 0.1;       // a fifth of a head CT's pixel
constexpr double kUnevenMm = 0.05;        // rounding of written positions …
constexpr double kUnevenFraction = 0.02;  // … or a fiftieth of a step, whichever is larger
constexpr double kHoleFraction = 0.25;    // more long steps than this mean a protocol with two spacings, not holes
constexpr double kMaxVoxels = 2e9;

std::vector<double> steps_of(const std::vector<double>& heights) {
  std::vector<double> steps(heights.size() - 1);
  for (std::size_t k = 0; k < steps.size(); ++k) steps[k] = heights[k + 1] - heights[k];
  return steps;
}

double lower_median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double uneven_tolerance(double step_mm) {
  return std::max(kUnevenMm, kUnevenFraction * step_mm);
}

/// Finds holes: a few steps that are whole multiples of the common step, if all other steps equal it.
void find_holes(const std::vector<SlicePlace>& places, StackLayout& layout) {
  const std::vector<double> steps = steps_of(layout.height_mm);
  const double common = layout.common_step_mm;
  int long_steps = 0;
  int missing = 0;
  std::string first;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const double multiple = std::round(steps[k] / common);
    if (multiple < 1 || std::abs(steps[k] - multiple * common) > uneven_tolerance(common)) return;
    if (multiple < 2) continue;
    ++long_steps;
    missing += static_cast<int>(multiple) - 1;
    if (first.empty()) {
      first = fmt::format("between '{}' and '{}', {:.4g} mm apart", places[layout.order[k]].name,
                          places[layout.order[k + 1]].name, steps[k]);
    }
  }
  if (long_steps > kHoleFraction * static_cast<double>(steps.size())) return;
  layout.missing_slices = missing;
  layout.first_hole = first;
}

/// Describes a sideways shift. It is a tilt if every slice moves in proportion to its height.
std::string describe_sideways(const StackLayout& layout) {
  double farthest = 0;
  double off_the_line = 0;
  for (std::size_t k = 0; k < layout.height_mm.size(); ++k) {
    const Vec2 on_the_line = layout.sideways_mm.back() * (layout.height_mm[k] / layout.height_mm.back());
    off_the_line = std::max(off_the_line, (layout.sideways_mm[k] - on_the_line).norm());
    farthest = std::max(farthest, layout.sideways_mm[k].norm());
  }
  if (off_the_line <= kSidewaysMm) return fmt::format("a gantry tilt of {:.1f} deg", layout.tilt_deg);
  return fmt::format("slices shifted sideways by up to {:.4g} mm", farthest);
}

/// "a gantry tilt of 18.5 deg and uneven slice steps of 1.081 to 6.999 mm"; empty for a regular stack.
std::string irregularity_words(const StackLayout& layout) {
  std::string words = layout.sideways_words;
  if (!layout.is_uneven) return words;
  if (!words.empty()) words += " and ";
  if (layout.missing_slices > 0) {
    return words + fmt::format("{} missing slices, the first {},", layout.missing_slices, layout.first_hole);
  }
  return words + fmt::format("uneven slice steps of {:.4g} to {:.4g} mm", layout.min_step_mm, layout.max_step_mm);
}

/// Interpolates between four pixels of a slice; NaN outside the slice.
float sample(const SliceFrame& frame, const std::int16_t* hu, double u, double v) {
  if (u < 0 || v < 0 || u > frame.columns - 1 || v > frame.rows - 1) return std::numeric_limits<float>::quiet_NaN();
  const int i = std::max(0, std::min(static_cast<int>(u), frame.columns - 2));
  const int j = std::max(0, std::min(static_cast<int>(v), frame.rows - 2));
  const double a = u - i;
  const double b = v - j;
  // A pixel of weight 0 may lie outside a slice that is one pixel wide, so it is not read.
  const auto term = [&](double weight, int di, int dj) {
    return weight > 0 ? weight * hu[static_cast<std::size_t>(j + dj) * frame.columns + i + di] : 0.0;
  };
  return static_cast<float>(term((1 - a) * (1 - b), 0, 0) + term(a * (1 - b), 1, 0) + term((1 - a) * b, 0, 1) +
                            term(a * b, 1, 1));
}

/// Interpolates one slice at the output's columns and rows; NaN where it does not reach.
/// @param shift  output pixel (i, j) is the slice's pixel (i, j) - shift
std::vector<float> lay_slice(const SliceFrame& frame, const std::int16_t* hu, const Vec2& shift, int columns,
                             int rows) {
  std::vector<float> plane;
  plane.reserve(static_cast<std::size_t>(columns) * rows);
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) plane.push_back(sample(frame, hu, i - shift[0], j - shift[1]));
  }
  return plane;
}

/// The orthogonal grid that a tilted or uneven stack is interpolated onto.
struct TargetGrid {
  VolumeGrid grid;
  std::vector<Vec2> shift;  ///< per slice, in pixels of the grid
};

TargetGrid plan_target(const fs::path& path, const SliceFrame& frame, const StackLayout& layout) {
  const Vec2 pixel_mm(frame.column_spacing_mm, frame.row_spacing_mm);
  TargetGrid target;
  Vec2 lowest = Vec2::Zero();
  Vec2 highest = Vec2::Zero();
  for (const Vec2& sideways : layout.sideways_mm) {
    Vec2 shift = layout.is_sideways ? Vec2(sideways.cwiseQuotient(pixel_mm)) : Vec2(0, 0);
    for (double& pixels : shift) {
      // A shift by whole pixels, up to rounding, needs no interpolation and must not lose the last row.
      constexpr double rounding = 1e-4;
      if (std::abs(pixels - std::round(pixels)) < rounding) pixels = std::round(pixels);
    }
    target.shift.push_back(shift);
    lowest = lowest.cwiseMin(shift);
    highest = highest.cwiseMax(shift);
  }
  lowest = lowest.array().floor();
  for (Vec2& shift : target.shift) shift -= lowest;
  const Vec2 extra = highest.array().ceil() - lowest.array();

  const double finest = std::max(layout.min_step_mm, pixel_mm.minCoeff());
  const double height = layout.height_mm.back();
  const double steps = std::max(1.0, std::ceil(height / finest - 1e-6));
  const double voxels = (frame.columns + extra[0]) * (frame.rows + extra[1]) * (steps + 1);
  if (voxels > kMaxVoxels) {
    throw DataError(path, "resampled size", fmt::format("{:.2g} voxels", voxels),
                    fmt::format("at most {:.0g}", kMaxVoxels),
                    "The slices are very uneven, or a foreign slice is among them.");
  }
  VolumeGrid& grid = target.grid;
  grid.size = {frame.columns + static_cast<int>(extra[0]), frame.rows + static_cast<int>(extra[1]),
               static_cast<int>(steps) + 1};
  grid.spacing_mm = Vec3(pixel_mm[0], pixel_mm[1], height / steps);
  grid.direction << frame.row_axis, frame.column_axis, frame.normal();
  grid.origin_mm =
      layout.first_position_mm + lowest[0] * pixel_mm[0] * frame.row_axis + lowest[1] * pixel_mm[1] * frame.column_axis;
  return target;
}

/// Interpolates every voxel linearly in all three directions between the pixels around its position in the patient.
CtVolume resample(const fs::path& path, const SliceFrame& frame, const StackLayout& layout,
                  const std::vector<std::int16_t>& hu, Monitor& monitor) {
  const TargetGrid target = plan_target(path, frame, layout);
  CtVolume volume{target.grid, std::vector<std::int16_t>(target.grid.voxel_count(), kAirHu)};
  const std::size_t slice_pixels = static_cast<std::size_t>(frame.columns) * frame.rows;
  const std::size_t plane_pixels = static_cast<std::size_t>(target.grid.size[0]) * target.grid.size[1];
  const auto lay = [&](std::size_t slice) {
    return lay_slice(frame, hu.data() + slice * slice_pixels, target.shift[slice], target.grid.size[0],
                     target.grid.size[1]);
  };

  std::size_t below = 0;
  std::vector<float> lower = lay(0);
  std::vector<float> upper = lay(1);
  for (int k = 0; k < target.grid.size[2]; ++k) {
    throw_if_cancelled(monitor, "resampling CT");
    monitor.progress("resampling CT", static_cast<double>(k) / target.grid.size[2]);
    const double height = k * target.grid.spacing_mm[2];
    while (below + 2 < layout.height_mm.size() && layout.height_mm[below + 1] < height - 1e-9) {
      ++below;
      lower = std::move(upper);
      upper = lay(below + 1);
    }
    const double step = layout.height_mm[below + 1] - layout.height_mm[below];
    const double weight =
        std::clamp((height - layout.height_mm[below]) / step, 0.0, 1.0);  // only rounding lies outside
    std::int16_t* out = volume.voxels.data() + static_cast<std::size_t>(k) * plane_pixels;
    for (std::size_t p = 0; p < plane_pixels; ++p) {
      const double value = weight <= 0   ? lower[p]
                           : weight >= 1 ? upper[p]
                                         : (1 - weight) * lower[p] + weight * upper[p];
      if (!std::isnan(value)) out[p] = static_cast<std::int16_t>(std::lround(value));
    }
  }
  monitor.progress("resampling CT", 1.0);
  return volume;
}

}  // namespace

StackLayout lay_out_stack(const fs::path& path, const SliceFrame& frame, const std::vector<SlicePlace>& places) {
  if (places.size() < 2) throw DataError(path, "slices", "a single slice", "a series of two slices or more");
  StackLayout layout;
  const Vec3 normal = frame.normal();
  layout.order.resize(places.size());
  std::iota(layout.order.begin(), layout.order.end(), 0);
  const auto height_of = [&](int slice) { return normal.dot(places[slice].position_mm); };
  std::stable_sort(layout.order.begin(), layout.order.end(), [&](int a, int b) { return height_of(a) < height_of(b); });

  const Vec3 first = places[layout.order.front()].position_mm;
  for (const int slice : layout.order) {
    const Vec3 offset = places[slice].position_mm - first;
    layout.height_mm.push_back(normal.dot(offset));
    layout.sideways_mm.emplace_back(frame.row_axis.dot(offset), frame.column_axis.dot(offset));
  }
  const std::vector<double> steps = steps_of(layout.height_mm);
  for (std::size_t k = 0; k < steps.size(); ++k) {
    if (steps[k] >= kSamePlaceMm) continue;
    throw DataError(path, "ImagePositionPatient",
                    fmt::format("'{}' and '{}' at the same place along the normal", places[layout.order[k]].name,
                                places[layout.order[k + 1]].name),
                    "one slice per place", "Are two reconstructions or time points mixed?");
  }
  layout.min_step_mm = *std::min_element(steps.begin(), steps.end());
  layout.max_step_mm = *std::max_element(steps.begin(), steps.end());
  layout.common_step_mm = lower_median(steps);

  const double height = layout.height_mm.back();
  const double even_step = height / static_cast<double>(steps.size());
  for (std::size_t k = 0; k < layout.height_mm.size(); ++k) {
    const double off = std::abs(layout.height_mm[k] - even_step * static_cast<double>(k));
    layout.is_uneven = layout.is_uneven || off > uneven_tolerance(even_step);
    layout.is_sideways = layout.is_sideways || layout.sideways_mm[k].norm() > kSidewaysMm;
  }
  layout.first_position_mm = first;
  layout.tilt_deg = std::atan2(layout.sideways_mm.back().norm(), height) * 180.0 / std::numbers::pi;
  if (layout.is_sideways) layout.sideways_words = describe_sideways(layout);
  if (layout.is_uneven) find_holes(places, layout);
  return layout;
}

void judge_stack(const fs::path& path, const StackLayout& layout, const CtReadSettings& settings) {
  if (layout.missing_slices > 0 && settings.missing == MissingSlices::Refuse) {
    throw DataError(path, "slices",
                    fmt::format("{} missing: the slices are {:.4g} mm apart, but there is a gap {}",
                                layout.missing_slices, layout.common_step_mm, layout.first_hole),
                    "every slice of the series", "Copy the series again, or allow missing slices to be interpolated.");
  }
  if (settings.irregular == IrregularSlices::Resample) return;
  const std::string found = irregularity_words(layout);
  if (!found.empty()) {
    throw DataError(path, "ImagePositionPatient", found, "slices that stack straight at even steps",
                    "Allow irregular slices to be resampled, or have the scanner reconstruct a regular series.");
  }
}

void notify(CtReadDiagnostics& diagnostics, Monitor& monitor, std::string notice) {
  monitor.message(Severity::Notice, notice);
  diagnostics.notices.push_back(std::move(notice));
}

CtVolume assemble_stack(const fs::path& path, const SliceFrame& frame, const StackLayout& layout,
                        std::vector<std::int16_t> hu, CtReadDiagnostics& diagnostics, Monitor& monitor) {
  diagnostics.slices = static_cast<int>(layout.order.size());
  diagnostics.gantry_tilt_deg = layout.tilt_deg;
  diagnostics.min_step_mm = layout.min_step_mm;
  diagnostics.max_step_mm = layout.max_step_mm;
  diagnostics.missing_slices = layout.missing_slices;
  diagnostics.is_resampled = layout.is_sideways || layout.is_uneven;
  if (!diagnostics.is_resampled) {
    CtVolume volume;
    volume.grid.size = {frame.columns, frame.rows, diagnostics.slices};
    volume.grid.spacing_mm = Vec3(frame.column_spacing_mm, frame.row_spacing_mm,
                                  layout.height_mm.back() / static_cast<double>(diagnostics.slices - 1));
    volume.grid.origin_mm = layout.first_position_mm;
    volume.grid.direction << frame.row_axis, frame.column_axis, frame.normal();
    volume.voxels = std::move(hu);
    return volume;
  }
  CtVolume volume = resample(path, frame, layout, hu, monitor);
  const auto& [columns, rows, planes] = volume.grid.size;
  notify(diagnostics, monitor,
         fmt::format("{} removed by linear resampling to {} x {} x {} voxels, {:.4g} mm from slice to slice",
                     irregularity_words(layout), columns, rows, planes, volume.grid.spacing_mm[2]));
  return volume;
}

}  // namespace incise
