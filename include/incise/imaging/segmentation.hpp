#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/monitor.hpp>
#include <incise/core/names.hpp>
#include <incise/core/problem.hpp>
#include <incise/core/verdict.hpp>
#include <incise/core/workers.hpp>
#include <incise/geometry/volume.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace incise {

/// A stroke of a brush over a scan: the voxels whose centres lie within `radius_mm` of its path are tissue, or are not,
/// whatever their value is. LPS world coordinates, so a stroke depends on no grid.
struct TissueEdit {
  bool is_tissue = true;
  double radius_mm = 1.0;
  Points path_mm;  ///< joined by straight lines; one point: a ball
};
inline void describe(Visitor& v, TissueEdit& e) {
  v("tissue", e.is_tissue, "Whether the stroke makes tissue; else it takes tissue away.");
  v({"radius_mm", "Of the brush.", "mm"}, e.radius_mm, {0.1, 50.0});
  v({"path_mm", "Points (LPS) of the stroke's middle.", "mm"}, e.path_mm);
}

/// Which part of a CT, or of a label volume, is the specimen. Lengths mm, LPS world coordinates. Labels need no window.
struct SegmentationSettings {
  double window_low_hu = -20.0;    ///< the tissue's least HU (inclusive)
  double window_high_hu = 180.0;   ///< and greatest (inclusive)
  std::optional<Box3> roi_box_mm;  ///< voxel centres outside are not tissue; none: the whole volume
  Points seeds_mm;                 ///< points inside the specimen, all in one piece; empty: the largest piece
  double opening_radius_mm =
      0.0;                    ///< pieces joined only by bridges thinner than twice this are separated; 0: none; [0, 20]
  bool fill_holes = true;     ///< cavities without a way out through voxel faces become tissue, whatever their HU
  std::optional<double> smoothing_mm;  ///< length over which the occupancy is smoothed; 0: none; [0, 5]; absent: see smoothing_length_mm
  std::optional<std::vector<std::int32_t>> label_values;  ///< labels that are tissue; absent: all but 0
  std::optional<std::vector<TissueEdit>> edits;  ///< of what the window finds, in their order; before pieces are chosen
  int margin_voxels = 4;      ///< of air around the body, also where the region of interest cuts through it; [3, 50]
};
void describe(Visitor& v, SegmentationSettings& s);

/// Every violation; empty: valid.
[[nodiscard]] std::vector<Problem> validate(const SegmentationSettings& settings);

/// What the occupancy is smoothed over: as the settings say, else 0.6 mm, or 1.2 of the longest side of a voxel where that is less: the
/// finer the scan, the smaller what it shows.
[[nodiscard]] double smoothing_length_mm(const SegmentationSettings& settings, const Vec3& spacing_mm);

/// The sides of the region of interest (or of the volume) that cut through the body, in this order.
enum class RegionFace { Right, Left, Anterior, Posterior, Inferior, Superior };
inline constexpr std::array<std::string_view, 6> kRegionFaceNames{"right",     "left",     "anterior",
                                                                  "posterior", "inferior", "superior"};
[[nodiscard]] constexpr Names names_of(RegionFace) {
  return kRegionFaceNames;
}

/// A labelled voxel at a face of the body that is not the specimen's own: the region of interest, or the end of the
/// volume, has made it by cutting through tissue, or a stroke of the brush has.
struct MadeVoxel {
  std::int32_t voxel = 0;  ///< its place in the labels' array
  std::int32_t side = 0;   ///< of the voxel that was made, along the grid: 0 to 5 are -i, +i, -j, +j, -k, +k
};
inline void describe(Visitor& v, MadeVoxel& c) {
  v("voxel", c.voxel, "Its place in the labels' array.");
  v("side", c.side, "Of the voxel that was made: 0 to 5 are -i, +i, -j, +j, -k, +k.");
}

/// The specimen found in a CT. Both volumes share one grid: the body's box and a margin of air. It may reach beyond the
/// CT's own grid.
struct Segmentation {
  LabelVolume labels;    ///< 1 where the occupancy is at least 0.5
  GrayVolume occupancy;  ///< share of each voxel that is tissue, [0, 1], smooth; its 0.5 iso-surface is the body's skin

