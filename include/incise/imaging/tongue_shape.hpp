#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/random.hpp>
#include <incise/geometry/types.hpp>

#include <array>
#include <optional>

namespace incise {

/// Mean size of tongue-like specimens, mm, and how much they vary.
struct TongueShapeSettings {
  double length_mm = 110.0;
  double width_mm = 55.0;
  double height_mm = 35.0;
  double variation = 0.05;
  double bend_mm = 2.0;
  double asymmetry = 0.04;
  double bump_mm = 1.2;
};
inline void describe(Visitor& v, TongueShapeSettings& s) {
  v({"length_mm", "Mean length, tip to root (y).", "mm"}, s.length_mm, {80.0, 160.0});
  v({"width_mm", "Mean width, left to right (x).", "mm"}, s.width_mm, {46.0, 80.0});
  v({"height_mm", "Mean height, platform to the top of the back (z).", "mm"}, s.height_mm, {30.0, 50.0});
  v("variation", s.variation, "Greatest relative change of length, width and height.", {0.0, 0.08});
  v({"bend_mm", "Greatest sideways bow of the mid-line.", "mm"}, s.bend_mm, {0.0, 5.0});
  v("asymmetry", s.asymmetry, "Greatest relative difference of a half width from the mean.", {0.0, 0.1});
  v({"bump_mm", "Greatest height of the low-frequency bumps on the back.", "mm"}, s.bump_mm, {0.0, 2.0});
}

/// One long wave of the back's relief: amplitude_mm cos(wave · (x, y) + phase).
struct SurfaceWave {
  double amplitude_mm = 0.0;
  Vec2 wave_per_mm = Vec2::Zero();
  double phase = 0.0;
};

/// A closed, smooth tongue on the plane z = 0, known exactly: over each point (x, y) inside its outline, the tissue is
/// one interval of z. LPS: the tip at y = -length/2 (anterior), the root at +length/2, the back up (+z). The share s in
/// [0, 1] of the length runs from tip to root. Half width a, upper height h and lower depth d start and end at 0 as the
/// square root of the distance from the end, so both ends are round. With u = (x - mid-line)/a in [-1, 1], the upper
/// side is the superellipse z = c + h (1 - |u|^p)^(1/q). The lower side is one too, cut flat by the platform with a
/// rounded edge.
///
///            ________----------________
///      ___---                          \      z
///     (__                               |     |
///        \______________________________/     +-- y       s = 0 at the left
///     ======================================  z = 0, the platform
struct TongueShape {
  double length_mm = 110.0;
  double width_mm = 55.0;
  double height_mm = 35.0;
  double waist_mm = 9.0;        ///< c: height of the widest outline above the platform
  double back_taper = 0.7;      ///< s at which the back reaches its full height
  double outline_taper = 0.55;  ///< s at which the outline reaches its full width
  double bend_mm = 0.0;         ///< sideways bow of the mid-line, signed
  double asymmetry = 0.0;       ///< left half width = a (1 + asymmetry), right = a (1 - asymmetry)
  std::array<SurfaceWave, 6> relief{};
};

/// Draws a random shape; the same state of `random` gives the same shape. @throws InvalidArgument listing every
/// violation of `settings`.
[[nodiscard]] TongueShape draw_tongue_shape(const TongueShapeSettings& settings, Random& random);

/// The interval of z, mm, that the tissue occupies over one point of the platform.
struct TissueSpan {
  double low_mm = 0.0;
  double high_mm = 0.0;
};

/// Returns the tissue over (x, y); nullopt outside the outline.
[[nodiscard]] std::optional<TissueSpan> span_at(const TongueShape& shape, double x_mm, double y_mm);

/// Returns x of the mid-line at y, mm.
[[nodiscard]] double midline_x_mm(const TongueShape& shape, double y_mm);

/// Returns the volume, mm³, by midpoint quadrature in variables that remove the square roots at the ends. Relative
/// error below 1e-5 with the default.
/// @param steps  points along the length, and across each half; [16, 4096], else @throws InvalidArgument.
[[nodiscard]] double volume_mm3(const TongueShape& shape, int steps = 200);

/// Returns a box, mm, that contains the shape; not necessarily the smallest.
[[nodiscard]] Box3 bounds_mm(const TongueShape& shape);

}  // namespace incise
