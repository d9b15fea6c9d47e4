#include "report/slices.hpp"

#include "report/outline.hpp"
#include "report/plot.hpp"
#include "report/svg.hpp"

#include <incise/core/error.hpp>
#include <incise/io/picture_io.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace incise {
namespace {

constexpr int kMaxPixels = 360;  ///< along the longer side of a slice

/// The volume's index axis that runs nearest to a world axis, and whether it runs along (+1) or against it (-1).
struct AxisMatch {
  int index_axis = 0;
  double sign = 1.0;
};

std::array<AxisMatch, 3> match_axes(const Mat3& direction) {
  std::array<AxisMatch, 3> matches;
  std::array<int, 3> order{0, 1, 2};
  double best = -1.0;
  do {  // the permutation with the largest sum of cosines
    double sum = 0.0;
    for (int world = 0; world < 3; ++world) sum += std::abs(direction(world, order[static_cast<std::size_t>(world)]));
    if (sum <= best) continue;
    best = sum;
    for (int world = 0; world < 3; ++world) {
      const int axis = order[static_cast<std::size_t>(world)];
      matches[static_cast<std::size_t>(world)] = {axis, direction(world, axis) < 0.0 ? -1.0 : 1.0};
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return matches;
}

/// Value at a continuous index, linear between voxel centres; beyond the outer centres by up to half a voxel the
/// border's value, farther out `outside`.
template <class Value>
double sampled(const Volume<Value>& volume, const Vec3& index, double outside) {
  std::array<int, 3> low{};
  Vec3 f;
  for (int axis = 0; axis < 3; ++axis) {
    const int last = volume.grid.size[static_cast<std::size_t>(axis)] - 1;
    if (index[axis] < -0.5 || index[axis] > last + 0.5) return outside;
    const double inside = std::clamp(index[axis], 0.0, static_cast<double>(last));
    low[static_cast<std::size_t>(axis)] = std::min(static_cast<int>(inside), std::max(0, last - 1));
    f[axis] = inside - low[static_cast<std::size_t>(axis)];
  }
  double value = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const std::array<int, 3> step{corner & 1, corner >> 1 & 1, corner >> 2 & 1};
    double weight = 1.0;
    for (int axis = 0; axis < 3; ++axis) weight *= step[static_cast<std::size_t>(axis)] == 1 ? f[axis] : 1.0 - f[axis];
    if (weight == 0.0) continue;
    value += weight * static_cast<double>(volume.at(low[0] + step[0], low[1] + step[1], low[2] + step[2]));
  }
  return value;
}

/// The layout of a slice: world axes that run right, down and through it, and whether they run in the positive sense.
struct Layout {
  const char* name;
  int right, down, normal;
  double right_sign, down_sign;
};
// Axial from the feet, coronal from the front, sagittal from the left: the patient's right is at the left, the head up.
constexpr std::array<Layout, 3> kLayouts{
    {{"axial", 0, 1, 2, 1.0, 1.0}, {"coronal", 0, 2, 1, 1.0, -1.0}, {"sagittal", 1, 2, 0, 1.0, -1.0}}};

/// Makes the slices of one layout at the given positions along the normal's index axis.
class Slicer {
 public:
  Slicer(const CtPicture& picture, const Layout& layout) : picture_(picture), layout_(layout) {
    const VolumeGrid& grid = picture.ct.grid;
    axes_ = match_axes(grid.direction);
    const auto extent = [&](int world) {
      const auto axis = static_cast<std::size_t>(axes_[static_cast<std::size_t>(world)].index_axis);
      return grid.size[axis] * grid.spacing_mm[static_cast<int>(axis)];
    };
    width_mm_ = extent(layout.right);
    height_mm_ = extent(layout.down);
    const double finest = std::min(spacing_along(layout.right), spacing_along(layout.down));
    const double pixel_mm = std::max(finest, std::max(width_mm_, height_mm_) / kMaxPixels);
    columns_ = std::max(2, static_cast<int>(std::lround(width_mm_ / pixel_mm)));
    rows_ = std::max(2, static_cast<int>(std::lround(height_mm_ / pixel_mm)));
  }

  [[nodiscard]] double width_mm() const { return width_mm_; }
  [[nodiscard]] double height_mm() const { return height_mm_; }
  [[nodiscard]] int count() const { return picture_.ct.grid.size[static_cast<std::size_t>(normal_axis())]; }

  [[nodiscard]] Slice at(int normal_index) const {
    std::vector<std::uint8_t> pixels;
    std::vector<double> tissue;
    const double window = picture_.window_high_hu - picture_.window_low_hu;
    const bool has_outline = !picture_.occupancy.voxels.empty();
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        const Vec3 index = index_of(column, row, normal_index);
        const double share = (sampled(picture_.ct, index, kAirHu) - picture_.window_low_hu) / window;
        pixels.push_back(static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(share, 0.0, 1.0))));
        if (!has_outline) continue;
        const Vec3 world = picture_.ct.grid.world_from_index(index);
        tissue.push_back(sampled(picture_.occupancy, picture_.occupancy.grid.index_from_world(world), 0.0));
      }
    }
    Slice slice;
    const Vec3 middle = picture_.ct.grid.world_from_index(index_of(columns_ / 2, rows_ / 2, normal_index));
    slice.position_mm = middle[layout_.normal];
    slice.image_uri = png_data_uri(encode_png(pixels, columns_, rows_, 1));
    if (has_outline)
      slice.outline = outline_path(tissue, columns_, rows_, 0.5, width_mm_ / columns_, height_mm_ / rows_);
    slice.tumor = section_of(picture_.tumor, normal_index);
    slice.planned_cut = section_of(picture_.planned_cut, normal_index);
    return slice;
  }

  /// Index of the slice nearest to a place.
  [[nodiscard]] int nearest_to(const Vec3& place) const {
    const double index = picture_.ct.grid.index_from_world(place)[normal_axis()];
    return std::clamp(static_cast<int>(std::lround(index)), 0, count() - 1);
  }

 private:
  [[nodiscard]] int normal_axis() const { return axes_[static_cast<std::size_t>(layout_.normal)].index_axis; }
  [[nodiscard]] double spacing_along(int world) const {
    return picture_.ct.grid.spacing_mm[axes_[static_cast<std::size_t>(world)].index_axis];
  }
  /// A place in mm: to the right and down from the picture's top left corner, and along the normal from the first
  /// slice, in slices.
  [[nodiscard]] Vec3 in_picture(const Vec3& world) const {
    const Vec3 index = picture_.ct.grid.index_from_world(world);
    const auto along = [&](int axis_of_world, double sense, double extent_mm) {
      const AxisMatch& match = axes_[static_cast<std::size_t>(axis_of_world)];
      const double share =
          (index[match.index_axis] + 0.5) / picture_.ct.grid.size[static_cast<std::size_t>(match.index_axis)];
      return extent_mm * (match.sign * sense > 0.0 ? share : 1.0 - share);
    };
    return {along(layout_.right, layout_.right_sign, width_mm_), along(layout_.down, layout_.down_sign, height_mm_),
            index[normal_axis()]};
  }

  /// Where a surface meets a slice, as SVG path data: one stroke for each triangle that the plane crosses.
  [[nodiscard]] std::string section_of(const TriMesh& surface, int normal_index) const {
    std::string path;
    for (const Triangle& triangle : surface.triangles) {
      std::vector<Vec2> ends;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 a = in_picture(vertex(surface.vertices, triangle[k]));
        const Vec3 b = in_picture(vertex(surface.vertices, triangle[(k + 1) % 3]));
        const double from = a.z() - normal_index;
        const double to = b.z() - normal_index;
        if ((from < 0.0) == (to < 0.0)) continue;
        ends.emplace_back((a + from / (from - to) * (b - a)).head<2>());
      }
      if (ends.size() == 2)
        path += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", ends[0].x(), ends[0].y(), ends[1].x(), ends[1].y());
    }
    return path;
  }

  /// Continuous index of the centre of a picture element.
  [[nodiscard]] Vec3 index_of(int column, int row, int normal_index) const {
    Vec3 index;
    const auto place = [&](int world, double sense, double share) {
      const AxisMatch& match = axes_[static_cast<std::size_t>(world)];
      const double along = match.sign * sense > 0.0 ? share : 1.0 - share;
      index[match.index_axis] = along * picture_.ct.grid.size[static_cast<std::size_t>(match.index_axis)] - 0.5;
    };
    place(layout_.right, layout_.right_sign, (column + 0.5) / columns_);
    place(layout_.down, layout_.down_sign, (row + 0.5) / rows_);
    index[normal_axis()] = normal_index;
    return index;
  }

  const CtPicture& picture_;
  Layout layout_;
  std::array<AxisMatch, 3> axes_;
  double width_mm_ = 0.0, height_mm_ = 0.0;
  int columns_ = 0, rows_ = 0;
};

