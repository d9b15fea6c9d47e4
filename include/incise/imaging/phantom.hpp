#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/monitor.hpp>
#include <incise/core/problem.hpp>
#include <incise/geometry/contour.hpp>
#include <incise/geometry/tet_mesh.hpp>
#include <incise/geometry/volume.hpp>
#include <incise/imaging/tongue_shape.hpp>

#include <cstdint>
#include <vector>

namespace incise {

/// Specimen, tumour and virtual scanner of a synthetic CT.
struct PhantomSettings {
  std::uint64_t seed = 1;
  TongueShapeSettings shape;

  Vec3 spacing_mm = Vec3::Constant(0.8);
  double tissue_hu = 55.0;
  double texture_hu = 6.0;
  double noise_hu = 15.0;
  double blur_mm = 0.4;
  double holder_hu = -100.0;
  double holder_thickness_mm = 8.0;
  double field_of_view_mm = 0.0;

  double tumor_diameter_mm = 20.0;
  double tumor_irregularity = 0.10;
  double tumor_depth_mm = 4.0;
  double tumor_position = 0.46;
  int tumor_points = 120;
};
inline void describe(Visitor& v, PhantomSettings& s) {
  v("seed", s.seed, "Seed of shape, texture and noise.");
  v("shape", s.shape, "Mean size, and how much specimens differ from each other.");
  v({"spacing_mm", "Spacing of the voxels.", "mm"}, s.spacing_mm, {0.3, 3.0});
  v({"tissue_hu", "Value of muscle.", "HU"}, s.tissue_hu, {0.0, 120.0});
  v({"texture_hu", "Standard deviation of the slow change within the muscle.", "HU"}, s.texture_hu, {0.0, 30.0});
  v({"noise_hu", "Standard deviation of the scanner's noise.", "HU"}, s.noise_hu, {0.0, 60.0});
  v({"blur_mm", "Standard deviation of the scanner's point spread.", "mm"}, s.blur_mm, {0.0, 2.0});
  v({"holder_hu", "Value of the board beneath: low-density polyethylene.", "HU"}, s.holder_hu, {-1000.0, 1500.0});
  v({"holder_thickness_mm", "Thickness of the board; 0: no board.", "mm"}, s.holder_thickness_mm, {0.0, 30.0});
  v({"field_of_view_mm", "Above 0: square slices of this size, padding outside the circle; 0: a tight grid.", "mm"},
    s.field_of_view_mm, {0.0, 600.0});
  v({"tumor_diameter_mm", "Mean diameter of the tumour, seen from above.", "mm"}, s.tumor_diameter_mm, {8.0, 24.0});
  v("tumor_irregularity", s.tumor_irregularity, "Sum of the amplitudes of harmonics 2 to 6 over the radius.",
    {0.0, 0.25});
  v({"tumor_depth_mm", "Depth of the tumour's bowl beneath its edge.", "mm"}, s.tumor_depth_mm, {1.0, 8.0});
  v("tumor_position", s.tumor_position, "Centre of the tumour, as a share of the length from the tip.", {0.4, 0.6});
  v("tumor_points", s.tumor_points, "Number of points of the tumour edge.", {24.0, 1000.0});
}

/// Returns every violation; empty if the settings are valid.
[[nodiscard]] std::vector<Problem> validate(const PhantomSettings& settings);

/// A virtual specimen's CT and its truth. mm, LPS; tip anterior (-y), back of the tongue up (+z).
struct Phantom {
  CtVolume ct;                          ///< HU, limited to a 12-bit scanner's range [-1024, 3071]
  TongueShape shape;                    ///< exact shape
  double true_volume_mm3 = 0.0;         ///< of the shape, by quadrature
  Contour tumor_edge;                   ///< closed, on the back at rest, counter-clockwise seen from above (+z)
  TriMesh tumor;                        ///< closed surface of the tumour: the back inside the edge and a bowl beneath
  Vec3 tumor_center_mm = Vec3::Zero();  ///< on the surface
  double tissue_below_tumor_mm = 0.0;   ///< thickness of the tissue, tumour included, at the tumour's centre
  double tip_end_mm = 0.0;              ///< y of the tip
  double posterior_end_mm = 0.0;        ///< y of the root
  double platform_z_mm = 0.0;           ///< z of the plane on which the underside rests
};

/// Makes a tongue-like specimen on a plastic board and its CT: exact shape -> partial volume (exact along z, 5 x 5
/// columns per voxel) -> HU of air, board and textured muscle -> point spread -> correlated noise -> whole HU.
/// The same settings give the same bits. Shape and tumour depend only on the seed and their own settings, not on the
/// scanner's. The default board touches the underside and has about -100 HU (low-density polyethylene); a window from
/// -20 HU upwards excludes it.
/// @throws CaseError listing every violation of `settings`; InvalidArgument if the tumour does not fit on the back;
/// Cancelled on request.
[[nodiscard]] Phantom make_phantom(const PhantomSettings& settings, Monitor& monitor);

/// Returns the CT of a given shape, made as in make_phantom(). Of the settings, uses only the seed and those of
/// scanner, board and texture. Texture and noise differ from those of make_phantom() with the same seed.
/// @throws CaseError listing every violation of `settings`; Cancelled on request.
[[nodiscard]] CtVolume scan_shape(const TongueShape& shape, const PhantomSettings& settings, Monitor& monitor);

}  // namespace incise
