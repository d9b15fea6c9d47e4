#include "imaging/occupancy.hpp"
#include "imaging/segmentation_region.hpp"
#include "imaging/volume_filters.hpp"

#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/core/median.hpp>
#include <incise/imaging/made_skin.hpp>
#include <incise/imaging/scan_checks.hpp>
#include <incise/imaging/segmentation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

constexpr const char* kStage = "segmenting";
// Of the chosen piece's volume: a smaller piece is a crumb, the table or a clamp.
constexpr double kLeastRivalShare = 0.25;
constexpr double kCarriedLengths = 4.0;  // smoothing lengths within which a moved cut face is searched for
constexpr int kGrowth = 3;  // voxels by which the occupancy can extend beyond its body

void require_sound_volume(const CtVolume& ct) {
  const VolumeGrid& grid = ct.grid;
  INCISE_REQUIRE(
      grid.size[0] > 0 && grid.size[1] > 0 && grid.size[2] > 0,
      fmt::format("expected a volume with voxels, found {} x {} x {}", grid.size[0], grid.size[1], grid.size[2]));
  INCISE_REQUIRE(ct.voxels.size() == grid.voxel_count(),
                 fmt::format("expected {} voxels for the grid, found {}", grid.voxel_count(), ct.voxels.size()));
  INCISE_REQUIRE(grid.spacing_mm.allFinite() && (grid.spacing_mm.array() > 0.0).all(),
                 "expected finite positive spacing");
  INCISE_REQUIRE(grid.origin_mm.allFinite() && grid.direction.allFinite(), "expected a finite origin and direction");
  INCISE_REQUIRE((grid.direction.transpose() * grid.direction).isIdentity(1e-3), "expected orthonormal axes");
}

// Returns the voxels of a mask around which a ball stays inside the mask.
Mask erode(const Mask& mask, double radius_mm, Workers& workers) {
  if (radius_mm == 0.0) return mask;
  return mask_where(distance_to(complement(mask), workers), [&](float depth) { return depth > radius_mm; });
}

// Returns the balls around the voxels of an eroded set: the opened set, which by definition stays inside the original.
Mask grow_back(Mask core, double radius_mm, Workers& workers) {
  if (radius_mm == 0.0) return core;
  return mask_where(distance_to(core, workers), [&](float distance) { return distance <= radius_mm; });
}

Mask piece_of(const Pieces& pieces, std::int32_t number) {
  return mask_where(pieces.number, [number](std::int32_t n) { return n == number; });
}

/// Returns the number of the largest piece other than `except`; 0: there is none.
std::int32_t largest(const Pieces& pieces, std::int32_t except = 0) {
  std::vector<std::size_t> sizes(static_cast<std::size_t>(pieces.count) + 1, 0);
  for (const std::int32_t number : pieces.number.voxels) ++sizes[static_cast<std::size_t>(number)];
  sizes[0] = sizes[static_cast<std::size_t>(except)] = 0;
  return static_cast<std::int32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
}

// Returns the number of the nearest piece within the opening's radius of the voxel; 0: none.
std::int32_t piece_at(const Pieces& pieces, std::size_t offset, double radius_mm) {
  const VolumeGrid& grid = pieces.number.grid;
  const std::array<int, 3> at = grid.voxel_at(offset);
  const Eigen::Array3i reach = (radius_mm / grid.spacing_mm.array()).ceil().cast<int>();
  std::int32_t piece = 0;
  double nearest_mm = std::numeric_limits<double>::infinity();
  for (int k = at[2] - reach[2]; k <= at[2] + reach[2]; ++k)
    for (int j = at[1] - reach[1]; j <= at[1] + reach[1]; ++j)
      for (int i = at[0] - reach[0]; i <= at[0] + reach[0]; ++i) {
        if (!grid.contains(i, j, k) || pieces.number.at(i, j, k) == 0) continue;
        const double distance = grid.spacing_mm.cwiseProduct(Vec3(i - at[0], j - at[1], k - at[2])).norm();
        if (distance > radius_mm || distance >= nearest_mm) continue;
        nearest_mm = distance;
        piece = pieces.number.at(i, j, k);
      }
  return piece;
}

