#pragma once

#include <incise/geometry/contour.hpp>
#include <incise/geometry/picture.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace incise {

/// A pinhole without distortion; pixel (u, v) has its centre at (u, v).
struct Pinhole {
  int width = 1280;
  int height = 720;
  double focal_px = 650.0;  ///< of an Intel D405 at this size: 89 degrees across
  double cx = 639.5;
  double cy = 359.5;
};

/// One shot of the RGB-D camera, both pictures of the same pinhole.
struct FrameShot {
  Pinhole camera;
  ColorPicture color;
  DepthPicture depth;
  double depth_unit_mm = 0.1;
  std::vector<std::uint8_t> is_specimen;  ///< width * height: what a person would crop as the specimen
};

/// What can be seen of a specimen: the surface of all that is left of it, and the mark round its tumour. mm, in the
/// specimen's frame.
struct SeenTissue {
  Points vertices;
  Points rest;                        ///< per vertex: its place at rest, by which the grain of tissue is laid
  std::vector<Triangle> triangles;    ///< outwards
  std::vector<std::uint8_t> is_skin;  ///< per triangle: of the uncut surface, no wall of a kerf
  Contour tumor_edge;
};

/// Weights of a triangle's corners at a place of the picture, as seen in view coordinates; sum 1. A triangle seen
/// edge-on has its first corner's.
[[nodiscard]] Vec3 weights_seen_at(std::span<const Vec3> in_view, const Triangle& triangle, const Vec2& place);

/// How far places lie outside the tumour's edge, all in view coordinates and seen flat, less `target_mm`; mm, negative:
/// too close.
[[nodiscard]] std::vector<double> errors_seen_mm(const Points& places, const Contour& tumor_edge, double target_mm);

/// What is wrong with a depth picture.
struct FrameNoise {
  std::uint64_t seed = 1;  ///< of noise, holes and the grain of tissue
  double depth_noise_mm = 0.2;
  double depth_scale = 1.0;   ///< measured over true distance
  double hole_percent = 3.0;  ///< of the specimen: without a reading
};

/// The stretched specimen as the camera sees it, tumour's edge marked in green; with the depth's noise, scale and
/// holes.
[[nodiscard]] FrameShot shoot_frame(const SeenTissue& tissue, const FrameNoise& noise, const Mat4& T_camera_specimen);

/// Every third pixel of the specimen's part of the depth picture, camera frame, mm.
[[nodiscard]] Points cloud_of(const FrameShot& frame);

/// What the photograph shows.
struct PhotographSettings {
  double mm_per_pixel = 0.03;  ///< > 0
  double border_mm = 12.0;     ///< around inner edge and tumour, >= 6: room for the kerf and the ruler
  double line_mm = 0.35;       ///< of the red line, > 0
  double green_line_mm = 0.5;  ///< of the green line, > 0
};

/// What a photograph shows beside tissue.
struct Marked {
  std::uint64_t seed = 1;             ///< of the grain of tissue, of noise and of the hand
  std::optional<Contour> inner_edge;  ///< of the kerf; absent: open, and drawn by pieces
  double hand_mm = 0.03;              ///< standard deviation of the hand that draws the red line
  double hand_wave_mm = 4.0;          ///< over which it errs alike
  double stains = 0.0;                ///< char along the kerf, blood and glare, in [0, 1]
  double thermal_width_mm = 0.0;      ///< how far beside the tool's axis heat reached
  Vec3 approach = -Vec3::UnitZ();     ///< as the camera looks
};
/// The photograph of a cut specimen from straight above, tool out, still stretched: tissue with its grain, the kerf, a
/// red line drawn along the kerf's inner edge (open where the kerf is), a green one along the tumour's edge, a
/// ruler with millimetre ticks, and pale tissue where heat reached farther than the electrode's diameter.
/// @throws InvalidArgument for settings that are out of range.
[[nodiscard]] ColorPicture photograph(const SeenTissue& tissue, const Marked& marked,
                                      const PhotographSettings& settings = {});

}  // namespace incise
