#pragma once

#include <incise/core/defaults.hpp>
#include <incise/core/describe.hpp>
#include <incise/core/problem.hpp>
#include <incise/geometry/contour.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise {

/// Edge lengths of a graded mesh: short in a band around the cut, long elsewhere.
struct SizingSettings {
  double fine_mm = 0.8;
  double coarse_mm = 4.0;
  double growth = 0.36;
  double band_inside_mm = 4.0;
  double band_outside_mm = 2.0;
  double band_below_mm = 1.5;
};
inline void describe(Visitor& v, SizingSettings& s) {
  v({"fine_mm", "Edge length inside the band around the cut, at most coarse_mm.", "mm"}, s.fine_mm, kPositive);
  v({"coarse_mm", "Longest edge length.", "mm"}, s.coarse_mm, kPositive);
  v("growth", s.growth, "Edge length gained per distance from the band, mm per mm.", kPositive);
  v({"band_inside_mm", "Width of the band on the inside of a closed path, the side to which tissue is dragged.", "mm"},
    s.band_inside_mm, kNotNegative);
  v({"band_outside_mm", "Width of the band on the outside; an open cut has the larger width on both sides.", "mm"},
    s.band_outside_mm, kNotNegative);
  v({"band_below_mm", "Depth of the band below the tip of the tool.", "mm"}, s.band_below_mm, kNotNegative);
}

/// Returns the default settings for a body with this longest side, mm. From 40 mm on they are the defaults; for a
/// smaller body, `fine_mm` and `coarse_mm` shrink in proportion. For 0 (no body, which the mesher refuses) they are the
/// defaults too.
[[nodiscard]] SizingSettings default_lengths(double longest_side_mm);

/// Returns every violation; empty if the settings are valid.
[[nodiscard]] std::vector<Problem> validate(const SizingSettings& settings);

/// The planned cut, round which the mesh is fine.
struct PlannedCut {
  Contour path;  ///< N x 3, mm, LPS, on the surface of the body at rest
  Vec3 approach = -Vec3::UnitZ();  ///< points into the tissue; need not be unit
  double depth_mm = kPlannedDepthMm;  ///< depth of the tool's tip below the path, along `approach`, > 0
};

/// The requested edge length h at every point (mm, LPS): `fine_mm` in the band around the surface that the needle
/// sweeps (path x depth, widened by the band widths), and h = min(fine + growth d, coarse) at distance d from the band.
/// Immutable. Evaluation is exact; O(path points).
class SizingField {
 public:
  /// Returns a field of one edge length everywhere. @throws InvalidArgument unless 0 < edge_mm < infinity.
  [[nodiscard]] static SizingField uniform(double edge_mm);

  /// Returns a field that is fine around a cut. Paths of more than 256 points are resampled to 256.
  /// @throws InvalidArgument listing every violation of the settings and of the cut (fewer than 2 points, 3 if closed;
  /// a coordinate that is not finite; length 0; zero approach; depth <= 0).
  [[nodiscard]] static SizingField around_cut(const PlannedCut& cut, const SizingSettings& settings = {});

  [[nodiscard]] double edge_length_mm(const Vec3& p) const { return edge_length_at_mm(distance_to_band_mm(p)); }
  /// Returns the distance, mm, to the band; 0 inside it, and everywhere for a uniform field.
  [[nodiscard]] double distance_to_band_mm(const Vec3& p) const;
  /// Returns the edge length, mm, at a distance from the band.
  [[nodiscard]] double edge_length_at_mm(double distance_to_band_mm) const;
  [[nodiscard]] bool has_band() const { return band_.has_value(); }
  /// Returns whether p lies in the band; false everywhere for a uniform field.
  [[nodiscard]] bool is_in_band(const Vec3& p) const { return band_ && distance_to_band_mm(p) <= 0.0; }

  /// Returns the field with `fine_mm` and `coarse_mm` multiplied by the factor; band and growth stay the same.
  /// @throws InvalidArgument unless the factor is finite and > 0.
  [[nodiscard]] SizingField scaled(double factor) const;
  [[nodiscard]] const SizingSettings& settings() const { return settings_; }

 private:
  struct Band {
    ViewFrame view;
    Contour path;  ///< in the view's frame: x, y, height; mm
    double inside_mm = 0.0;
    double outside_mm = 0.0;
    double above_mm = 0.0;
    double below_mm = 0.0;
  };
  SizingSettings settings_;
  std::optional<Band> band_;
};

}  // namespace incise