/// The middle of the planned cut, or else of the tumour, if one is known. A tumour's surface may rise above the skin.
std::optional<Vec3> middle_of_interest(const CtPicture& picture) {
  Box3 box;
  const TriMesh& shown = picture.planned_cut.vertices.empty() ? picture.tumor : picture.planned_cut;
  for (const Vec3& p : shown.vertices) box.extend(p);
  return box.isEmpty() ? std::nullopt : std::optional<Vec3>(box.center());
}

/// Returns the indices of evenly spaced slices; for one slice, of the slice through `place`.
std::vector<int> slices_to_show(const Slicer& slicer, int wanted, const std::optional<Vec3>& place) {
  if (wanted == 1 && place) return {slicer.nearest_to(*place)};
  std::vector<int> indices;
  for (int k = 0; k < wanted; ++k) indices.push_back(static_cast<int>((k + 0.5) * slicer.count() / wanted));
  return indices;
}

}  // namespace

std::array<SlicePlane, 3> slice_planes(const CtPicture& picture, const std::array<std::string, 6>& axis_names,
                                       int max_axial) {
  INCISE_REQUIRE(max_axial >= 1, "expected at least one axial slice");
  std::array<SlicePlane, 3> planes;
  const std::optional<Vec3> center = middle_of_interest(picture);
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const Layout& layout = kLayouts[p];
    const Slicer slicer(picture, layout);
    const auto end_of = [&](int world, double sense) {
      return axis_names[static_cast<std::size_t>(2 * world + (sense > 0.0 ? 1 : 0))];
    };
    SlicePlane& plane = planes[p];
    plane.name = layout.name;
    plane.axis_name = std::string(1, "xyz"[layout.normal]);
    plane.width_mm = slicer.width_mm();
    plane.height_mm = slicer.height_mm();
    plane.ends = {end_of(layout.right, -layout.right_sign), end_of(layout.right, layout.right_sign),
                  end_of(layout.down, -layout.down_sign), end_of(layout.down, layout.down_sign)};
    const int wanted = p == 0 ? std::min(max_axial, slicer.count()) : 1;
    for (const int index : slices_to_show(slicer, wanted, center)) plane.slices.push_back(slicer.at(index));
    std::sort(plane.slices.begin(), plane.slices.end(),
              [](const Slice& a, const Slice& b) { return a.position_mm < b.position_mm; });
    plane.shown_first = plane.slices.size() / 2;
    if (!center) continue;
    const auto off = [&](const Slice& slice) { return std::abs(slice.position_mm - (*center)[layout.normal]); };
    const auto nearest = std::min_element(plane.slices.begin(), plane.slices.end(),
                                          [&off](const Slice& a, const Slice& b) { return off(a) < off(b); });
    plane.shown_first = static_cast<std::size_t>(nearest - plane.slices.begin());
  }
  return planes;
}