std::int32_t choose_piece(const Pieces& pieces, const std::vector<std::size_t>& seeds,
                          const SegmentationSettings& settings) {
  if (seeds.empty()) return largest(pieces);
  std::int32_t chosen = 0;
  for (std::size_t s = 0; s < seeds.size(); ++s) {
    const std::string field = fmt::format("seed_mm[{}]", s);
    const std::int32_t piece = piece_at(pieces, seeds[s], settings.opening_radius_mm);
    if (piece == 0)
      throw CaseError("segmentation", field,
                      fmt::format("a seed in tissue thinner than opening_radius_mm {:g}", settings.opening_radius_mm),
                      "a seed that the opening keeps");
    if (chosen != 0 && piece != chosen)
      throw CaseError("segmentation", field, "a seed in another piece of tissue than seed_mm[0]",
                      "all seeds in one connected piece");
    chosen = piece;
  }
  return chosen;
}

double volume_mm3(const Mask& mask) {
  return static_cast<double>(std::count(mask.voxels.begin(), mask.voxels.end(), 1)) * mask.grid.voxel_volume_mm3();
}

Vec3 middle_of(const Mask& mask) {
  const IndexBox box = box_of(mask);
  Vec3 index;
  for (std::size_t axis = 0; axis < 3; ++axis)
    index[static_cast<Eigen::Index>(axis)] = 0.5 * (box.low[axis] + box.high[axis] - 1);
  return mask.grid.world_from_index(index);
}

/// Adds a caution if another piece is at least kLeastRivalShare as large: size then does not show which one is the
/// specimen.
void note_rival(const Pieces& pieces, std::int32_t chosen, const Mask& body, const SegmentationSettings& settings,
                Workers& workers, Segmentation& result) {
  const std::int32_t second = largest(pieces, chosen);
  if (second == 0) return;
  const Mask rival = grow_back(piece_of(pieces, second), settings.opening_radius_mm, workers);
  const double kept_mm3 = volume_mm3(body), rival_mm3 = volume_mm3(rival), share = rival_mm3 / kept_mm3;
  if (share < kLeastRivalShare) return;
  const Vec3 kept = middle_of(body), other = middle_of(rival);
  result.verdict.add(
      "scan", share,
      fmt::format("the scan shows two bodies that may be the specimen: {:.4g} mm³ round ({:.1f}, {:.1f}, {:.1f}) mm, "
                  "which is kept because it is larger, and "
                  "{:.4g} mm³ round ({:.1f}, {:.1f}, {:.1f}) mm. Name the specimen by a point inside it (seed_mm)",
                  kept_mm3, kept.x(), kept.y(), kept.z(), rival_mm3, other.x(), other.y(), other.z()),
      VerdictPlace{{}, other, "the body that is left out"}, kLeastRivalShare);
}

Mask find_body(const WorkingVolume& work, const std::vector<std::size_t>& seeds, const SegmentationSettings& settings,
               Workers& workers, Segmentation& result) {
  const Pieces pieces = find_pieces(erode(work.in_window, settings.opening_radius_mm, workers));
  if (pieces.count == 0)
    throw CaseError("segmentation", "opening_radius_mm",
                    fmt::format("{:g}, which leaves nothing", settings.opening_radius_mm),
                    "a radius smaller than half the specimen's thickness");
  result.components = static_cast<std::size_t>(pieces.count);
  const std::int32_t chosen = choose_piece(pieces, seeds, settings);
  Mask body = grow_back(piece_of(pieces, chosen), settings.opening_radius_mm, workers);
  if (seeds.empty()) note_rival(pieces, chosen, body, settings, workers, result);
  return body;
}

// Returns the background voxels without a way to the grid's first voxel, which the margin keeps outside the body.
std::vector<std::size_t> cavities(const Mask& body, std::size_t& count) {
  const Pieces outside = find_pieces(complement(body));
  std::vector<std::size_t> voxels;
  for (std::size_t v = 0; v < body.voxels.size(); ++v)
    if (outside.number.voxels[v] > 1) voxels.push_back(v);
  count = static_cast<std::size_t>(outside.count - 1);
  return voxels;
}

void fill_holes(Mask& body, Segmentation& result) {
  const std::vector<std::size_t> voxels = cavities(body, result.holes_filled);
  for (const std::size_t v : voxels) body.voxels[v] = 1;
  result.hole_voxels = voxels.size();
}

// Convolves with 2 G - G * G: it averages noise as a Gaussian G does, but shrinks round bodies less than half as much.
// It can overshoot beside a sharp step, hence the limits.
GrayVolume smoothed(const GrayVolume& occupancy, double sigma_mm, Workers& workers) {
  GrayVolume once = gaussian(occupancy, sigma_mm, workers);
  const GrayVolume twice = gaussian(once, sigma_mm, workers);
  for (std::size_t v = 0; v < once.voxels.size(); ++v)
    once.voxels[v] = std::clamp(2.0F * once.voxels[v] - twice.voxels[v], 0.0F, 1.0F);
  return once;
}

