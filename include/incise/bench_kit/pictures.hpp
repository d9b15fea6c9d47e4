#pragma once

#include <incise/geometry/contour.hpp>
#include <incise/geometry/picture.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace incise {

/// A pinhole camera without distortion; pixel (u, v) has its centre at (u, v).
struct Pinhole {
  int width = 1280;
  int height = 720;
  double focal_px = 650.0;  ///< of an Intel D405 at this size: 89 degrees across
  double cx = 639.5;
  double cy = 359.5;
};

/// One shot of the RGB-D camera, with both pictures from the same pinhole.
struct FrameShot {
  Pinhole camera;
  ColorPicture color;
  DepthPicture depth;
  double depth_unit_mm = 0.1;
  std::vector<std::uint8_t> is_specimen;  ///< width * height: 1 = specimen, as a person would crop it
};

/// The visible parts of a specimen: the surface of the remaining tissue and the mark round its tumour; mm, specimen's
/// frame.
struct SeenTissue {
  Points vertices;
  Points rest;                        ///< per vertex: its position at rest, which fixes the grain in the photograph
  std::vector<Triangle> triangles;    ///< outwards
  std::vector<std::uint8_t> is_skin;  ///< per triangle: 1 = uncut surface, 0 = wall of a kerf
  Contour tumor_edge;
};

/// Returns the barycentric weights of a triangle's corners at a place of the picture plane; sum 1. For a triangle seen
/// edge-on: (1, 0, 0).
/// @param in_view  vertices in view coordinates, mm.
[[nodiscard]] Vec3 weights_seen_at(std::span<const Vec3> in_view, const Triangle& triangle, const Vec2& place);

/// Returns the signed error of each place, mm: its distance outside the tumour's edge in the picture plane minus
/// `target_mm`; negative = too close. All points are in view coordinates, mm.
[[nodiscard]] std::vector<double> errors_seen_mm(const Points& places, const Contour& tumor_edge, double target_mm);

/// Errors of the depth picture.
struct FrameNoise {
  std::uint64_t seed = 1;  ///< of noise, holes and the grain of tissue
  double depth_noise_mm = 0.2;  ///< standard deviation
  double depth_scale = 1.0;   ///< measured over true distance
  double hole_percent = 3.0;  ///< share of the specimen without a reading, %, [0, 100]
};

/// Renders the stretched specimen as the camera sees it, with the tumour's edge marked in green and with the depth's
/// noise, scale and holes.
/// @param T_camera_specimen  rigid, mm.
/// @throws InvalidArgument if hole_percent is out of range, or the tumour's edge has no points.
[[nodiscard]] FrameShot shoot_frame(const SeenTissue& tissue, const FrameNoise& noise, const Mat4& T_camera_specimen);

/// Returns the specimen's part of the depth picture as points, camera frame, mm: every third pixel of every third row,
/// where depth is measured.
[[nodiscard]] Points cloud_of(const FrameShot& frame);

/// Scale, border and line widths of a photograph.
struct PhotographSettings {
  double mm_per_pixel = 0.03;  ///< > 0
  double border_mm = 12.0;     ///< around inner edge and tumour, >= 6: room for the kerf and the ruler
  double line_mm = 0.35;       ///< of the red line, > 0
  double green_line_mm = 0.5;  ///< of the green line, > 0
};

/// What a photograph shows besides tissue.
struct Marked {
  std::uint64_t seed = 1;             ///< of the grain of tissue, of noise and of the hand
  std::optional<Contour> inner_edge;  ///< of the kerf; absent: the kerf is open, its edge is drawn in pieces
  double hand_mm = 0.03;              ///< standard deviation of the hand that draws the red line
  double hand_wave_mm = 4.0;          ///< wavelength of the hand's error
  double stains = 0.0;                ///< char along the kerf, blood and glare, in [0, 1]
  double thermal_width_mm = 0.0;      ///< distance from the tool's axis to which heat damaged tissue
  Vec3 approach = -Vec3::UnitZ();     ///< direction of sight
};
/// Renders the photograph of a cut specimen from straight above, tool out, still stretched: tissue with its grain, the
/// kerf, a red line along the kerf's inner edge (open where the kerf is open), a green line along the tumour's edge, a
/// ruler with millimetre ticks, and, if heat reached farther than the electrode's diameter, pale tissue beside the
/// kerf.
/// @throws InvalidArgument for settings that are out of range.
[[nodiscard]] ColorPicture photograph(const SeenTissue& tissue, const Marked& marked,
                                      const PhotographSettings& settings = {});

}  // namespace incise