std::string slice_svg(const SlicePlane& plane, const Slice& slice) {
  const double w = plane.width_mm;
  const double h = plane.height_mm;
  const double unit = std::max(w, h) / 100.0;  // so that text and lines look the same on small and large scans
  SvgWriter svg(w, h, fmt::format("{} CT slice", plane.name),
                fmt::format("{} slice at {} = {} mm, {} by {} mm; orange: border of the segmented tissue; green: "
                            "tumour; blue: planned cut.",
                            plane.name, plane.axis_name, number_text(std::round(10.0 * slice.position_mm) / 10.0),
                            number_text(std::round(w)), number_text(std::round(h))),
                false);
  svg.image({0.0, 0.0}, {w, h}, slice.image_uri);
  svg.open_group(fmt::format("fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\" stroke-width=\"{:.3f}\"",
                             0.6 * unit));
  svg.path(slice.outline, fmt::format("class=\"outline\" stroke=\"{}\"", slice_ink::kTissue));
  svg.path(slice.tumor,
           fmt::format("class=\"tumor\" stroke=\"{}\" stroke-width=\"{:.3f}\"", slice_ink::kTumor, 0.9 * unit));
  svg.path(slice.planned_cut, fmt::format("class=\"planned-cut\" stroke=\"{}\" stroke-width=\"{:.3f}\"",
                                          slice_ink::kPlannedCut, 0.9 * unit));
  svg.close_group();
  svg.open_group(
      fmt::format("font-size=\"{:.2f}\" fill=\"#fff\" stroke=\"#000\" stroke-width=\"{:.3f}\" paint-order=\"stroke\"",
                  4.6 * unit, 0.8 * unit));
  svg.text({1.5 * unit, 0.5 * h + 1.6 * unit}, plane.ends[0]);
  svg.text({w - 1.5 * unit, 0.5 * h + 1.6 * unit}, plane.ends[1], "end");
  svg.text({0.5 * w, 5.0 * unit}, plane.ends[2], "middle");
  svg.text({0.5 * w, h - 1.8 * unit}, plane.ends[3], "middle");
  const double bar = rounded_up(0.12 * w);
  svg.text({3.0 * unit, h - 4.5 * unit}, fmt::format("{} mm", number_text(bar)), "start", "class=\"scale\"");
  svg.close_group();
  svg.line({3.0 * unit, h - 2.6 * unit}, {3.0 * unit + bar, h - 2.6 * unit},
           fmt::format("stroke=\"#fff\" stroke-width=\"{:.3f}\"", 0.9 * unit));
  return svg.finish();
}

}  // namespace incise