[[noreturn]] void refuse_smoothing(double smoothing_mm) {
  throw CaseError("segmentation", "smoothing_mm", fmt::format("{:g}, which leaves nothing of the body", smoothing_mm),
                  "a length shorter than the body is thick",
                  "About the longest side of a voxel that the body spans is enough; 0: no smoothing.");
}

// Reduces the occupancy to one piece above 0.5: removes crumbs beside the body and, if asked, closes cavities in it.
Mask make_one_piece(GrayVolume& occupancy, bool close_holes, double smoothing_mm) {
  const Mask all = mask_where(occupancy, [](float value) { return value >= 0.5F; });
  const Pieces pieces = find_pieces(all);
  if (pieces.count == 0) refuse_smoothing(smoothing_mm);
  Mask body = piece_of(pieces, largest(pieces));
  for (std::size_t v = 0; v < body.voxels.size(); ++v)
    if (all.voxels[v] != body.voxels[v]) occupancy.voxels[v] = 0.0F;
  if (!close_holes) return body;
  std::size_t ignored = 0;
  for (const std::size_t v : cavities(body, ignored)) {
    occupancy.voxels[v] = 1.0F;
    body.voxels[v] = 1;
  }
  return body;
}

double median_hu(const CtVolume& hu, const Mask& body, const SegmentationSettings& settings, double smoothing_mm) {
  std::vector<std::int16_t> values;
  for (std::size_t v = 0; v < body.voxels.size(); ++v)
    if (body.voxels[v] != 0 && hu.voxels[v] >= settings.window_low_hu && hu.voxels[v] <= settings.window_high_hu)
      values.push_back(hu.voxels[v]);
  if (values.empty()) refuse_smoothing(smoothing_mm);
  return median(values);
}

IndexBox grown(IndexBox box, int voxels) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] -= voxels;
    box.high[axis] += voxels;
  }
  return box;
}

/// Counts the cut voxels by face, and adds a caution if there are any. @param grid  grid of the voxels
void note_cut_faces(const VolumeGrid& grid, Segmentation& result) {
  for (const MadeVoxel& voxel : result.cut) ++result.cut_voxels.at(static_cast<std::size_t>(face_of(grid, voxel.side)));
  if (result.cut_faces() == 0) return;
  std::vector<std::string> faces;
  for (std::size_t f = 0; f < 6; ++f)
    if (result.cut_voxels[f] > 0)
      faces.push_back(fmt::format("{} ({} voxels)", to_string(static_cast<RegionFace>(f)), result.cut_voxels[f]));
  result.verdict.add(
      "scan", static_cast<double>(faces.size()),
      fmt::format("{} of 6 sides of the region of interest cut through the specimen: {}. Its skin is artificial "
                  "there. If the specimen does not reach that far, the tissue found includes its surroundings",
                  faces.size(), fmt::join(faces, ", ")));
}

/// Adds a caution if smoothing changed the volume too much: a body of a few millimetres, where the smoothing length is
/// comparable to the radius of curvature, loses a noticeable part.
void note_lost_volume(double sharp_mm3, Segmentation& result) {
  constexpr double kMostShare = 0.02;
  const double share = std::abs(result.occupancy_volume_mm3 - sharp_mm3) / std::max(result.occupancy_volume_mm3, sharp_mm3);
  if (!(result.smoothing_mm > 0.0) || !(share > kMostShare)) return;
  result.verdict.add(
      "scan", share,
      fmt::format("smoothing over {:g} mm changes the specimen's volume by {:.1f} %: this length is "
                  "too great for so small or thin a body. A shorter smoothing_mm (about a voxel) keeps the shape",
                  result.smoothing_mm, 100.0 * share));
}

enum class Source { Scan, Labels };

/// @throws CaseError that lists every violation.
void require_settings_in_range(const SegmentationSettings& settings) {
  const std::vector<Problem> problems = validate(settings);
  if (!problems.empty())
    throw CaseError("segmentation", "settings",
                    fmt::format("{} violation(s): {}", problems.size(), fmt::join(sentences(problems), "; ")),
                    "settings in their ranges");
}

