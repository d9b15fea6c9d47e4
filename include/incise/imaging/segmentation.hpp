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
#include <vector>

namespace incise {

/// A stroke of a brush over a scan: adds the voxels whose centres lie within `radius_mm` of its path to the tissue, or
/// removes them, whatever their value. LPS world coordinates, so a stroke does not depend on a grid.
struct TissueEdit {
  bool is_tissue = true;
  double radius_mm = 1.0;
  Points path_mm;  ///< joined by straight lines; one point: a ball
};
inline void describe(Visitor& v, TissueEdit& e) {
  v("tissue", e.is_tissue, "Whether the stroke adds tissue; otherwise it removes tissue.");
  v({"radius_mm", "Radius of the brush.", "mm"}, e.radius_mm, {0.1, 50.0});
  v({"path_mm", "Points (LPS) along the middle of the stroke.", "mm"}, e.path_mm);
}

/// Which part of a CT, or of a label volume, is the specimen. Lengths in mm, LPS world coordinates. Labels do not use
/// the window.
struct SegmentationSettings {
  double window_low_hu = -20.0;    ///< least HU of tissue (inclusive)
  double window_high_hu = 180.0;   ///< greatest HU of tissue (inclusive)
  std::optional<Box3> roi_box_mm;  ///< voxels with centres outside are not tissue; absent: the whole volume
  Points seeds_mm;                 ///< points inside the specimen, all in one piece; empty: take the largest piece
  double opening_radius_mm =
      0.0;                    ///< pieces joined only by bridges thinner than twice this are separated; 0: none; [0, 20]
  bool fill_holes = true;     ///< cavities without a way out through voxel faces become tissue, whatever their HU
  std::optional<double> smoothing_mm;  ///< smoothing of the occupancy, [0, 5]; 0: none; absent: see smoothing_length_mm
  std::optional<std::vector<std::int32_t>> label_values;  ///< labels that are tissue; absent: all but 0
  std::optional<std::vector<TissueEdit>> edits;  ///< applied in order, after the window and before a piece is chosen
  int margin_voxels = 4;      ///< air around the body, also where the region of interest cuts through it; [3, 50]
};
void describe(Visitor& v, SegmentationSettings& s);

/// Returns every violation; empty if the settings are valid.
[[nodiscard]] std::vector<Problem> validate(const SegmentationSettings& settings);

/// Returns the standard deviation, mm, of the smoothing of the occupancy: `settings.smoothing_mm` or, if absent, the
/// lesser of 0.6 mm and 1.2 times the longest side of a voxel, because a finer scan shows smaller detail.
[[nodiscard]] double smoothing_length_mm(const SegmentationSettings& settings, const Vec3& spacing_mm);

/// The six sides of the region of interest (or of the volume), in the order -x, +x, -y, +y, -z, +z (LPS).
enum class RegionFace { Right, Left, Anterior, Posterior, Inferior, Superior };
inline constexpr std::array<std::string_view, 6> kRegionFaceNames{"right",     "left",     "anterior",
                                                                  "posterior", "inferior", "superior"};
[[nodiscard]] constexpr Names names_of(RegionFace) {
  return kRegionFaceNames;
}

/// A labelled voxel with an artificial side: there the region of interest, or the end of the volume, cuts through the
/// tissue, or a stroke of the brush made the surface.
struct MadeVoxel {
  std::int32_t voxel = 0;  ///< its offset in the labels' array
  std::int32_t side = 0;   ///< the artificial side, along the grid: 0 to 5 are -i, +i, -j, +j, -k, +k
};
inline void describe(Visitor& v, MadeVoxel& c) {
  v("voxel", c.voxel, "Place of the voxel in the labels' array.");
  v("side", c.side, "Artificial side of the voxel: 0 to 5 are -i, +i, -j, +j, -k, +k.");
}

/// The specimen found in a CT. Both volumes share one grid, the body's box with a margin of air, which may extend
/// beyond the CT.
struct Segmentation {
  LabelVolume labels;    ///< 1 where the occupancy is at least 0.5
  GrayVolume occupancy;  ///< fraction of each voxel that is tissue, [0, 1], smooth; its 0.5 iso-surface is the skin

