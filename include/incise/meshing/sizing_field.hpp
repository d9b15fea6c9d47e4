#pragma once

#include <incise/core/defaults.hpp>
#include <incise/core/describe.hpp>
#include <incise/core/problem.hpp>
#include <incise/geometry/contour.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise {

/// Edge lengths of a graded mesh: short where the needle and its neighbourhood pass, long elsewhere.
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
  v({"band_inside_mm", "Band towards the inside of a closed path: the tissue is dragged that way.", "mm"},
    s.band_inside_mm, kNotNegative);
  v({"band_outside_mm", "Band away from it; an open cut has the larger width on both sides.", "mm"}, s.band_outside_mm,
    kNotNegative);
  v({"band_below_mm", "Band below the tip of the tool.", "mm"}, s.band_below_mm, kNotNegative);
}

/// The settings with the edge lengths of a body whose longest side is this long: the default ones are made for 40 mm and more, a smaller
/// body has them in proportion. No body (0, refused by the mesher): those of a large one.
[[nodiscard]] SizingSettings default_lengths(double longest_side_mm);

/// Everything that is wrong with the settings, a sentence each; empty: usable.
[[nodiscard]] std::vector<Problem> validate(const SizingSettings& settings);

/// The cut that a mesh is made for.
struct PlannedCut {
  Contour path;  ///< N x 3, mm, LPS, on the surface of the body as it lies in the CT (rest configuration)
  Vec3 approach = -Vec3::UnitZ();  ///< points into the tissue; need not be unit
  double depth_mm = kPlannedDepthMm;  ///< of the tip of the tool below the path, along `approach`, > 0
};

/// The wanted edge length at every point of space, mm, LPS: `fine_mm` in the band around the wall that the needle
/// sweeps (path x depth, widened by the band widths), then growing linearly with the distance d from the band: h =
/// min(fine + growth d, coarse). Immutable; evaluation is exact and costs O(path points).
class SizingField {
 public:
  /// The same edge length everywhere. @throws InvalidArgument unless 0 < edge_mm < infinity.
  [[nodiscard]] static SizingField uniform(double edge_mm);

  /// Fine around a cut. Paths of more than 256 points are resampled to 256.
  /// @throws InvalidArgument listing every violation of the settings and of the cut (fewer than 2 points, 3 if closed;
  /// a coordinate that is not finite; zero approach; depth <= 0).
  [[nodiscard]] static SizingField around_cut(const PlannedCut& cut, const SizingSettings& settings = {});

  [[nodiscard]] double edge_length_mm(const Vec3& p) const { return edge_length_at_mm(distance_to_band_mm(p)); }
  /// 0 inside the band; 0 everywhere for a uniform field.
  [[nodiscard]] double distance_to_band_mm(const Vec3& p) const;
  /// The edge length at a distance from the band.
  [[nodiscard]] double edge_length_at_mm(double distance_to_band_mm) const;
  [[nodiscard]] bool has_band() const { return band_.has_value(); }
  /// Whether p lies in the band that is meshed finely; false everywhere for a uniform field.
  [[nodiscard]] bool is_in_band(const Vec3& p) const { return band_ && distance_to_band_mm(p) <= 0.0; }

  /// The field with `fine_mm` and `coarse_mm` multiplied by the factor; band and growth stay. @pre factor > 0, finite.
  [[nodiscard]] SizingField scaled(double factor) const;
  [[nodiscard]] const SizingSettings& settings() const { return settings_; }

 private:
  struct Band {
    ViewFrame view;
    Points path;  ///< in the view: x, y, height
    bool is_closed = true;
    double inside_mm = 0.0;
    double outside_mm = 0.0;
    double above_mm = 0.0;
    double below_mm = 0.0;
  };
  SizingSettings settings_;
  std::optional<Band> band_;
};

}  // namespace incise