Segmentation found_in(const CtVolume& ct, Source source, const SegmentationSettings& settings, Workers& workers,
                      Monitor& monitor, const std::optional<Verdict>& of_scan = {}) {
  require_settings_in_range(settings);
  require_sound_volume(ct);
  const auto report = [&](double fraction) {
    throw_if_cancelled(monitor, kStage);
    monitor.progress(kStage, fraction);
  };

  report(0.0);
  // The pad has room for the final margin and for a slight growth of the body.
  const int pad = settings.margin_voxels + kGrowth;
  const WorkingVolume whole = cut_out(ct, settings, pad, source == Source::Scan ? kAirHu : std::int16_t{0}, monitor);
  const std::vector<std::size_t> seeds = locate_seeds(ct, whole, settings);
  report(0.1);
  Segmentation result;
  Mask body = find_body(whole, seeds, settings, workers, result);
  report(0.4);
  if (settings.fill_holes) fill_holes(body, result);
  result.cut = find_cut_voxels(body, whole, ct.grid, settings.opening_radius_mm);
  result.painted = find_painted_voxels(body, whole, settings.opening_radius_mm);
  note_cut_faces(body.grid, result);
  if (source == Source::Scan) result.verdict.add(of_scan ? *of_scan : check_scan(ct));

  const IndexBox around = grown(box_of(body), pad);
  const CtVolume hu = crop(whole.hu, around);
  report(0.5);
  const GrayVolume sharp = occupancy_from_gray(hu, crop(whole.region, around), crop(body, around), settings, workers);
  result.smoothing_mm = smoothing_length_mm(settings, ct.grid.spacing_mm);
  GrayVolume occupancy = smoothed(sharp, result.smoothing_mm, workers);
  report(0.9);
  const Mask label = make_one_piece(occupancy, settings.fill_holes, result.smoothing_mm);
  if (source == Source::Scan) result.tissue_hu = median_hu(hu, label, settings, result.smoothing_mm);

  const IndexBox kept = grown(box_of(label), settings.margin_voxels);
  result.labels = crop(label, kept);
  result.occupancy = crop(occupancy, kept);
  for (std::vector<MadeVoxel>* made : {&result.cut, &result.painted})
    *made = carried_to_surface(*made, body.grid, result.labels, kCarriedLengths * result.smoothing_mm);
  result.voxels = static_cast<std::size_t>(std::count(result.labels.voxels.begin(), result.labels.voxels.end(), 1));
  result.volume_mm3 = static_cast<double>(result.voxels) * result.labels.grid.voxel_volume_mm3();
  result.occupancy_volume_mm3 = iso_volume_mm3(result.occupancy, 0.5, workers);
  note_lost_volume(iso_volume_mm3(sharp, 0.5, workers), result);
  report(1.0);
  return result;
}

/// Returns 1 where the label is tissue, 0 elsewhere.
LabelVolume tissue_of(const LabelVolume& labels, const SegmentationSettings& settings) {
  const std::array<bool, 256> is_tissue = tissue_labels(settings);
  return mask_where(labels, [&](std::uint8_t label) { return is_tissue[label]; });
}

/// @throws CaseError if the region contains no label, or a seed lies where the label is 0.
void require_labels(const LabelVolume& labels, const SegmentationSettings& settings) {
  const VolumeGrid& grid = labels.grid;
  bool is_labelled = false;
  for (std::size_t v = 0; v < labels.voxels.size() && !is_labelled; ++v) {
    if (labels.voxels[v] == 0) continue;
    const auto [i, j, k] = grid.voxel_at(v);
    is_labelled = is_in_roi(settings.roi_box_mm, grid.world_from_index(Vec3(i, j, k)));
  }
  if (!is_labelled) throw CaseError("segmentation", "labels", "0 in every voxel of the region", "labelled tissue");
  for (std::size_t s = 0; s < settings.seeds_mm.size(); ++s) {
    const Eigen::Array3i at = grid.index_from_world(settings.seeds_mm[s]).array().round().cast<int>();
    if (!grid.contains(at[0], at[1], at[2]) || labels.at(at[0], at[1], at[2]) != 0) continue;
    throw CaseError("segmentation", fmt::format("seed_mm[{}]", s), "a point where the label is 0",
                    "a point inside the labelled tissue");
  }
}

}  // namespace