  std::size_t voxels = 0;             ///< labelled
  double volume_mm3 = 0.0;            ///< of the labelled voxels
  double occupancy_volume_mm3 = 0.0;  ///< inside the 0.5 iso-surface of the trilinear occupancy: what a mesher sees
  std::optional<double> tissue_hu;    ///< median over the labelled voxels that lie in the window; absent: from labels
  std::size_t components = 0;    ///< separate pieces in the window (after the opening's erosion), before one was chosen
  std::size_t holes_filled = 0;  ///< cavities
  std::size_t hole_voxels = 0;   ///< and their voxels
  /// Body voxels at each RegionFace beyond which tissue goes on: > 0 where the region or the volume cuts through it
  std::array<std::size_t, 6> cut_voxels{};
  std::vector<MadeVoxel> cut;           ///< where the label begins beneath these, once for each side
  std::vector<MadeVoxel> painted;       ///< where it begins beneath a side that the edits made
  double smoothing_mm = 0.0;            ///< that was taken
  Verdict verdict;                      ///< what argues against this tissue: check_scan, and a body that the region cuts off
  [[nodiscard]] int cut_faces() const;  ///< how many of the six cut through tissue
};
inline void describe(Visitor& v, Segmentation& s) {
  v.bulk("labels", s.labels, "1: tissue.");
  v.bulk("occupancy", s.occupancy, "Share of each voxel that is tissue, smooth.");
  v("voxels", s.voxels, "That are tissue.");
  v("volume_mm3", s.volume_mm3, "Of these voxels.");
  v("occupancy_volume_mm3", s.occupancy_volume_mm3, "Inside the 0.5 iso-surface of the occupancy.");
  v("tissue_hu", s.tissue_hu,
    "Median over the voxels that are tissue and lie in the window; absent: the tissue was given as labels.");
  v("components", s.components, "Separate pieces in the window, before one was chosen.");
  v("holes_filled", s.holes_filled, "Cavities.");
  v("hole_voxels", s.hole_voxels, "Voxels of the cavities.");
  v("cut_voxels", s.cut_voxels, "Voxels of the body at each face of the region, where tissue goes on beyond it.");
  v.bulk("cut", s.cut, "Where the label begins beneath these voxels.");
  v.bulk("painted", s.painted, "Where the label begins beneath a side that the edits made.");
  v.derived("cut_faces", s.cut_faces(), "How many faces of the region cut through tissue.");
  v("smoothing_mm", s.smoothing_mm, "Length that was taken.");
  v("verdict", s.verdict, "On this tissue.");
}

/// Which values of a label volume are tissue: every one but 0, or those of `label_values`.
[[nodiscard]] std::array<bool, 256> tissue_labels(const SegmentationSettings& settings);

/// CT -> one clean tissue label and its sub-voxel occupancy.
/// Steps: window and region -> edits by hand -> pieces (face-connected; separated by erosion with a ball, grown back
/// within the window)
/// -> the seed's or the largest piece -> 3D hole filling -> occupancy from the CT's own gray values -> smoothing ->
/// label where >= 0.5. The occupancy of a voxel within two voxels of the body's border is (HU - outside)/(inside -
/// outside), limited to [0, 1], where inside and outside are means of the pure tissue and the pure surroundings near by
/// (air, fat, plastic or bone alike); where the region or the opening cuts through tissue it is 0 or 1. Smoothing
/// convolves with 2 G - G * G, G a Gaussian of standard deviation `smoothing_length_mm`: it averages noise and steps as
/// G does and moves a skin of mean curvature H inwards by 0.45 smoothing² H, less than half as far as G. Its verdict
/// has a caution `scan` when the body touches the region's sides (a leak, or tissue cut on purpose), when without a
/// seed another piece is at least a quarter as large as the one that is kept, and those of check_scan.
/// @param of_scan  what check_scan says of the CT, for one that is segmented again and again; absent: it is asked.
/// @throws CaseError: settings invalid (all violations listed), region or a seed outside the volume, a seed outside the
/// window or the region
///         or in a part that the opening removes, seeds in separate pieces, nothing in the window, smoothing that
///         leaves nothing.
/// @throws InvalidArgument: a volume without voxels, of the wrong length, or with a non-finite or non-positive grid.
/// @throws Cancelled.
/// @note O(voxels of the region); about a second for 150 x 160 x 100 on one thread. Same bits at any thread count.
[[nodiscard]] Segmentation segment(const CtVolume& ct, const SegmentationSettings& settings, Workers& workers,
                                   Monitor& monitor, const std::optional<Verdict>& of_scan = {});

/// The same from labels that somebody drew: every label but 0 is tissue, or those of `label_values`. The occupancy is 0
/// or 1 before it is smoothed, so the skin is as accurate as the voxels are small. The window is not used, and the
/// verdict says nothing of HU.
/// @throws as `segment`; CaseError where no voxel of the region has a label, or a seed lies where the label is 0.
[[nodiscard]] Segmentation segment_labels(const LabelVolume& labels, const SegmentationSettings& settings,
                                          Workers& workers, Monitor& monitor);

}  // namespace incise