  std::size_t voxels = 0;             ///< labelled voxels
  double volume_mm3 = 0.0;            ///< of the labelled voxels
  double occupancy_volume_mm3 = 0.0;  ///< inside the 0.5 iso-surface of the trilinear occupancy: what a mesher sees
  std::optional<double> tissue_hu;    ///< median over the labelled voxels in the window; absent: from labels
  std::size_t components = 0;         ///< separate pieces after the opening's erosion, before one is chosen
  std::size_t holes_filled = 0;       ///< filled cavities
  std::size_t hole_voxels = 0;        ///< voxels of these cavities
  /// For each RegionFace: body voxels where the tissue continues beyond it, so that the region or the volume cuts it.
  std::array<std::size_t, 6> cut_voxels{};
  std::vector<MadeVoxel> cut;           ///< labelled voxels at these cuts, once for each side
  std::vector<MadeVoxel> painted;       ///< labelled voxels at a side that the edits made
  double smoothing_mm = 0.0;            ///< smoothing used, see smoothing_length_mm
  Verdict verdict;                      ///< reasons to doubt this tissue, see `segment`
  [[nodiscard]] int cut_faces() const;  ///< number of RegionFaces that cut through tissue
};
inline void describe(Visitor& v, Segmentation& s) {
  v.bulk("labels", s.labels, "Labels; 1: tissue.");
  v.bulk("occupancy", s.occupancy, "Fraction of each voxel that is tissue, smoothed.");
  v("voxels", s.voxels, "Number of tissue voxels.");
  v("volume_mm3", s.volume_mm3, "Volume of the tissue voxels.");
  v("occupancy_volume_mm3", s.occupancy_volume_mm3, "Volume inside the 0.5 iso-surface of the occupancy.");
  v("tissue_hu", s.tissue_hu, "Median over the tissue voxels in the window; absent: the tissue was given as labels.");
  v("components", s.components, "Number of separate pieces in the window, before one was chosen.");
  v("holes_filled", s.holes_filled, "Number of cavities that were filled.");
  v("hole_voxels", s.hole_voxels, "Number of voxels in these cavities.");
  v("cut_voxels", s.cut_voxels,
    "Number of body voxels at each face of the region where the tissue continues beyond the face.");
  v.bulk("cut", s.cut, "Labelled voxels at these cuts.");
  v.bulk("painted", s.painted, "Labelled voxels at a side that the edits made.");
  v.derived("cut_faces", s.cut_faces(), "Number of faces of the region that cut through tissue.");
  v("smoothing_mm", s.smoothing_mm, "Smoothing length that was used.");
  v("verdict", s.verdict, "Verdict on this tissue.");
}

/// Returns, for each value of a label volume, whether it is tissue: `label_values` or, if absent, every value but 0.
[[nodiscard]] std::array<bool, 256> tissue_labels(const SegmentationSettings& settings);

/// Finds the specimen in a CT: one clean tissue label and its sub-voxel occupancy.
/// Steps: window and region -> edits by hand -> pieces (face-connected; separated by erosion with a ball, then grown
/// back) -> the seed's or the largest piece -> 3D hole filling -> occupancy from the CT's own gray values -> smoothing
/// -> label where >= 0.5.
/// Within 2.3 voxels of the body's border, the occupancy is (HU - outside)/(inside - outside), limited to [0, 1]. Here
/// inside and outside are local means of pure tissue and of pure surroundings (air, fat, plastic or bone alike). Where
/// the region or the opening cuts through tissue, the occupancy is 0 or 1. Smoothing convolves with 2 G - G * G, G a
/// Gaussian of standard deviation smoothing_length_mm(). It averages noise and steps as G does, and moves a skin of
/// mean curvature H inwards by 0.45 smoothing² H, less than half as far as G.
/// The verdict has a caution `scan` if the region or the end of the volume cuts through the body (a leak, or tissue cut
/// on purpose); if, without a seed, another piece is at least a quarter as large as the chosen one; if smoothing
/// changes the volume by more than 2 %; and for each caution of check_scan.
/// @param of_scan  result of check_scan(ct), to save time if the CT is segmented repeatedly; absent: computed here.
/// @throws CaseError for invalid settings (all violations listed), a region or a seed outside the volume, a seed
/// outside the window or the region or in a part that the opening removes, seeds in separate pieces, nothing in the
/// window, or smoothing that leaves nothing.
/// @throws InvalidArgument for a volume without voxels or of the wrong length, or a grid that is not finite, positive
/// and orthonormal.
/// @throws Cancelled on request.
/// @note O(voxels of the region); about a second for 150 x 160 x 100 on one thread. Same bits at any thread count.
[[nodiscard]] Segmentation segment(const CtVolume& ct, const SegmentationSettings& settings, Workers& workers,
                                   Monitor& monitor, const std::optional<Verdict>& of_scan = {});

/// Finds the specimen in a label volume; see `segment` and tissue_labels(). The occupancy is 0 or 1 before smoothing,
/// so the voxel size limits the accuracy of the skin. The window is not used, and the HU are not checked.
/// @throws as `segment`; also CaseError if no voxel of the region is tissue, or a seed lies where none is.
[[nodiscard]] Segmentation segment_labels(const LabelVolume& labels, const SegmentationSettings& settings,
                                          Workers& workers, Monitor& monitor);

}  // namespace incise