void describe(Visitor& v, SegmentationSettings& s) {
  std::array<double, 2> window{s.window_low_hu, s.window_high_hu};
  v({"window_hu", "Least and greatest value of tissue.", "HU"}, window, {-1024.0, 32767.0});
  v({"roi_box_mm", "Low and high corner (LPS) of the box that holds the specimen; absent: the whole volume.", "mm"},
    s.roi_box_mm);
  std::optional<Vec3> seed;
  Points others;
  if (!s.seeds_mm.empty()) {
    seed = s.seeds_mm.front();
    others.assign(s.seeds_mm.begin() + 1, s.seeds_mm.end());
  }
  v({"seed_mm", "A point inside the specimen (LPS); absent: the largest piece is taken.", "mm"}, seed);
  v.internal("other_seeds_mm", others, "More points in the same piece.");
  v({"opening_radius_mm", "Pieces joined only by bridges thinner than twice this radius are separated.", "mm"},
    s.opening_radius_mm, {0.0, 20.0});
  v.internal("fill_holes", s.fill_holes, "Whether cavities without a way out become tissue.");
  v({"smoothing_mm",
     "Standard deviation of the Gaussian that smooths the tissue's surface; absent: 0.6, or 1.2 voxels where that is "
     "less.",
     "mm"},
    s.smoothing_mm, {0.0, 5.0});
  v("label_values", s.label_values, "Which values in `labels` are tissue; absent: all but 0.", {1.0, 255.0});
  v({"edits", "Brush strokes that correct what the window gets wrong, in order; absent: none.", "mm"}, s.edits);
  v.internal("margin_voxels", s.margin_voxels, "Voxels of air around the body.", {3.0, 50.0});
  if (!v.sets()) return;
  s.window_low_hu = window[0];
  s.window_high_hu = window[1];
  s.seeds_mm = std::move(others);
  if (seed) s.seeds_mm.insert(s.seeds_mm.begin(), *seed);
}

std::vector<Problem> validate(const SegmentationSettings& settings) {
  std::vector<Problem> problems = problems_of(settings);
  const Expect expect(problems);
  expect(settings.window_low_hu < settings.window_high_hu, "window_hu[0]", settings.window_low_hu,
         fmt::format("below the second, {}", settings.window_high_hu));
  for (std::size_t i = 0; settings.label_values && i < settings.label_values->size(); ++i) {
    const std::int32_t value = (*settings.label_values)[i];
    expect(value >= 1 && value <= 255, fmt::format("label_values[{}]", i), value, "1 to 255");
  }
  for (std::size_t e = 0; settings.edits && e < settings.edits->size(); ++e) {
    const std::size_t points = (*settings.edits)[e].path_mm.size();
    expect(points > 0, fmt::format("edits[{}].path_mm", e), static_cast<double>(points), "at least one point");
  }
  if (!settings.roi_box_mm) return problems;
  const Vec3 low = settings.roi_box_mm->min(), high = settings.roi_box_mm->max();
  for (int axis = 0; axis < 3; ++axis) {
    expect(!(low[axis] >= high[axis]), fmt::format("roi_box_mm[0][{}]", axis), low[axis],
           fmt::format("below that of the second corner, {}", high[axis]));
  }
  return problems;
}

double smoothing_length_mm(const SegmentationSettings& settings, const Vec3& spacing_mm) {
  constexpr double kUsualMm = 0.6;
  constexpr double kVoxels = 1.2;
  return settings.smoothing_mm.value_or(std::min(kUsualMm, kVoxels * spacing_mm.maxCoeff()));
}

int Segmentation::cut_faces() const {
  return static_cast<int>(std::count_if(cut_voxels.begin(), cut_voxels.end(), [](std::size_t n) { return n > 0; }));
}

std::array<bool, 256> tissue_labels(const SegmentationSettings& settings) {
  std::array<bool, 256> is_tissue{};
  if (settings.label_values) {
    for (const std::int32_t value : *settings.label_values) is_tissue.at(static_cast<std::size_t>(value)) = true;
  } else {
    std::fill(is_tissue.begin() + 1, is_tissue.end(), true);
  }
  return is_tissue;
}

Segmentation segment(const CtVolume& ct, const SegmentationSettings& settings, Workers& workers, Monitor& monitor,
                     const std::optional<Verdict>& of_scan) {
  return found_in(ct, Source::Scan, settings, workers, monitor, of_scan);
}

Segmentation segment_labels(const LabelVolume& labels, const SegmentationSettings& settings, Workers& workers,
                            Monitor& monitor) {
  INCISE_REQUIRE(
      labels.voxels.size() == labels.grid.voxel_count(),
      fmt::format("expected {} voxels for the grid, found {}", labels.grid.voxel_count(), labels.voxels.size()));
  require_settings_in_range(settings);
  const LabelVolume tissue = tissue_of(labels, settings);
  require_labels(tissue, settings);
  const CtVolume two_valued{labels.grid, {tissue.voxels.begin(), tissue.voxels.end()}};
  SegmentationSettings between = settings;
  between.window_low_hu = 0.5;
  between.window_high_hu = 1.5;
  return found_in(two_valued, Source::Labels, between, workers, monitor);
}

}  // namespace incise
